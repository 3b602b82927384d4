"""Where a factor on each joint's rate ties a motion to the desired one.

A motion with ``theta' = u Theta'`` and a finite factor u stands still wherever the desired
joint does. Everywhere else any rate is some factor times the desired one: a motion per
joint is a free one whose joints stand still where the desired ones turn back.
"""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.reduction.free.limit_rows import Tie
from des_cli.solver.spline import SplineGrid

STILL = 1e-6
"""Rate relative to a joint's largest that counts as standing still."""

NEXT_TO_NOTHING = 1e-7
"""Rate [rad/s] that a tie leaves, so that there is an inside at all."""


def tie_reversals(grid: SplineGrid, control: Floats) -> tuple[Tie, ...]:
    """Return the ties of a motion per joint.

    Parameters
    ----------
    grid : SplineGrid
    control : (n, 3) array
        Of the executable desired motion [rad].
    """
    knots = grid.values(control, grid.knots, 1)
    ties: list[Tie] = []
    for joint in range(control.shape[1]):
        rate = knots[:, joint]
        largest = float(np.max(np.abs(rate), initial=0.0))
        still = np.abs(rate) <= max(STILL * largest, NEXT_TO_NOTHING)
        for k in np.flatnonzero(still):
            bound = max(NEXT_TO_NOTHING, 2.0 * abs(float(rate[k])))
            ties.append(Tie(float(grid.knots[k]), joint, bound))
        turning = np.flatnonzero((rate[:-1] * rate[1:] < 0.0) & ~still[:-1] & ~still[1:])
        for k in turning:
            u = _root(*(float(v) for v in _parabola(grid, control[:, joint], int(k))))
            time = float(grid.knots[k]) + u * grid.step
            ties.append(Tie(time, joint, NEXT_TO_NOTHING))
    return tuple(ties)


def _parabola(grid: SplineGrid, control: Floats, k: int) -> tuple[float, float, float]:
    """Return the rate on an interval as c + b u + a u^2."""
    ends = grid.basis(np.array([0.0, 0.5, 1.0]), 1) @ control[k : k + 4]
    first, middle, last = ends.tolist()
    return first, 4.0 * middle - 3.0 * first - last, 2.0 * (first + last) - 4.0 * middle


def _root(c: float, b: float, a: float) -> float:
    """Return the root in [0, 1] of a parabola that changes sign there."""
    large = -0.5 * (b + np.copysign(np.sqrt(max(b * b - 4.0 * a * c, 0.0)), b))
    roots = [c / large] if large else []
    if a:
        roots.append(large / a)
    nearest = min(roots, key=lambda u: abs(u - 0.5), default=0.5)
    return float(min(max(nearest, 0.0), 1.0))
