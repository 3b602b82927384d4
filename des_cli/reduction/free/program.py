"""A free motion of the joints as a program for ``solver.barrier``.

The unknowns are the deviations of a spline's control points from those of an executable
base motion, and, where they are free, the two angles at which the seat is fixed. The cost
and the budgets are weighted squares of the seat's quantities at Gauss's points
(``terms``), bounds at these points are ``local_bounds``, and the machine's limits are
rows over differences of control points (``limit_rows``).
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass

import numpy as np

from des_cli.kinematics.seat_turn import SeatTurn
from des_cli.kinematics.twist import SeatForms, SeatMotion
from des_cli.model.arrays import Floats
from des_cli.reduction.free.chunk import Chunk
from des_cli.reduction.free.expansion import MotionExpansion
from des_cli.reduction.free.ground_cross import GROUND_VARIABLES, GroundCross, squares_of
from des_cli.reduction.free.hessian import ConstantBand, PointBlocks, SeatWeight
from des_cli.reduction.free.local_bounds import AttitudeBound, LocalBound
from des_cli.reduction.free.motion_problem import MotionProblem
from des_cli.reduction.free.system import MotionSystem, factorise
from des_cli.reduction.free.terms import JointBudget, Term, square
from des_cli.reduction.free.unknowns import Unknowns
from des_cli.reduction.free.windows import JOINTS, POINTS, Windows
from des_cli.solver.band import SymmetricBand
from des_cli.solver.feasible_program import Values
from des_cli.solver.spline import GAUSS


@dataclass(frozen=True, eq=False)
class Iterate:
    """A program evaluated at a point.

    Parameters
    ----------
    x : (N,) array
    turns : sequence of SeatTurn
        How everything changes with each free angle of the seat.
    seats : sequence of SeatMotion
        The seat's motion on each span of intervals.
    values : Values
    """

    x: Floats
    turns: Sequence[SeatTurn]
    seats: Sequence[SeatMotion]
    values: Values


class MotionProgram:
    """The program of a `MotionProblem`; for its vectors see `Unknowns`.

    The last iterate's evaluation is kept, so that the derivatives are taken of the motion
    whose values were computed already.
    """

    def __init__(self, problem: MotionProblem) -> None:
        self.problem = problem
        grid = problem.grid
        self.unknowns = Unknowns(grid, problem.seat.count if problem.seat else 0)
        self.control, self.seat_angles = self.unknowns.control, self.unknowns.seat_angles
        windows = self.unknowns.seat_windows
        self.chunks = windows.chunks()
        self._base = [windows.gather(problem.base, *span) for span in self.chunks]
        needs_angles = any(isinstance(bound, AttitudeBound) for bound in problem.local)
        self._base_angles = [
            self.unknowns.angle_windows.gather(problem.base, *span)
            if needs_angles
            else np.zeros((JOINTS, 0))
            for span in self.chunks
        ]
        self._ground = Windows(grid, GROUND_VARIABLES)
        self._base_ground = [
            self._ground.gather(problem.base, *span) if problem.ground else np.zeros((0, 0))
            for span in self.chunks
        ]
        self._iterate: Iterate | None = None
        self.bounds = problem.rows.bounds
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
        return self.unknowns.size

    @property
    def free_angles(self) -> int:
        """Free angles of the seat."""
        return self.unknowns.angles

    def linear(self, x: Floats) -> Floats:
        """Return the limited quantities."""
        return self.problem.rows.value(self.control(x))

    def linear_change(self, step: Floats) -> Floats:
        """Return what a step changes of them."""
        return self.problem.rows.change(self.control(step))

    def linear_adjoint(self, multiplier: Floats) -> Floats:
        """Return the transposed rows times multipliers."""
        adjoint = np.zeros(self.size)
        self.control(adjoint)[:] = self.problem.rows.adjoint(multiplier)
        return adjoint

    def reduce(self, gradient: Floats) -> Floats:
        """Return a gradient by the free unknowns."""
        reduced = gradient.copy()
        self.control(reduced)[:] = self.problem.ends.reduce(self.control(gradient))
        return reduced

    def at(self, x: Floats) -> Iterate:
        """Evaluate the functions, or return what they are at the last point asked for."""
        if self._iterate is None or not np.array_equal(self._iterate.x, x):
            self._iterate = self._evaluated(x.copy())
        return self._iterate

    def values(self, x: Floats) -> Values:
        """Evaluate cost, budgets and local bounds."""
        return self.at(x).values

    def expand(
        self, x: Floats, budget: Floats, local: Floats, stiffness: Floats
    ) -> MotionExpansion:
        """Evaluate with first derivatives and the Hessian of the Lagrangian."""
        problem, control = self.problem, self.control(x)
        iterate = self.at(x)
        total = MotionExpansion(self.unknowns, len(problem.budgets))
        total.parts.append(ConstantBand(self._smooth))
        total.budgets += [each.floor for each in problem.budgets]
        found: list[list[Floats]] = [[] for _ in problem.local]
        for chunk, (first, last) in enumerate(self.chunks):
            # a copy, so that the derivatives of the motion last no longer than their span
            seat = copy(iterate.seats[chunk])
            local_at = Chunk(total, seat, iterate.turns, first, last)
            for term in problem.cost:
                total.cost += self._take(local_at, term, 1.0, control, total.gradient)
            for j, each in enumerate(problem.budgets):
                total.budgets[j] += self._take(
                    local_at, each, budget[j], control, total.by_budget[j]
                )
            if problem.ground:
                total.cost += self._take_ground(problem.ground, chunk, control, total)
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
                total.parts.append(ConstantBand(self._mass, 2.0 * each.scale * factor))
        jerk = problem.grid.differences(control, 3)
        total.cost += self._smoothness(control) + self._seat_cost(x)
        of_motion = self.control(total.gradient)
        of_motion += problem.grid.differences_adjoint(self._per_jerk * jerk, 3)
        if problem.seat:
            of_angles = self.seat_angles(total.gradient)
            of_angles += problem.seat.weight * self.seat_angles(x)
            total.parts.append(SeatWeight(problem.seat.weight))
        total.local = _joined(found)
        return total

    def system(
        self, expansion: MotionExpansion, share: float, stiffness: Floats, shift: float
    ) -> MotionSystem | None:
        """Factorise over the free unknowns."""
        problem = self.problem
        return factorise(expansion.hessian(share), problem.rows, problem.ends, stiffness, shift)

    def _evaluated(self, x: Floats) -> Iterate:
        problem, control = self.problem, self.control(x)
        forms, turns = self._forms(x)
        cost, budgets = 0.0, np.array([budget.floor for budget in problem.budgets])
        local: list[list[Floats]] = [[] for _ in problem.local]
        seats: list[SeatMotion] = []
        for chunk, (first, last) in enumerate(self.chunks):
            deviation = self.unknowns.seat_windows.gather(control, first, last)
            seat = forms.at(self._base[chunk] + deviation)
            at = slice(POINTS * first, POINTS * last)
            cost += sum(self._value(t, seat, control, first, last) for t in problem.cost)
            for j, budget in enumerate(problem.budgets):
                budgets[j] += self._value(budget, seat, control, first, last)
            if problem.ground:
                cost += square(problem.ground.residual(self._ground_at(chunk, control)))
            if problem.local:
                angles = self._angles_of(chunk, control)
                for found, bound in zip(local, problem.local, strict=True):
                    found.append(bound.value(seat, angles, at).reshape(-1))
            seats.append(seat)
        cost += self._smoothness(control) + self._seat_cost(x)
        return Iterate(x, turns, seats, Values(cost, budgets, _joined(local)))

    def _value(
        self, term: Term | JointBudget, seat: SeatMotion, control: Floats, first: int, last: int
    ) -> float:
        """Return what a term or budget is on a chunk."""
        at = slice(POINTS * first, POINTS * last)
        if isinstance(term, JointBudget):
            deviation = self.unknowns.angle_windows.gather(control, first, last)
            return term.scale * square(term.residual(deviation, at))
        return square(term.residual(seat, at))

    def _take(
        self,
        chunk: Chunk,
        term: Term | JointBudget,
        factor: float,
        control: Floats,
        gradient: Floats,
    ) -> float:
        """Add a term or budget on a chunk; return its value."""
        if isinstance(term, JointBudget):
            return chunk.take_joints(term, control, gradient)
        return chunk.take(term, factor, gradient)

    def _take_ground(
        self, term: GroundCross, chunk: int, control: Floats, total: MotionExpansion
    ) -> float:
        """Add the cost in ground axes on a chunk; return its value."""
        first, _ = self.chunks[chunk]
        z = self._ground_at(chunk, control)
        residual, slope = term.residual(z), term.slope(z)
        by_variable = np.einsum("krm,rm->km", slope, 2.0 * residual)
        self._ground.scatter(by_variable, first, self.control(total.gradient))
        convex, curvature = 2.0 * squares_of(slope), 2.0 * term.curvature(z, residual)
        total.parts.append(PointBlocks(self._ground, first, convex, curvature))
        return square(residual)

    def _ground_at(self, chunk: int, control: Floats) -> Floats:
        """Return what the cost in ground axes depends on, (5, m)."""
        return self._base_ground[chunk] + self._ground.gather(control, *self.chunks[chunk])

    def _forms(self, x: Floats) -> tuple[SeatForms, Sequence[SeatTurn]]:
        if self.problem.seat is None:
            return self.problem.forms, ()
        return self.problem.seat.at(self.seat_angles(x))

    def _angles_of(self, chunk: int, control: Floats) -> Floats:
        """Return the joint angles at a chunk's points, if a bound needs them."""
        if not self._base_angles[chunk].size:
            return self._base_angles[chunk]
        return self._base_angles[chunk] + self.unknowns.angle_windows.gather(
            control, *self.chunks[chunk]
        )

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
    return 1 if bound.per_interval else POINTS


def _joined(parts: list[list[Floats]]) -> Floats:
    return np.concatenate([np.concatenate(part) for part in parts]) if parts else np.zeros(0)
