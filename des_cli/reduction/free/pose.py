"""The program of a free motion on a grid: its cost, budgets, bounds and ends."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.coriolis import coriolis
from des_cli.kinematics.seat_turn import SeatTurn, seat_turns
from des_cli.kinematics.twist import SeatForms, SeatMotion, seat_forms
from des_cli.model.arrays import Floats
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_DEVIATION,
    ANGULAR_ACCELERATION_ERROR,
    ANGULAR_ACCELERATION_RMS_RATIO,
    JOINT_DEVIATION,
    JOINT_DEVIATION_SQUARED,
    METRICS,
    PEAK_METRICS,
    SEAT_G_DEVIATION,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
    UNFELT_ANGULAR_ACCELERATION,
    Budget,
    MetricKey,
)
from des_cli.model.profile import Reduction
from des_cli.reduction.free.bounds import occupant_bounds, point_bound
from des_cli.reduction.free.ground_cross import GroundCross
from des_cli.reduction.free.limit_rows import LimitRows, Tie
from des_cli.reduction.free.motion_problem import FreeSeat, MotionProblem
from des_cli.reduction.free.requested import Requested
from des_cli.reduction.free.task import SEAT_ANGLES, FreeTask, turned_seat
from des_cli.reduction.free.terms import JointBudget, Quantity, Term
from des_cli.reduction.free.unknowns import SEAT_VARIABLES
from des_cli.reduction.free.windows import JOINTS as COMPONENTS
from des_cli.reduction.free.windows import Windows
from des_cli.reduction.reference import sample_motion
from des_cli.solver.spline import SplineGrid
from des_cli.units import STANDARD_GRAVITY_M_S2

BLEND = 0.1
"""Weight of the felt error in the objective ``blend``, relative to the cross-coupling."""

REGULARISATION = 1e-6
"""Weight on the mean square of the deviation's jerk, in units of the acceleration limits
per second, beside a cost that is one for the desired motion: it determines what neither
cost nor budgets do."""

SEAT_WEIGHT = 1e-6
"""Weight on the squared change of the seat's angles [1/rad^2], for the same reason."""

MARGIN = 1e-6
"""Relative distance that the solver keeps from a machine limit: room for the rounding of
whoever differentiates a table of positions twice."""

UNIT_ACCELERATION = 1.0
"""Acceleration [rad/s^2] that the regularisation takes for a joint without a limit."""

_INTEGRALS: Mapping[MetricKey, Quantity] = MappingProxyType(
    {
        SEAT_RATE_DEVIATION: "rate",
        SEAT_G_DEVIATION: "force",
        SEAT_G_ERROR: "force",
        ANGULAR_ACCELERATION_DEVIATION: "acceleration",
        ANGULAR_ACCELERATION_ERROR: "acceleration",
        ANGULAR_ACCELERATION_RMS_RATIO: "acceleration",
    }
)
"""What of the ride a metric is the integral of."""


def pose_motion(
    task: FreeTask, grid: SplineGrid, base: Floats, ties: Sequence[Tie] = ()
) -> MotionProblem:
    """Make the program's problem on a grid round an executable base.

    Parameters
    ----------
    task : FreeTask
    grid : SplineGrid
    base : (n, 3) array
        Control points [rad].
    ties : sequence of Tie
    """
    reduction = task.reduction
    forms = seat_forms(task.chain, task.machine.gravity)
    windows = Windows(grid, SEAT_VARIABLES)
    times = windows.times()
    angle, rate, acceleration = (
        (grid.values(base, times, order) for order in range(3))
        if task.round_base
        else sample_motion(task.reference, times)
    )
    seat = forms.at(np.concatenate([angle[:, 1:].T, rate.T, acceleration.T]))
    requested = _requested(seat, task, windows)
    # Of a rough record no motion makes the cross-coupling: costs are relative to the base's.
    along = _along(grid, base) if task.rough(grid) else None
    size = cross_coupling(task, grid) if along is None else _energy(task, grid, *along)
    measures = _Measures(grid, base, angle, requested, size)
    acceleration_limit = np.array([limit.acceleration for limit in task.machine.limits])
    unit = np.where(np.isfinite(acceleration_limit), acceleration_limit, UNIT_ACCELERATION)
    return MotionProblem(
        grid=grid,
        base=base,
        forms=forms,
        cost=measures.cost(reduction),
        budgets=[measures.budget(b) for b in reduction.budget if b.metric not in PEAK_METRICS],
        rows=LimitRows(grid, base, task.limits, task.ends, MARGIN, ties),
        ends=task.ends,
        smoothing=REGULARISATION / (grid.duration * unit**2),
        local=[
            *(
                point_bound(task, times, angle, b)
                for b in reduction.budget
                if b.metric in PEAK_METRICS
            ),
            *occupant_bounds(task.occupant, grid, task.room),
        ],
        seat=_free_seat(task),
        ground=measures.ground(task),
    )


def cross_coupling(task: FreeTask, grid: SplineGrid) -> float:
    """Return the reference's ``int c' R1 c dt``, which the cost is relative to."""
    times = Windows(grid, SEAT_VARIABLES).times()
    angle, rate, _ = sample_motion(task.reference, times)
    return _energy(task, grid, angle, rate)


def _along(grid: SplineGrid, control: Floats) -> tuple[Floats, Floats]:
    """Return a spline's angles and rates at the points of its grid, (p, 3) each."""
    times = Windows(grid, SEAT_VARIABLES).times()
    return grid.values(control, times), grid.values(control, times, 1)


def _energy(task: FreeTask, grid: SplineGrid, angle: Floats, rate: Floats) -> float:
    """Return ``int c' R1 c dt`` of angles and rates at the points."""
    c = coriolis(task.chain, angle, rate, "report" if in_ground_axes(task.reduction) else "seat")
    return float(0.5 * grid.step * np.sum((c @ _root(task.reduction.r1)) ** 2))


def in_ground_axes(reduction: Reduction) -> bool:
    """Return whether the weight needs the study's axes: a weight on the length needs none."""
    isotropic = np.array_equal(reduction.r1, reduction.r1[0, 0] * np.eye(3))
    return reduction.axes == "report" and not isotropic


def _requested(seat: SeatMotion, task: FreeTask, windows: Windows) -> Requested:
    """Return what is asked of the seat: at the points, or of a rough record by its samples."""
    if task.rough(windows.grid):
        return Requested.projected(task.requested(), task.reference.t, windows)
    return Requested.at_points(seat, task.reference, task.shortfall, windows.times())


class _Measures:
    """Costs on a grid, and budgets relative to the size of what is asked for."""

    def __init__(
        self,
        grid: SplineGrid,
        base: Floats,
        angle: Floats,
        requested: Requested,
        size: float,
    ) -> None:
        self.grid, self.base, self.angle, self.requested = grid, base, angle, requested
        self.size = max(size, 1e-300)
        self.weight = 0.5 * grid.step

    def cost(self, reduction: Reduction) -> list[Term]:
        """Return the terms of the objective; the reference's cross-coupling counts one."""
        terms = []
        if reduction.objective != "felt" and not in_ground_axes(reduction):
            terms.append(Term("cross", self._cross_root(reduction)))
        if reduction.objective != "coriolis":
            cross = self.requested.values["cross"]
            share = BLEND if reduction.objective == "blend" else 1.0
            isotropic = np.sqrt(share * np.trace(reduction.r1) / 3.0 * self.weight / self.size)
            target = self.requested.values["acceleration"] - cross
            terms.append(Term("acceleration", isotropic * np.eye(3), target))
        return terms

    def ground(self, task: FreeTask) -> GroundCross | None:
        """Return the cost of the cross-coupling in the study's axes, if that is weighed."""
        if task.reduction.objective == "felt" or not in_ground_axes(task.reduction):
            return None
        return GroundCross(task.chain, self._cross_root(task.reduction))

    def _cross_root(self, reduction: Reduction) -> Floats:
        return np.asarray(_root(reduction.r1) * np.sqrt(self.weight / self.size))

    def budget(self, budget: Budget) -> Term | JointBudget:
        """Return a budget as the square of its metric over the square of its most."""
        quantity, most = _INTEGRALS.get(budget.metric), budget.most
        if budget.metric == JOINT_DEVIATION:
            return self._joints(most)
        if budget.metric == JOINT_DEVIATION_SQUARED:
            return self._joints(float(np.sqrt(most)))
        if quantity is None:
            raise ValueError(f"a free motion has no budget on {budget.metric}")
        if budget.metric == ANGULAR_ACCELERATION_RMS_RATIO:
            least = UNFELT_ANGULAR_ACCELERATION * np.sqrt(self.grid.duration / self.weight)
            scale = min(self._per_size(quantity), 1.0 / least)
            return Term(quantity, scale / most * np.eye(3))
        if METRICS[budget.metric].relative:
            return self._term(quantity, self._per_size(quantity) / most)
        unit = STANDARD_GRAVITY_M_S2 if quantity == "force" else 1.0
        return self._term(quantity, np.sqrt(self.weight / self.grid.duration) / (most * unit))

    def _per_size(self, quantity: Quantity) -> float:
        """Return one over the norm of a quantity of the reference."""
        return 1.0 / max(float(np.sqrt(self.requested.square[quantity])), 1e-150)

    def _term(self, quantity: Quantity, scale: float) -> Term:
        requested = self.requested
        floor = scale**2 * requested.floor[quantity]
        return Term(quantity, scale * np.eye(3), requested.values[quantity], floor)

    def _joints(self, most: float) -> JointBudget:
        windows = Windows(self.grid, tuple((0, joint) for joint in range(COMPONENTS)))
        base = [windows.gather(self.base, *span) for span in windows.chunks()]
        size = max(float(np.sum(self.angle**2)), 1e-300)
        return JointBudget(1.0 / (most**2 * size), np.concatenate(base, axis=1) - self.angle.T)


def _root(weight: Floats) -> Floats:
    """Return a symmetric square root of a positive semidefinite matrix, diagonal if it is."""
    if np.array_equal(weight, np.diag(np.diag(weight))):
        return np.diag(np.sqrt(np.diag(weight)))
    values, vectors = np.linalg.eigh(weight)
    return np.asarray((vectors * np.sqrt(np.maximum(values, 0.0))) @ vectors.T)


def _free_seat(task: FreeTask) -> FreeSeat | None:
    names = [name for name in SEAT_ANGLES if name in task.reduction.optimise]
    present = seat_turns(task.machine, task.seat)
    names = [name for name in present if name in names]
    if not names:
        return None

    def at(change: Floats) -> tuple[SeatForms, list[SeatTurn]]:
        seat = turned_seat(task, change)
        forms = seat_forms(chain_of(task.machine, seat), task.machine.gravity)
        turns = seat_turns(task.machine, seat)
        return forms, [turns[name] for name in names]

    return FreeSeat(len(names), at, SEAT_WEIGHT)
