"""The figure of limits: what is shaded, and what is said of it."""

from typing import Any

import numpy as np
import pytest

from des_cli.results.reading import read_metrics
from des_cli.show.plots.canvas import style
from des_cli.show.plots.ride import limits


def panel_of_limits(peak: float, limit: float | None) -> Any:
    """The arm's acceleration in the figure of limits, of a motion with this peak."""
    t = np.linspace(0.0, 1.0, 21)
    columns = {"t_s": t} | {
        f"{which}_{joint}_{unit}": peak * np.sin(7.0 * t)
        for which in ("asked", "modified")
        for joint in ("arm", "fork", "cab")
        for unit in ("rad_s", "rad_s2", "rad_s3")
    }
    arm = {"acceleration_limit_rad_s2": limit, "acceleration_peak_rad_s2": peak}
    with style():
        return limits(columns, read_metrics({"limits": {"modified": {"arm": arm}}}))[0].axes[1]


@pytest.mark.parametrize(
    ("peak", "words", "near"),
    [(0.6, "peak at 95.2 %", True), (0.9, "peak at 143 %", True), (0.01, "peak at 1.6 %", False)],
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
