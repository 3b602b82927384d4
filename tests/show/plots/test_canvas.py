"""The look of a figure: the height of its ordinate."""

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.show.plots.canvas import draw, sheet, style
from des_cli.show.plots.pens import AFTER, BEFORE


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
