"""The figures of a run: there, of the right data, and the same bytes every time."""

import io
import sys
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from des_cli.model.arrays import Floats
from des_cli.model.run import Run
from des_cli.model.tradeoff import TradePoint
from des_cli.runs_out.tables import trajectory_columns
from des_cli.show.plots import CAPTIONS, draw_plots, draw_tradeoff
from des_cli.show.plots.canvas import AFTER, BEFORE, draw, sheet, style
from des_cli.show.plots.ride import limits
from des_cli.show.plots.thinning import thin
from des_cli.show.plots.tradeoff import _figure
from des_cli.show.plots.weighted import reduction_of, weighted_component

MakeRun = Callable[..., Run]

BLUE = (0, 114, 178)
VERMILION = (213, 94, 0)
GREY = (118, 118, 118)


def picture(png: bytes) -> Image.Image:
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    return Image.open(io.BytesIO(png)).convert("RGB")


def area(image: Image.Image, color: tuple[int, int, int]) -> int:
    return int(np.all(np.asarray(image) == color, axis=-1).sum())


@pytest.mark.parametrize("control", ["scalar", "per-joint"])
def test_every_figure_shows_its_curves(synthetic_run: MakeRun, control: str) -> None:
    run = synthetic_run(101, control=control)
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
    run, other = synthetic_run(), synthetic_run(control="per-joint")
    ours = draw_plots(trajectory_columns(run), run.metrics)
    theirs = draw_plots(trajectory_columns(other), other.metrics)
    assert [name for name in ours if ours[name] == theirs[name]] == ["adjoint"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("section", "change", "figures"),
    [
        ("solver", {"status": "acceptable", "converged": False}, set(CAPTIONS)),
        ("solver", {"budget": {"joint_deviation_relative": 0.13}}, {"deviation"}),
        ("limits", {"modified": {"fork": {"jerk_limit_rad_s3": 5.0}}}, {"limits"}),
        ("felt", {"seat_angular_acceleration": {}}, {"felt"}),
        ("executable", {"joint_change_max_rad": {"cab": 0.0123}}, {"commands"}),
        ("executable", {"joint_change_max_rad": {"cab": 1e-6}}, set()),
    ],
)
def test_standing_budget_and_changes_are_on_the_figures_they_belong_to(
    synthetic_run: MakeRun, section: str, change: dict[str, object], figures: set[str]
) -> None:
    run = synthetic_run(11)
    columns = trajectory_columns(run)
    plain = draw_plots(columns, run.metrics)
    changed = draw_plots(columns, run.metrics | {section: run.metrics[section] | change})
    assert {name for name in plain if plain[name] != changed[name]} == figures


def test_a_free_motion_has_no_figure_of_factors_and_adjoint(synthetic_run: MakeRun) -> None:
    run = synthetic_run(11, control="free")
    figures = draw_plots(trajectory_columns(run), run.metrics)
    assert list(figures) == [name for name in CAPTIONS if name not in ("factor", "adjoint")]


def panel_of_limits(peak: float, limit: float | None) -> Any:
    """The arm's acceleration in the figure of limits, of a motion with this peak."""
    t = np.linspace(0.0, 1.0, 21)
    columns = {"t_s": t} | {
        f"{which}_{joint}_{unit}": peak * np.sin(7.0 * t)
        for which in ("asked", "modified")
        for joint in ("arm", "fork", "cab")
        for unit in ("rad_s2", "rad_s3")
    }
    arm = {"acceleration_limit_rad_s2": limit, "acceleration_peak_rad_s2": peak}
    with style():
        return limits(columns, {"limits": {"modified": {"arm": arm}}})[0].axes[0]


@pytest.mark.parametrize(
    ("peak", "words", "near"),
    [(0.6, "peak at 95 %", True), (0.9, "peak at 143 %", True), (0.01, "peak at 2 %", False)],
)
def test_a_limit_is_shaded_and_on_the_paper_where_it_is_near(
    peak: float, words: str, near: bool
) -> None:
    panel = panel_of_limits(peak, 0.63)
    assert panel.get_title(loc="right") == f"acceleration: limit ±0.63 rad/s², {words}"
    low, high = panel.get_ylim()
    assert low < -0.99 * peak < 0.99 * peak < high
    assert (low < -0.63 and high > 0.63) == near
    band, above, below = ((box.get_y(), box.get_y() + box.get_height()) for box in panel.patches)
    assert band == pytest.approx((-0.63, 0.63))
    assert above == pytest.approx((0.63, max(high, 0.63)))
    assert below == pytest.approx((min(low, -0.63), -0.63))


def test_a_joint_without_a_limit_is_told_so() -> None:
    panel = panel_of_limits(0.5, None)
    assert panel.get_title(loc="right") == "acceleration: no limit"
    assert not panel.patches


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


@pytest.mark.slow
def test_metrics_of_a_stranger_do_not_stop_the_figures(synthetic_run: MakeRun) -> None:
    columns = trajectory_columns(synthetic_run(11))
    for metrics in (
        {},
        {"solver": 1, "coriolis": []},
        {"limits": {"modified": {"arm": {"jerk_limit_rad_s3": -1.0, "jerk_peak_rad_s3": "x"}}}},
        {"solver": {"axes": ["report"], "r1": "two"}, "coriolis": {"bb3": {"reduction": "much"}}},
        {
            "solver": {"status": "$x_$", "converged": False, "budget": {"$a_$": 1.0}},
            "fidelity": {"$a_$": 2.0},
            "executable": {"joint_change_max_rad": {"$\\q$": 2.0, "b": "c"}},
        },
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


def trade(algorithm: str, control: str, swept: str, *triples: tuple[float, float, float]):
    """Points of one curve: value, deviation, reduction."""
    return [
        TradePoint(
            algorithm,  # type: ignore[arg-type]
            control,  # type: ignore[arg-type]
            swept,
            value,
            "converged",
            objective_reduction=reduction,
            joint_deviation_relative=deviation,
            seat_g_rms_error_g=2 * deviation,
        )
        for value, deviation, reduction in triples
    ]


JOINT = trade(
    "optimum", "per-joint", "joint_deviation_relative", (0.05, 0.05, 0.8), (0.1, 0.1, 0.9)
)
SCALAR = trade("optimum", "scalar", "joint_deviation_relative", (0.05, 0.05, 0.5), (0.1, 0.1, 0.7))
SLOWED = trade("constant-p", "scalar", "p", (0.95, 0.05, 0.2), (0.9, 0.1, 0.35), (0.5, 0.5, 0.9))


def study(deviation: float, reduction: float = 0.6) -> list[TradePoint]:
    return trade("report-sweep", "scalar", "r2", (1.0, deviation, reduction))


def width_of(points: list[TradePoint]) -> float:
    with style():
        axes = _figure(points, "title").axes[0]
    return float(axes.get_xlim()[1])


def words_in(points: list[TradePoint]) -> list[str]:
    with style():
        return [text.get_text() for text in _figure(points, "title").axes[0].texts]


def test_the_trade_off_shows_every_curve_and_its_points() -> None:
    image = picture(draw_tradeoff(JOINT + SCALAR + SLOWED + study(0.15), "cobra"))
    for color in (BLUE, VERMILION, GREY):
        assert area(image, color) > 300
    assert area(picture(draw_tradeoff(JOINT, "cobra")), VERMILION) == 0
    words = words_in(JOINT + SCALAR + SLOWED + study(0.15))
    assert words == ["5 %", "10 %", "5 %", "10 %", "r₂ = 1", "p = 0.95", "p = 0.9"]


def test_the_points_lie_where_their_numbers_say() -> None:
    with style():
        axes = _figure(JOINT, "title").axes[0]
    line, dots = axes.get_lines()[1:]
    np.testing.assert_allclose(line.get_xydata(), [[0, 0], [5, 80], [10, 90]])
    np.testing.assert_allclose(dots.get_xydata(), [[5, 80], [10, 90]])
    low, high = axes.get_ylim()
    assert (low, high) == (0.0, 105.0)


def test_a_growth_of_the_coriolis_is_on_the_page() -> None:
    with style():
        axes = _figure(JOINT + study(0.02, -0.3), "title").axes[0]
    assert axes.get_ylim()[0] < -30


def test_baselines_far_off_do_not_squeeze_the_curves() -> None:
    assert width_of(JOINT + SLOWED) < 11
    assert 25 < width_of(JOINT + SLOWED + study(0.25)) < 28
    far = JOINT + SLOWED + study(1.2)
    assert width_of(far) < 11
    assert "r₂ = 1 at 120 % →" in words_in(far)


def test_the_abscissa_is_what_was_budgeted() -> None:
    points = trade("optimum", "scalar", "seat_g_rms_error_g", (0.1, 0.05, 0.5))
    with style():
        axes = _figure(points, "title").axes[0]
    assert axes.get_xlabel().endswith("[g]")
    np.testing.assert_allclose(axes.get_lines()[-1].get_xydata(), [[0.1, 50]])
    assert words_in(points) == ["0.1 g"]


def test_a_free_motion_has_a_curve_of_its_own_and_may_be_bounded_in_what_is_felt() -> None:
    error = "seat_angular_acceleration_rms_error_rad_s2"
    points = [
        replace(point, **{error: 3 * point.joint_deviation_relative})
        for point in trade("optimum", "free", error, (0.15, 0.05, 0.6), (0.3, 0.1, 0.8))
    ]
    with style():
        axes = _figure(points, "title").axes[0]
    assert axes.get_xlabel().endswith("[rad/s²]")
    np.testing.assert_allclose(axes.get_lines()[-1].get_xydata(), [[0.15, 60], [0.3, 80]])
    assert words_in(points) == ["0.15 rad/s²", "0.3 rad/s²"]
    assert area(picture(draw_tradeoff(points + JOINT, "cobra")), (0, 158, 115)) > 100


def test_a_trade_off_without_a_solution_is_still_drawn() -> None:
    nothing = TradePoint("optimum", "scalar", "r2", 1.0, "infeasible")
    assert picture(draw_tradeoff([nothing], "cobra")).width > 1000
    assert words_in([nothing, *SLOWED]) == ["p = 0.95", "p = 0.9", "p = 0.5"]


def test_equal_points_give_equal_bytes() -> None:
    first, second = (draw_tradeoff(JOINT + SLOWED, "cobra") for _ in range(2))
    assert first == second
    assert draw_tradeoff(JOINT, "cobra") != first
    assert Image.open(io.BytesIO(first)).info["Title"] == (
        "Reduction of the cross-coupling against deviation: cobra"
    )
