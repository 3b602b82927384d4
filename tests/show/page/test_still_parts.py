"""What of the page needs no script: still pictures, bars, places on the trade-off, LaTeX."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from des_cli.results.reading import read_metrics
from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.cells import Cell
from des_cli.show.page.curves import families_of
from des_cli.show.page.latex import escape
from des_cli.show.page.limit_bars import limit_bars
from des_cli.show.page.sheet import HEIGHT, WIDTH, stills_of
from des_cli.show.page.tradeoff_points import trade_places
from tests.support.page import set_at


def test_stills_stay_inside_their_frame(stored: Callable[..., StoredRun]) -> None:
    stills = stills_of(families_of(stored().trajectory))
    assert [still.title for still in stills[:3]] == ["Gx", "Gy", "Gz"]
    for still in stills:
        for points in (still.before, still.after):
            places = np.array([pair.split(",") for pair in points.split()], dtype=float)
            assert places.min() >= 0.0
            assert places[:, 0].max() <= WIDTH
            assert places[:, 1].max() <= HEIGHT
        assert still.alt.startswith(f"{still.title}: from ")


def test_a_curve_that_stands_still_is_a_line_in_the_middle(
    stored: Callable[..., StoredRun],
) -> None:
    run = stored()
    zero = np.zeros_like(run.trajectory["t_s"])
    trajectory = run.trajectory | {f"seat_gy_{when}_g": zero for when in ("before", "after")}
    still = stills_of(families_of(trajectory))[1]
    assert (still.least, still.most) == ("0", "0")
    assert {pair.split(",")[1] for pair in still.after.split()} == {f"{HEIGHT / 2:.1f}"}


def test_a_bar_beyond_its_limit_is_full_and_marked() -> None:
    load = {"rate_peak_rad_s": 6.0, "rate_limit_rad_s": 4.0}
    metrics = read_metrics({"limits": {"modified": {"arm": load}, "desired": {"arm": load}}})
    (bar,) = limit_bars(metrics)
    assert (bar.width_after, bar.mark, bar.after) == (100.0, "bad", "150\u00a0%")
    assert bar.detail == "6 → 6 of 4 rad/s"


def test_the_places_on_the_trade_off_are_those_of_the_baselines(
    stored: Callable[..., StoredRun],
) -> None:
    run = stored()
    set_at(run.metrics, "coriolis.objective", {"reduction": 0.689})
    own, law, constant = trade_places(read_metrics(run.metrics))
    assert own.y == constant.y < law.y
    assert law.x < constant.x
    assert constant.label == "constant p = 0.747"
    set_at(run.metrics, "baseline.report_sweep", None)
    set_at(run.metrics, "baseline.constant_p", None)
    assert trade_places(read_metrics(run.metrics)) == []


@pytest.mark.parametrize(
    ("text", "latex"),
    [("a_b & 5 %", r"a\_b \& 5 \%"), ("\\input{x}", r"\textbackslash{}input\{x\}"), ("−3", "$-$3")],
)
def test_latex_prints_what_was_written(text: str, latex: str) -> None:
    assert escape(Cell(text).text) == latex
