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

from des_cli.kinematics.seat_turn import SeatTurn, mixed_force, mixed_force_slope
from des_cli.kinematics.twist import VARIABLES, SeatForms, SeatMotion
from des_cli.model.arrays import Floats
from des_cli.reduction.ground_cross import GROUND_VARIABLES, GroundCross, squares_of
from des_cli.reduction.limit_rows import LimitRows
from des_cli.reduction.local_bounds import (
    AttitudeBound,
    ComponentBound,
    LocalBound,
    NormBound,
    OnsetBound,
)
from des_cli.reduction.motion_system import MotionExpansion, MotionSystem, factorise
from des_cli.reduction.terms import Quantity, Term, curvature_of, slope_of, squares, value_of
from des_cli.reduction.windows import JOINTS, POINTS, Windows
from des_cli.solver.band import SymmetricBand
from des_cli.solver.barrier import Values
from des_cli.solver.spline import GAUSS, Ends, SplineGrid

SEAT_VARIABLES = ((0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2))
"""Order and joint of the variables of ``kinematics.twist``, in their order."""


@dataclass(frozen=True, eq=False)
class JointBudget:
    """Squared deviation of the joint angles, over that of a budget.

    Parameters
    ----------
    scale : float
        Quadrature weight over the squared budget [1/rad^2].
    off : (3, p) array
        Base angles minus the reference's, at all points [rad].
    """

    scale: float
    off: Floats


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
        cost, budgets = 0.0, np.zeros(len(problem.budgets))
        local: list[list[Floats]] = [[] for _ in problem.local]
        for chunk, (first, last) in enumerate(self.chunks):
            seat = forms.at(self._base[chunk] + self.windows.gather(control, first, last))
            at = slice(POINTS * first, POINTS * last)
            cost += sum(self._value(t, seat, control, first, last) for t in problem.cost)
            for j, budget in enumerate(problem.budgets):
                budgets[j] += self._value(budget, seat, control, first, last)
            if problem.ground:
                z = self._base_ground[chunk] + self.ground.gather(control, first, last)
                cost += _square(problem.ground.residual(z))
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
        found: list[list[Floats]] = [[] for _ in problem.local]
        for chunk, (first, last) in enumerate(self.chunks):
            seat = forms.at(self._base[chunk] + self.windows.gather(control, first, last))
            local_at = _Chunk(self, total, seat, turns, share, first, last)
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
            return term.scale * _square(self.off(term, control, first, last))
        return _square(term.residual(seat, slice(POINTS * first, POINTS * last)))

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
        return _square(residual)

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


class _Chunk:
    """Derivatives on a span of intervals, collected until they go to the control points."""

    def __init__(
        self,
        program: MotionProgram,
        total: MotionExpansion,
        seat: SeatMotion,
        turns: Sequence[SeatTurn],
        share: float,
        first: int,
        last: int,
    ) -> None:
        self.program, self.total, self.seat, self.share = program, total, seat, share
        self.first, self.last = first, last
        self.at = slice(POINTS * first, POINTS * last)
        self.turns = turns
        self.turned = [turn.of(seat) for turn in turns]
        self.slopes: list[Floats] = []  # by the variables, scaled
        self.turned_slopes: list[Floats] = []  # the same by the seat's angles, (s, 3, m)
        self.multipliers: dict[Quantity, Floats] = {}
        m = seat.rate.shape[1]
        self.across = np.zeros((len(turns), VARIABLES, m))  # by the seat's angles and these

    def take(
        self, term: Term | JointBudget, factor: float, gradient: Floats, control: Floats
    ) -> float:
        """Add a term times a factor; return its value."""
        program, seat = self.program, self.seat
        if isinstance(term, JointBudget):  # its Hessian is constant, and added at the end
            off = program.off(term, control, self.first, self.last)
            into = program.control(gradient)
            program.angles.scatter(2.0 * term.scale * off, self.first, into)
            return term.scale * _square(off)
        residual = term.residual(seat, self.at)
        slope = term.slope(seat)
        by_variable = np.zeros((VARIABLES, residual.shape[1]))
        np.einsum("krm,rm->km", slope, 2.0 * residual, out=by_variable[: len(slope)])
        program.windows.scatter(by_variable, self.first, program.control(gradient))
        root = np.sqrt(2.0 * factor)
        self.slopes.append(root * slope)
        self._push(term.quantity, (2.0 * factor * self.share) * term.multiplier(residual))
        if self.turns:
            by_seat = np.stack(
                [term.weigh(_turned_value(seat, t, term.quantity)) for t in self.turned]
            )
            program.seat_angles(gradient)[:] += np.einsum("srm,rm->s", by_seat, 2.0 * residual)
            self.turned_slopes.append(root * by_seat)
        return _square(residual)

    def bind(
        self,
        bound: LocalBound,
        angles: Floats,
        rows: slice,
        multiplier: Floats,
        stiffness: Floats,
    ) -> Floats:
        """Add a local bound's share of the Hessian and keep its slopes; return its values."""
        program, total = self.program, self.total
        value = bound.value(self.seat, angles, self.at)
        slope = bound.slope(self.seat, angles, self.at)
        multiplier, stiffness = multiplier.reshape(value.shape), stiffness.reshape(value.shape)
        windows = program.angles if isinstance(bound, AttitudeBound) else program.windows
        by_seat = self._by_seat(bound, value.shape)
        total.keep(rows, windows, slope, by_seat, self.first)
        if isinstance(bound, AttitudeBound):
            hessian = np.stack(
                [
                    np.sum(stiffness * slope[k] * slope[n], axis=0)
                    for k in range(JOINTS)
                    for n in range(k, JOINTS)
                ]
            )
            if self.share > 0.0:
                hessian += self.share * bound.curvature(self.seat, angles, self.at, multiplier)
            program.angles.scatter_hessian(hessian, self.first, total.band)
            return value.reshape(-1)
        if isinstance(bound, OnsetBound):
            window = program.windows.to_window(slope)
            program.windows.scatter_squares(np.sqrt(stiffness) * window, self.first, total.band)
            if self.turns:
                stiff = slope * np.tile(stiffness, (1, POINTS))
                both = np.tile(by_seat, (1, 1, POINTS))
                self.across += np.einsum("krm,srm->skm", stiff, both)
                total.corner += np.einsum("srm,trm,rm->st", by_seat, by_seat, stiffness)
        else:
            self.slopes.append(np.sqrt(stiffness) * slope)
            if self.turns:
                self.turned_slopes.append(np.sqrt(stiffness) * by_seat)
        if self.share > 0.0:
            if isinstance(bound, ComponentBound | OnsetBound):
                self._push("force", self.share * bound.push(multiplier))
            elif isinstance(bound, NormBound):
                self._push_length(bound, self.share * multiplier[0])
        return value.reshape(-1)

    def _by_seat(self, bound: LocalBound, shape: tuple[int, ...]) -> Floats:
        """Return the derivatives of a bound's rows by the seat's angles, (s, r, m)."""
        by_seat = np.zeros((len(self.turns), *shape))
        for s, turned in enumerate(self.turned):
            if isinstance(bound, ComponentBound | OnsetBound):
                by_seat[s] = bound.along(mixed_force(self.seat, turned))
            elif isinstance(bound, NormBound):
                change = _turned_value(self.seat, turned, bound.quantity)
                along = np.sum(change * value_of(self.seat, bound.quantity), axis=0)
                by_seat[s] = 2.0 / bound.bound**2 * along
        return by_seat

    def _push_length(self, bound: NormBound, multiplier: Floats) -> None:
        """Add the curvature of a bound on a length: a square's, and the quantity's own."""
        weight = 2.0 * multiplier / bound.bound**2
        self._push(bound.quantity, weight * value_of(self.seat, bound.quantity))
        root = np.sqrt(weight)
        self.slopes.append(root * slope_of(self.seat, bound.quantity))
        if self.turns:
            self.turned_slopes.append(
                root * np.stack([_turned_value(self.seat, t, bound.quantity) for t in self.turned])
            )

    def finish(self) -> None:
        """Bring what was collected to the control points and the seat's angles."""
        pairs = VARIABLES * (VARIABLES + 1) // 2
        hessian = squares(self.slopes) if self.slopes else np.zeros((pairs, self.across.shape[2]))
        if self.share > 0.0:
            hessian += curvature_of(self.seat, self.multipliers)
        self.program.windows.scatter_hessian(hessian, self.first, self.total.band)
        if not self.turns:
            return
        count = len(self.turns)
        across = self.across
        for slope, by_seat in zip(self.slopes, self.turned_slopes, strict=True):
            across[:, : len(slope)] += np.einsum("krm,srm->skm", slope, by_seat)
            self.total.corner += np.einsum("srm,trm->st", by_seat, by_seat)
        for s, one in enumerate(self.turned):
            for quantity, push in self.multipliers.items():
                bent = _turned_slope(self.seat, one, quantity)
                across[s, : len(bent)] += np.einsum("kcm,cm->km", bent, push)
                for t in range(s, count):
                    # the outer turn acts on what the inner one has changed
                    twice = self.turns[t].of(one)
                    value = _turned_value(self.seat, twice, quantity)
                    if quantity == "force":
                        value = value + _both_turned(one, self.turned[t])
                    amount = float(np.sum(push * value))
                    self.total.corner[s, t] += amount
                    if s != t:
                        self.total.corner[t, s] += amount
        for s in range(count):
            column = self.total.border[s].reshape(-1, JOINTS)
            self.program.windows.scatter(across[s], self.first, column)

    def _push(self, quantity: Quantity, push: Floats) -> None:
        known = self.multipliers.get(quantity)
        self.multipliers[quantity] = push if known is None else known + push


def _turned_value(seat: SeatMotion, turned: SeatMotion, quantity: Quantity) -> Floats:
    """Return the derivative of a quantity by a turn of the seat, (3, m)."""
    return mixed_force(seat, turned) if quantity == "force" else value_of(turned, quantity)


def _turned_slope(seat: SeatMotion, turned: SeatMotion, quantity: Quantity) -> Floats:
    """Return its derivatives by the variables, (5 or 8, 3, m)."""
    return mixed_force_slope(seat, turned) if quantity == "force" else slope_of(turned, quantity)


def _both_turned(one: SeatMotion, other: SeatMotion) -> Floats:
    """Return what two turns add to the force's second derivative, each in one factor."""
    a, b = one.twist, other.twist
    return np.cross(a[:3], b[3:], axis=0) + np.cross(b[:3], a[3:], axis=0)


def _points_a_row(bound: LocalBound) -> int:
    """Return how often a bound's rows stand on one interval."""
    return 1 if isinstance(bound, OnsetBound) else POINTS


def _square(residual: Floats) -> float:
    flat = residual.reshape(-1)
    return float(flat @ flat)


def _joined(parts: list[list[Floats]]) -> Floats:
    return np.concatenate([np.concatenate(part) for part in parts]) if parts else np.zeros(0)
