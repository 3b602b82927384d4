"""Joints inside their limits that make the nearest G, as splines.

Over the control points, with f the specific force at the seat (``kinematics.twist``) ::

    minimise 1/2 int |r(f(theta, theta', theta''))|^2 + sum_j (mu theta_j''' / a_j)^2 dt

inside the limits of every joint, by the method of Levenberg and Marquardt: each step is a
convex quadratic program. Two residuals r share the work: the arm is to make the requested
magnitude, fork and cab the requested direction of whatever force there is. All relative and
tangential terms are in f, and a whole motion is found at a time: sample by sample it would
be a recursion in the accelerations, which a seat that is away from the gimbals' centre does
not survive (at 10 rad/s, a metre of offset makes ten times the error that it takes away).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from des_cli.kinematics.g_motion import NO_G
from des_cli.kinematics.twist import SeatForms, SeatMotion
from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, JointLimits
from des_cli.reduction.free.limit_rows import LimitRows
from des_cli.reduction.free.terms import squares
from des_cli.reduction.free.unknowns import SEAT_VARIABLES
from des_cli.reduction.free.windows import Windows
from des_cli.solver.band import SymmetricBand
from des_cli.solver.quadratic import minimise_quadratic
from des_cli.solver.spline import Ends, SplineGrid
from des_cli.units import STANDARD_GRAVITY_M_S2

CALM = 0.05
"""What a jerk of a joint costs, mu [g s]: the G error that a jerk of the joint's whole
acceleration limit in a second is worth. It determines what the force does not."""

UNLIMITED_ACCELERATION = 5.0
"""Acceleration [rad/s^2] that ``CALM`` takes for a joint without a limit."""

G_TOLERANCE = 1e-3
"""Largest change of G at any point [g] by a step after which a search ends."""

FEWEST_GAIN = 1e-4
"""Or a relative decrease of the cost below this, twice in a row."""

MOST_STEPS = 25
"""Steps of one fit at the most: the turns of arm and gimbals come back to it."""

DAMPING = 1e-3
"""Of the first step: weight on the squared change of the rates, (g s/rad)^2."""

CURBED, EASED = 10.0, 0.2
"""Factors on the damping after a step that is refused, and one that is taken."""

MOST_DAMPING = 1e6
"""Beyond it no step is small enough to gain anything: what is found is a minimum."""

ANCHOR = 1e-3
"""Weight of a change of the angles over that of the rates, so that the system of a step is
regular where a joint's angle does not matter [1/s^2]."""


class Residual(Protocol):
    """What is wrong with a specific force at points."""

    def value(self, force: Floats) -> Floats:
        """Return the residual of a force (3, points) [g], (r, points)."""

    def slope(self, force: Floats, slope: Floats, at: slice) -> Floats:
        """Return its derivatives (v, r, m) by those of the force (v, 3, m), at some points."""


@dataclass(frozen=True, eq=False)
class Magnitude:
    """``|f| - |G|``.

    Parameters
    ----------
    size : (points,) array
        Requested |G| [g].
    """

    size: Floats

    def value(self, force: Floats) -> Floats:
        """Return |f| - |G|, (1, points)."""
        return np.asarray(np.linalg.norm(force, axis=0) - self.size)[None]

    def slope(self, force: Floats, slope: Floats, at: slice) -> Floats:
        """Return the slopes along the force, (v, 1, m)."""
        unit = force[:, at] / np.maximum(np.linalg.norm(force[:, at], axis=0), NO_G)
        return np.asarray(np.einsum("cm,vcm->vm", unit, slope))[:, None]


@dataclass(frozen=True, eq=False)
class Direction:
    """What is missing to the requested direction e of a force as long: ``f - |f| e``.

    For small errors it is the part of f across e; the opposite of e, which has no such
    part, is the worst.

    Parameters
    ----------
    unit : (3, points) array
        e, along x, y, z of the seat.
    """

    unit: Floats

    def value(self, force: Floats) -> Floats:
        """Return f - |f| e, (3, points)."""
        return np.asarray(force - self.unit * np.linalg.norm(force, axis=0))

    def slope(self, force: Floats, slope: Floats, at: slice) -> Floats:
        """Return the slopes of f - |f| e, (v, 3, m)."""
        along = force[:, at] / np.maximum(np.linalg.norm(force[:, at], axis=0), NO_G)
        longer = np.sum(along * slope, axis=1, keepdims=True)
        return np.asarray(slope - self.unit[:, at] * longer)


@dataclass(frozen=True)
class GFit:
    """Where a fit ended.

    Parameters
    ----------
    control : (n, 3) array
        [rad]
    force : (3, points) array
        Specific force along x, y, z of the seat at the times of ``Windows`` [g].
    steps : int
    settled : bool
        Whether the search ended by its tolerance, not by ``MOST_STEPS``.
    """

    control: Floats
    force: Floats
    steps: int
    settled: bool


def fit_g(
    grid: SplineGrid,
    start: Floats,
    forms: SeatForms,
    residual: Residual,
    limits: Sequence[JointLimits],
    ends: Ends,
) -> GFit:
    """Return the spline inside the limits with the least residual of its specific force.

    Parameters
    ----------
    grid : SplineGrid
    start : (n, 3) array
        Control points inside the limits [rad].
    forms : SeatForms
    residual : Residual
    limits : sequence of JointLimits
        For arm, fork, cab; the result keeps them to the rounding of the quadratic program.
    ends : Ends
        Joints that are held, and what of the start stays as it is.
    """
    problem = _GProblem(grid, forms, residual, limits)
    control, damping = start, DAMPING
    cost, force = problem.cost(control)
    idle = 0
    for step in range(MOST_STEPS):
        hessian, gradient = problem.expand(control, force)
        while True:
            curbed = hessian.copy()
            _damp(curbed, grid, damping)
            rows = LimitRows(grid, control, limits, ends)
            outcome = minimise_quadratic(curbed, -gradient, rows, ends)
            tried, found = problem.cost(control + outcome.x)
            if outcome.feasible and tried < cost:
                break
            damping *= CURBED
            if damping > MOST_DAMPING:
                return GFit(control, force, step, True)
        change = float(np.max(np.abs(found - force)))
        idle = idle + 1 if cost - tried < FEWEST_GAIN * cost else 0
        control, cost, force = control + outcome.x, tried, found
        damping *= EASED
        if change < G_TOLERANCE or idle == 2:
            return GFit(control, force, step + 1, True)
    return GFit(control, force, MOST_STEPS, False)


def _damp(hessian: SymmetricBand, grid: SplineGrid, damping: float) -> None:
    """Add a weight on the squared change of the rates, and a little of the angles."""
    weight = np.full((grid.points, len(JOINTS)), damping * grid.step)
    hessian.add_differences(ANCHOR * weight, 0, grid.step)
    hessian.add_differences(weight[1:], 1, grid.step)


class _GProblem:
    """The cost of control points and its expansion by Gauss and Newton."""

    def __init__(
        self,
        grid: SplineGrid,
        forms: SeatForms,
        residual: Residual,
        limits: Sequence[JointLimits],
    ) -> None:
        self._grid, self._forms, self._residual = grid, forms, residual
        self._windows = Windows(grid, SEAT_VARIABLES)
        self._root = np.sqrt(0.5 * grid.step)  # of the weight of a Gauss point
        unit = np.array(
            [
                limit.acceleration if np.isfinite(limit.acceleration) else UNLIMITED_ACCELERATION
                for limit in limits
            ]
        )
        self._calm = np.tile(grid.step * (CALM / unit) ** 2, (grid.intervals, 1))

    def cost(self, control: Floats) -> tuple[float, Floats]:
        """Return the cost, and the specific force at all points, (3, points) [g]."""
        force = np.concatenate(
            [self._at(control, *span).force for span in self._windows.chunks()], axis=1
        )
        force /= STANDARD_GRAVITY_M_S2
        off = self._root * self._residual.value(force)
        jerk = self._grid.differences(control, 3)
        return 0.5 * float(np.sum(off**2) + np.sum(self._calm * jerk**2)), force

    def expand(self, control: Floats, force: Floats) -> tuple[SymmetricBand, Floats]:
        """Return Hessian and gradient at control points (n, 3) and their force."""
        off = self._root * self._residual.value(force)
        hessian = SymmetricBand(self._grid.points, len(JOINTS))
        gradient = np.zeros_like(control)
        at = 0
        for first, last in self._windows.chunks():
            seat = self._at(control, first, last)
            part = slice(at, at + seat.rate.shape[1])
            by_force = (self._root / STANDARD_GRAVITY_M_S2) * seat.force_slope
            slope = self._residual.slope(force, by_force, part)
            by_variable = np.einsum("vcm,cm->vm", slope, off[:, part])
            self._windows.scatter(by_variable, first, gradient)
            self._windows.scatter_hessian(squares([slope]), first, hessian)
            at = part.stop
        hessian.add_differences(self._calm, 3, self._grid.step)
        jerk = self._grid.differences(control, 3)
        gradient += self._grid.differences_adjoint(self._calm * jerk, 3)
        return hessian, gradient

    def _at(self, control: Floats, first: int, last: int) -> SeatMotion:
        return self._forms.at(self._windows.gather(control, first, last))
