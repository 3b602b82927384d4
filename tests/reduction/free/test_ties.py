"""Where a motion per joint stands still."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.reduction.free.ties import NEXT_TO_NOTHING, tie_reversals
from des_cli.solver.spline import SplineGrid

GRID = SplineGrid(0.3, 0.2, 20)


def control_of(rate):
    """Control points of a motion whose rate's control points are given, for each joint."""
    first = np.zeros((1, 3))
    return np.concatenate([first, np.cumsum(rate * GRID.step, axis=0)])


def times_of(ties, joint):
    return [tie.time for tie in ties if tie.joint == joint]


def test_rates_that_turn_back_are_tied_where_they_do():
    t = GRID.greville
    control = np.stack([0.5 * t, np.sin(1.1 * t), np.cos(2.3 * t + 0.2)], axis=1)
    ties = tie_reversals(GRID, control)
    assert times_of(ties, 0) == []
    for joint in (1, 2):
        times = times_of(ties, joint)
        fine = np.linspace(GRID.start, GRID.start + GRID.duration, 20_001)
        rate = GRID.values(control, fine, 1)[:, joint]
        assert len(times) == np.count_nonzero(np.diff(np.sign(rate)))
        np.testing.assert_allclose(
            GRID.values(control, np.array(times), 1)[:, joint], 0.0, atol=1e-12
        )
    assert all(tie.bound == NEXT_TO_NOTHING for tie in ties)


@pytest.mark.parametrize("turn", [0.31, 1.0, 2.217, 3.999])
def test_a_rate_that_is_linear(turn):
    """Zero at any place between knots, to rounding."""
    time = GRID.start + turn
    middle = GRID.greville[:-1] + 0.5 * GRID.step  # a straight rate's own values
    rate = np.zeros((GRID.points - 1, 3))
    rate[:, 0] = 1.7 * (middle - time)
    rate[:, 1] = -rate[:, 0]
    ties = tie_reversals(GRID, control_of(rate))
    for joint in (0, 1):
        assert times_of(ties, joint) == pytest.approx([time], abs=1e-12)


def test_a_joint_that_stands_still_at_knots():
    rate = np.zeros((GRID.points - 1, 3))
    rate[:10, 1] = 1.0  # and nothing from there on
    ties = tie_reversals(GRID, control_of(rate))
    expected = GRID.knots[10:]
    np.testing.assert_allclose(times_of(ties, 1), expected, atol=1e-12)
    # one that never moves is tied at every knot
    np.testing.assert_allclose(times_of(ties, 0), GRID.knots, atol=1e-12)


def test_a_rate_that_touches_nothing_is_tied_there_too():
    """No change of sign: the factor is finite, and the rate is zero, at a knot."""
    t = GRID.greville - GRID.knots[8]
    h = GRID.step
    cubic = (t**3 - t * h**2) / 3.0  # the blossom of s^3 / 3, whose rate is s^2
    control = np.stack([0.4 * t, cubic, 0.4 * t], axis=1)
    ties = tie_reversals(GRID, control)
    assert times_of(ties, 1) == pytest.approx([GRID.knots[8]])
    rate = GRID.values(control, GRID.knots[8:9], 1)[0, 1]
    assert ties[0].bound >= abs(rate)
