"""The trade-off curve: every point where its numbers say, and room for what matters."""

import io
from dataclasses import replace

import numpy as np
from PIL import Image

from des_cli.model.tradeoff import TradePoint
from des_cli.show.plots import draw_tradeoff
from des_cli.show.plots.canvas import style
from des_cli.show.plots.tradeoff import _figure
from tests.support.pictures import BLUE, GREY, VERMILION, area, picture


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
