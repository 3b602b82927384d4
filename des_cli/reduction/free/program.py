"""A free motion of the joints as a program for ``solver.barrier``.

The unknowns are the deviations of a spline's control points from those of an executable
base motion, and, where they are free, the two angles at which the seat is fixed. The cost
and the budgets are weighted squares of the seat's quantities at Gauss's points
(``terms``), bounds at these points are ``local_bounds``, and the machine's limits are
rows over differences of control points (``limit_rows``).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from des_cli.kinematics.seat_turn import SeatTurn
from des_cli.kinematics.twist import SeatForms, SeatMotion
from des_cli.model.arrays import Floats
from des_cli.reduction.free.chunk import Chunk
from des_cli.reduction.free.ground_cross import GROUND_VARIABLES, GroundCross, squares_of
from des_cli.reduction.free.limit_rows import LimitRows
from des_cli.reduction.free.local_bounds import AttitudeBound, LocalBound, OnsetBound
from des_cli.reduction.free.system import MotionExpansion, MotionSystem, factorise
from des_cli.reduction.free.terms import JointBudget, Term, square
from des_cli.reduction.free.windows import JOINTS, POINTS, Windows
from des_cli.solver.band import SymmetricBand
from des_cli.solver.feasible_program import Values
from des_cli.solver.spline import GAUSS, Ends, SplineGrid

SEAT_VARIABLES = ((0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2))
"""Order and joint of the variables of ``kinematics.twist``, in their order."""


@dataclass(frozen=True, eq=False)
class FreeSeat:
    """How the seat's free angles change what is felt.

    Parameters
    ----------
    count : int
        Free angles, s.
    at : callable
        Of the angles' change (s,) [rad]: the forms of the seat, and for each angle how
        everything changes with it further, the outermost in the chain last.
    weight : float
        On the squared change, which determines it where nothing else does [1/rad^2].
    """

    count: int
    at: Callable[[Floats], tuple[SeatForms, Sequence[SeatTurn]]]
    weight: float


@dataclass(frozen=True, eq=False)
class MotionProblem:
    """Everything that defines a free motion's program.

    Parameters
    ----------
    grid : SplineGrid
    base : (n, 3) array
        Control points of the executable motion that deviations are added to [rad].
    forms : SeatForms
        Of the seat as the profile fixes it.
    cost : sequence of Term or JointBudget
        Summed up.
    ground : GroundCross, optional
        A further cost, of the cross-coupling in ground axes.
    budgets : sequence of Term or JointBudget
        Each at most one.
    rows : LimitRows
    ends : Ends
    smoothing : (3,) array
        Weight on the squared jerk of the deviation, per joint [s^5/rad^2].
    local : sequence of LocalBound
        Bounds at points.
    seat : FreeSeat, optional
    """

    grid: SplineGrid
    base: Floats
    forms: SeatForms
    cost: Sequence[Term | JointBudget]
    budgets: Sequence[Term | JointBudget]
    rows: LimitRows
    ends: Ends
    smoothing: Floats
    local: Sequence[LocalBound] = field(default_factory=tuple)
    seat: FreeSeat | None = None
    ground: GroundCross | None = None


class MotionProgram:
    """The program of a `MotionProblem`.

    A vector of the full space is flat: control points, (n, 3), then the seat's angles.
    """

    def __init__(self, problem: MotionProblem) -> None:
        self.problem = problem
        grid = problem.grid
        self.windows = Windows(grid, SEAT_VARIABLES)
        self.angles = Windows(grid, tuple((0, joint) for joint in range(JOINTS)))
        self.chunks = self.windows.chunks()
        self._base = [self.windows.gather(problem.base, *span) for span in self.chunks]
        needs_angles = any(isinstance(bound, AttitudeBound) for bound in problem.local)
        self._base_angles = [
            self.angles.gather(problem.base, *span) if needs_angles else np.zeros((JOINTS, 0))
            for span in self.chunks
        ]
        self.ground = Windows(grid, GROUND_VARIABLES)
        self._base_ground = [
            self.ground.gather(problem.base, *span) if problem.ground else np.zeros((0, 0))
            for span in self.chunks
        ]
        self.bounds = problem.rows.bounds
        self.free_angles = problem.seat.count if problem.seat else 0
        self._per_jerk = np.broadcast_to(
            2.0 * grid.step * problem.smoothing, (grid.intervals, JOINTS)
        )
        self._smooth = SymmetricBand(grid.points, JOINTS)
        self._smooth.add_differences(self._per_jerk, 3, grid.step)
        self._mass = SymmetricBand(grid.points, JOINTS)
        if any(isinstance(each, JointBudget) for each in (*problem.cost, *problem.budgets)):
            weight = grid.basis(np.array(GAUSS), 0)
            for b in range(4):
                for a in range(b, 4):
                    square = float(weight[:, a] @ weight[:, b])
                    self._mass.data[b : b + grid.intervals, :, JOINTS * (a - b)] += square

    @property
    def size(self) -> int:
        """Length of a vector of the full space."""
        return self.problem.base.size + self.free_angles

    def linear(self, x: Floats) -> Floats:
        """Return the limited quantities."""
        return self.problem.rows.value(self.control(x))

    def linear_change(self, step: Floats) -> Floats:
        """Return what a step changes of them."""
        return self.problem.rows.change(self.control(step))

    def linear_adjoint(self, multiplier: Floats) -> Floats:
        """Return the transposed rows times multipliers."""
        adjoint = np.zeros(self.size)
        adjoint[: self.problem.base.size] = self.problem.rows.adjoint(multiplier).reshape(-1)
        return adjoint

    def reduce(self, gradient: Floats) -> Floats:
        """Return a gradient by the free unknowns."""
        reduced = gradient.copy()
        kept = self.problem.ends.reduce(self.control(gradient))
        reduced[: self.problem.base.size] = kept.reshape(-1)
        return reduced

    def control(self, x: Floats) -> Floats:
        """Return the part of a vector that is control points, (n, 3)."""
        return x[: self.problem.base.size].reshape(-1, JOINTS)

    def seat_angles(self, x: Floats) -> Floats:
        """Return the part of a vector that is the seat's angles [rad]."""
        return x[self.problem.base.size :]

    def values(self, x: Floats) -> Values:
        """Evaluate cost, budgets and local bounds."""
        problem, control = self.problem, self.control(x)
        forms, _ = self._forms(x)
        cost, budgets = 0.0, np.array([budget.floor for budget in problem.budgets])
        local: list[list[Floats]] = [[] for _ in problem.local]
        for chunk, (first, last) in enumerate(self.chunks):
            seat = forms.at(self._base[chunk] + self.windows.gather(control, first, last))
            at = slice(POINTS * first, POINTS * last)
            cost += sum(self._value(t, seat, control, first, last) for t in problem.cost)
            for j, budget in enumerate(problem.budgets):
                budgets[j] += self._value(budget, seat, control, first, last)
            if problem.ground:
                z = self._base_ground[chunk] + self.ground.gather(control, first, last)
                cost += square(problem.ground.residual(z))
            if problem.local:
                angles = self._angles_of(chunk, control)
                for found, bound in zip(local, problem.local, strict=True):
                    found.append(bound.value(seat, angles, at).reshape(-1))
        cost += self._smoothness(control) + self._seat_cost(x)
        return Values(cost, budgets, _joined(local))

    def expand(
        self, x: Floats, budget: Floats, local: Floats, stiffness: Floats, share: float
    ) -> MotionExpansion:
        """Evaluate with first derivatives and the Hessian of the Lagrangian."""
        problem, control = self.problem, self.control(x)
        forms, turns = self._forms(x)
        total = MotionExpansion.zero(self, len(problem.budgets))
        total.band.data += self._smooth.data
        total.budgets += [budget.floor for budget in problem.budgets]
        found: list[list[Floats]] = [[] for _ in problem.local]
        for chunk, (first, last) in enumerate(self.chunks):
            seat = forms.at(self._base[chunk] + self.windows.gather(control, first, last))
            local_at = Chunk(self, total, seat, turns, share, first, last)
            for term in problem.cost:
                total.cost += local_at.take(term, 1.0, total.gradient, control)
            for j, each in enumerate(problem.budgets):
                total.budgets[j] += local_at.take(each, budget[j], total.by_budget[j], control)
            if problem.ground:
                total.cost += self._take_ground(problem.ground, chunk, control, share, total)
            if problem.local:
                angles = self._angles_of(chunk, control)
                for index, bound in enumerate(problem.local):
                    rows = self._rows_of(index, chunk)
                    found[index].append(
                        local_at.bind(bound, angles, rows, local[rows], stiffness[rows])
                    )
            local_at.finish()
        factors = [*np.ones(len(problem.cost)), *budget]
        for each, factor in zip([*problem.cost, *problem.budgets], factors, strict=True):
            if isinstance(each, JointBudget):
                total.band.data += (2.0 * each.scale * factor) * self._mass.data
        jerk = problem.grid.differences(control, 3)
        total.cost += self._smoothness(control) + self._seat_cost(x)
        of_motion = self.control(total.gradient)
        of_motion += problem.grid.differences_adjoint(self._per_jerk * jerk, 3)
        if problem.seat:
            total.gradient[problem.base.size :] += problem.seat.weight * self.seat_angles(x)
            total.corner += problem.seat.weight * np.eye(self.free_angles)
        total.local = _joined(found)
        return total

    def system(
        self, expansion: MotionExpansion, stiffness: Floats, shift: float
    ) -> MotionSystem | None:
        """Factorise over the free unknowns."""
        return factorise(expansion, self.problem.rows, self.problem.ends, stiffness, shift)

    def off(self, budget: JointBudget, control: Floats, first: int, last: int) -> Floats:
        """Return how far the angles are from the reference at points, (3, m) [rad]."""
        moved = self.angles.gather(control, first, last)
        return np.asarray(budget.off[:, POINTS * first : POINTS * last] + moved)

    def _value(
        self, term: Term | JointBudget, seat: SeatMotion, control: Floats, first: int, last: int
    ) -> float:
        """Return what a term or budget is on a chunk."""
        if isinstance(term, JointBudget):
            return term.scale * square(self.off(term, control, first, last))
        return square(term.residual(seat, slice(POINTS * first, POINTS * last)))

    def _take_ground(
        self,
        term: GroundCross,
        chunk: int,
        control: Floats,
        share: float,
        total: MotionExpansion,
    ) -> float:
        """Add the cost in ground axes on a chunk; return its value."""
        first, last = self.chunks[chunk]
        z = self._base_ground[chunk] + self.ground.gather(control, first, last)
        residual, slope = term.residual(z), term.slope(z)
        by_variable = np.einsum("krm,rm->km", slope, 2.0 * residual)
        self.ground.scatter(by_variable, first, self.control(total.gradient))
        hessian = 2.0 * squares_of(slope)
        if share > 0.0:
            hessian += 2.0 * share * term.curvature(z, residual)
        self.ground.scatter_hessian(hessian, first, total.band)
        return square(residual)

    def _forms(self, x: Floats) -> tuple[SeatForms, Sequence[SeatTurn]]:
        if self.problem.seat is None:
            return self.problem.forms, ()
        return self.problem.seat.at(self.seat_angles(x))

    def _angles_of(self, chunk: int, control: Floats) -> Floats:
        """Return the joint angles at a chunk's points, if a bound needs them."""
        if not self._base_angles[chunk].size:
            return self._base_angles[chunk]
        return self._base_angles[chunk] + self.angles.gather(control, *self.chunks[chunk])

    def _rows_of(self, index: int, chunk: int) -> slice:
        """Return where a bound's rows of a chunk stand among all local rows."""
        intervals = self.problem.grid.intervals
        start = 0
        for bound in self.problem.local[:index]:
            start += bound.rows * intervals * _points_a_row(bound)
        bound = self.problem.local[index]
        each = bound.rows * _points_a_row(bound)
        first, last = self.chunks[chunk]
        return slice(start + each * first, start + each * last)

    def _smoothness(self, control: Floats) -> float:
        jerk = self.problem.grid.differences(control, 3)
        return 0.5 * float(np.sum(self._per_jerk * jerk**2))

    def _seat_cost(self, x: Floats) -> float:
        if self.problem.seat is None:
            return 0.0
        return 0.5 * self.problem.seat.weight * float(np.sum(self.seat_angles(x) ** 2))


def _points_a_row(bound: LocalBound) -> int:
    """Return how often a bound's rows stand on one interval."""
    return 1 if isinstance(bound, OnsetBound) else POINTS


def _joined(parts: list[list[Floats]]) -> Floats:
    return np.concatenate([np.concatenate(part) for part in parts]) if parts else np.zeros(0)
