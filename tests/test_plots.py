"""The figures of a run: there, of the right data, and the same bytes every time."""

import io
import sys
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from des_cli.files.tables import trajectory_columns
from des_cli.model.arrays import Floats
from des_cli.model.run import Run
from des_cli.plots import CAPTIONS, draw_plots
from des_cli.plots.canvas import AFTER, BEFORE, draw, sheet, style
from des_cli.plots.thinning import thin
from des_cli.plots.weighted import reduction_of, weighted_component

MakeRun = Callable[..., Run]

BLUE = (0, 114, 178)
GREY = (118, 118, 118)


def picture(png: bytes) -> Image.Image:
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    return Image.open(io.BytesIO(png)).convert("RGB")


def area(image: Image.Image, color: tuple[int, int, int]) -> int:
    return int(np.all(np.asarray(image) == color, axis=-1).sum())


@pytest.mark.parametrize("per_joint", [False, True])
def test_every_figure_shows_its_curves(synthetic_run: MakeRun, per_joint: bool) -> None:
    run = synthetic_run(101, per_joint=per_joint)
    figures = draw_plots(trajectory_columns(run), run.metrics)
    assert list(figures) == list(CAPTIONS)
    widths = set()
    for name, png in figures.items():
        image = picture(png)
        widths.add(image.width)
        assert area(image, BLUE) > 1000, name
        if name not in ("adjoint", "deviation"):
            assert area(image, GREY) > 300, name
    assert len(widths) == 1


def test_equal_runs_give_equal_bytes(synthetic_run: MakeRun) -> None:
    first, second = (
        draw_plots(trajectory_columns(run), run.metrics)
        for run in (synthetic_run(), synthetic_run())
    )
    assert first == second


def test_the_users_matplotlibrc_changes_nothing(synthetic_run: MakeRun) -> None:
    import matplotlib

    run = synthetic_run()
    plain = draw_plots(trajectory_columns(run), run.metrics)
    with matplotlib.rc_context(
        {"figure.facecolor": "red", "axes.grid": False, "font.size": 30, "savefig.dpi": 10}
    ):
        assert draw_plots(trajectory_columns(run), run.metrics) == plain
        assert matplotlib.rcParams["font.size"] == 30


def test_a_figure_is_of_its_run(synthetic_run: MakeRun) -> None:
    run, other = synthetic_run(), synthetic_run(per_joint=True)
    ours = draw_plots(trajectory_columns(run), run.metrics)
    theirs = draw_plots(trajectory_columns(other), other.metrics)
    assert [name for name in ours if ours[name] == theirs[name]] == ["adjoint"]


def test_pyplot_stays_out(synthetic_run: MakeRun) -> None:
    run = synthetic_run(11)
    draw_plots(trajectory_columns(run), run.metrics)
    assert "matplotlib.pyplot" not in sys.modules


def test_no_version_and_no_time_is_in_the_file(synthetic_run: MakeRun) -> None:
    run = synthetic_run(11)
    for png in draw_plots(trajectory_columns(run), run.metrics).values():
        facts = Image.open(io.BytesIO(png)).info
        assert set(facts) == {"dpi", "Title", "Software"}
        assert facts["Software"] == "des-coriolis"


def test_metrics_of_a_stranger_do_not_stop_the_figures(synthetic_run: MakeRun) -> None:
    columns = trajectory_columns(synthetic_run(11))
    for metrics in (
        {},
        {"solver": 1, "coriolis": []},
        {"solver": {"axes": ["report"], "r1": "two"}, "coriolis": {"bb3": {"reduction": "much"}}},
    ):
        assert list(draw_plots(columns, metrics)) == list(CAPTIONS)


def limits_of(values: Floats, floor: float) -> tuple[float, float]:
    with style():
        _, axes = sheet("title", [BEFORE, AFTER], 1)
        t = np.linspace(0.0, 1.0, len(values))
        draw(axes[0][0], t, [(AFTER, values)], "y", floor)
    low, high = axes[0][0].get_ylim()
    return float(low), float(high)


def test_rounding_is_not_blown_up_and_data_fill_the_paper() -> None:
    noise = 1e-15 * np.sin(np.arange(50.0))
    low, high = limits_of(noise, 0.01)
    assert high - low == pytest.approx(0.01)
    low, high = limits_of(2.0 + noise, 0.01)
    assert low < 2.0 < high
    assert high - low == pytest.approx(0.01)
    low, high = limits_of(np.linspace(-1.0, 3.0, 50), 0.01)
    assert low < -1.0 < 3.0 < high
    assert high - low < 4.5


@settings(deadline=None)
@given(n=st.integers(2, 3000), columns=st.integers(1, 60), seed=st.integers(0, 2**32 - 1))
def test_thinning_keeps_every_peak(n: int, columns: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    t = np.cumsum(random.exponential(size=n) ** 4 + 1e-9)
    values = random.standard_normal(n)
    thin_t, thin_values = thin(t, values, columns)
    assert len(thin_t) <= max(4 * columns, 4)
    assert np.all(np.diff(thin_t) > 0)
    np.testing.assert_array_equal(values[np.searchsorted(t, thin_t)], thin_values)
    assert (thin_t[0], thin_t[-1]) == (t[0], t[-1])
    edges = np.linspace(t[0], t[-1], columns + 1)
    edges[-1] = np.inf  # the last column has its right end
    for low, high in pairwise(edges):
        there, kept = (t >= low) & (t < high), (thin_t >= low) & (thin_t < high)
        if there.any():
            assert thin_values[kept].max() == values[there].max()
            assert thin_values[kept].min() == values[there].min()


@pytest.mark.parametrize(
    ("solver", "expected"),
    [
        ({"axes": "report", "r1": np.diag([0, 2, 0]).tolist()}, "bb3"),
        ({"axes": "report", "r1": np.diag([1, 0, 0]).tolist()}, "ab3"),
        ({"axes": "seat", "r1": np.diag([0, 0, 3]).tolist()}, "seat_z"),
        ({"axes": "seat", "r1": np.diag([2, 2, 2]).tolist()}, None),
        ({"axes": "seat"}, None),
        ({"axes": "report"}, "bb3"),
        ({}, None),
    ],
)
def test_the_weighted_component_is_known(solver: dict[str, object], expected: str | None) -> None:
    assert weighted_component({"solver": solver}) == expected


@pytest.mark.parametrize("reduction", [None, "0.5", float("nan"), 10**400, [0.5]])
def test_a_reduction_that_is_no_number_is_not_known(reduction: object) -> None:
    assert reduction_of({"coriolis": {"bb3": {"reduction": reduction}}}, "bb3") is None
