"""The bounds of a free motion at the points of its grid: budgets on peaks, and the occupant's.

The points are the two Gauss points of every interval. G onset is bounded from one to the other:
across a knot the motion is as smooth as within, and the verification measures the table's.
"""

from __future__ import annotations

import numpy as np

from des_cli.kinematics.attitude import rotation
from des_cli.kinematics.seat import PILOT_SIGNS
from des_cli.kinematics.trig_polynomial import TrigPolynomial
from des_cli.model.arrays import Floats
from des_cli.model.machine import OccupantBounds
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_PEAK_RATIO,
    ATTITUDE_ERROR,
    UNFELT_ANGULAR_ACCELERATION,
    Budget,
)
from des_cli.model.sides import largest_of
from des_cli.reduction.free.local_bounds import (
    AttitudeBound,
    ComponentBound,
    LocalBound,
    NormBound,
    OnsetBound,
)
from des_cli.reduction.free.task import FreeTask
from des_cli.reduction.reference import sample_sides
from des_cli.solver.spline import SplineGrid
from des_cli.units import STANDARD_GRAVITY_M_S2


def point_bound(task: FreeTask, times: Floats, angle: Floats, budget: Budget) -> LocalBound:
    """Return a budget on a peak metric, as a bound at every point.

    Raises
    ------
    ValueError
        If it is on a metric that is none, or one that has no bound yet.
    """
    if budget.metric == ATTITUDE_ERROR:
        return _attitude_bound(task, times, angle, budget.most)
    if budget.metric != ANGULAR_ACCELERATION_PEAK_RATIO:
        raise ValueError(f"{budget.metric} is no bound at a point")
    peak = largest_of(task.requested().seat_angular_acceleration)
    return NormBound("acceleration", budget.most * max(peak, UNFELT_ANGULAR_ACCELERATION))


def _attitude_bound(task: FreeTask, times: Floats, angle: Floats, most_deg: float) -> AttitudeBound:
    coefficient = task.chain.transform.coefficient[..., :3, :3]
    attitude = TrigPolynomial(coefficient.reshape(3, 3, 3, 9))
    requested = attitude(angle)
    if task.shortfall is not None:
        missing = task.shortfall.attitude
        sides = np.stack([missing[:-1], missing[1:]], axis=1)
        turn = rotation(sample_sides(task.reference.t, sides, times))
        requested = (requested.reshape(-1, 3, 3) @ turn).reshape(-1, 9)
    return AttitudeBound(attitude, requested.T, float(np.radians(most_deg)))


def occupant_bounds(occupant: OccupantBounds, grid: SplineGrid, room: float) -> list[LocalBound]:
    """Return the machine's bounds on what is felt, drawn in by some room."""
    found: list[LocalBound] = []
    directions, bounds = [], []
    per_g = np.diag(PILOT_SIGNS) / STANDARD_GRAVITY_M_S2
    for axis, (least, most) in enumerate((occupant.gx, occupant.gy, occupant.gz)):
        for bound, sign in ((most, 1.0), (-least, -1.0)):
            if np.isfinite(bound):
                directions.append(sign * per_g[axis])
                bounds.append(bound)
    if bounds:
        scale = np.maximum(np.abs(bounds), 1.0)
        found.append(ComponentBound(np.array(directions), np.array(bounds) - room * scale, scale))
    if np.isfinite(occupant.angular_acceleration):
        found.append(NormBound("acceleration", (1.0 - room) * occupant.angular_acceleration))
    if np.isfinite(occupant.g_onset):
        apart = grid.step / np.sqrt(3.0)  # between the two points of an interval
        rate = per_g / ((1.0 - room) * occupant.g_onset * apart)
        found.append(OnsetBound(np.concatenate([rate, -rate])))
    return found
