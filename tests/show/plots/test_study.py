"""Single figures: the study's by their numbers, and the run beside simpler means."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure

from des_cli.model.run import Run
from des_cli.results.reading import read_metrics
from des_cli.runs_out.tables import trajectory_columns
from des_cli.show.plots.canvas import PictureFormat, style
from des_cli.show.plots.figures import FIGURES, draw_figure
from tests.support.runs import make_run

CONTROLS = ("scalar", "per-joint", "free")


@pytest.fixture(scope="module")
def runs() -> dict[str, Run]:
    return {control: make_run(11, control=control) for control in CONTROLS}


def figure_of(run: Run, name: str) -> tuple[Figure, str]:
    with style():
        return FIGURES[name](trajectory_columns(run), read_metrics(run.metrics))


def curves(figure: Figure) -> list[np.ndarray]:
    """The ordinates of all curves that are no line across the panel."""
    lines = [line.get_ydata() for panel in figure.axes for line in panel.lines]
    return [np.asarray(line, float) for line in lines if len(line) > 2]


def test_figures_7_and_10_are_of_bb3(runs: dict[str, Run]) -> None:
    run = runs["scalar"]
    columns = trajectory_columns(run)
    before, after = (columns[f"coriolis_bb3_{when}_rad_s2"] for when in ("before", "after"))
    (original,) = curves(figure_of(run, "7")[0])
    np.testing.assert_array_equal(original, before)
    both = curves(figure_of(run, "10")[0])
    np.testing.assert_array_equal(both, [before, after])


def test_figures_8_and_9_are_of_the_adjoint_and_the_factor(runs: dict[str, Run]) -> None:
    run = runs["scalar"]
    columns = trajectory_columns(run)
    (adjoint,) = curves(figure_of(run, "8")[0])
    np.testing.assert_array_equal(adjoint, columns["adjoint_fork"])
    one, factor = curves(figure_of(run, "9")[0])
    np.testing.assert_array_equal(one, np.ones(len(one)))
    np.testing.assert_array_equal(factor, columns["p"])
    assert len(curves(figure_of(runs["per-joint"], "9")[0])) == 4


@pytest.mark.parametrize(("name", "lacks"), [("8", "no adjoint"), ("9", "no factor p")])
def test_what_a_free_motion_has_none_of_is_said(
    runs: dict[str, Run], name: str, lacks: str
) -> None:
    with pytest.raises(ValueError, match=f"{lacks}, .* --control scalar"):
        figure_of(runs["free"], name)


def test_the_trade_off_is_of_three_points_and_no_line(runs: dict[str, Run]) -> None:
    figure, title = figure_of(runs["scalar"], "tradeoff")
    metrics = read_metrics(runs["scalar"].metrics)
    (panel,) = figure.axes
    points = {(float(x), float(y)) for line in panel.lines for x, y in [line.get_xydata()[0]]}
    sweep, constant = metrics.baseline.report_sweep, metrics.baseline.constant_p
    deviation = metrics.fidelity.value("joint_deviation_relative")
    assert sweep
    assert constant
    assert deviation
    assert sweep.joint_deviation
    assert constant.joint_deviation
    abscissae = sorted(x for x, y in points if (x, y) != (0.0, 0.0))
    expected = sorted(
        100.0 * d for d in (deviation, sweep.joint_deviation, constant.joint_deviation)
    )
    assert abscissae == pytest.approx(expected)
    assert all(len(line.get_xdata()) == 1 for line in panel.lines if line.get_marker() != "None")
    assert panel.get_xlim()[1] >= expected[-1]
    assert runs["scalar"].profile.name in title


@pytest.mark.parametrize("form", ["svg", "pdf", "png"])
def test_equal_runs_give_equal_bytes(form: PictureFormat, runs: dict[str, Run]) -> None:
    again = make_run(11, control="scalar")
    one, other = (
        draw_figure("10", trajectory_columns(run), read_metrics(run.metrics), form)
        for run in (runs["scalar"], again)
    )
    assert one == other
    starts = {"svg": b"<?xml", "pdf": b"%PDF", "png": b"\x89PNG"}
    assert one.startswith(starts[form])


def test_a_stranger_cannot_write_mathematics_or_markup(runs: dict[str, Run]) -> None:
    content = dict(runs["scalar"].metrics)
    content["profile"] = content["profile"] | {"name": "$\\frac$ <b> & x"}
    svg = draw_figure("tradeoff", trajectory_columns(runs["scalar"]), read_metrics(content), "svg")
    assert b"<b>" not in svg
