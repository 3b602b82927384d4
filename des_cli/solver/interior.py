"""A primal-dual interior-point method for problems that are banded in time.

The problem is a cost at samples, dynamics between neighbours, and inequalities
that are local in time. Each iteration solves the Newton system of the perturbed
optimality conditions by one banded factorisation, so that its price is linear
in the number of samples. Without inequalities it is Newton's method with a line
search.

The method is that of Waechter and Biegler (Mathematical Programming 106, 2006)
with their filter line search. Where the exact Hessian is not convex on the
dynamics, its curvature part is taken in until it is; that is found out by a
banded Cholesky factorisation, where a general sparse code would count the
pivots of an indefinite one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from scipy.linalg import LinAlgError

from des_cli.model.arrays import Floats
from des_cli.model.solution import Iteration
from des_cli.solver.filter import Filter, Trial
from des_cli.solver.newton_system import Dynamics, NewtonSystem, transposed
from des_cli.solver.program import Expansion, Program
from des_cli.solver.slacks import Side, longest_step

# Fraction of the way to the boundary that a step may take, at the least
# (Waechter and Biegler, eq. 8).
BOUNDARY_FRACTION = 0.99
# The barrier parameter falls to min(FACTOR * mu, mu ** POWER) once the barrier
# problem is solved to MARGIN * mu (ibid., eq. 7).
BARRIER_FACTOR, BARRIER_POWER, BARRIER_MARGIN = 0.2, 1.5, 10.0
# Violation, relative to the cost's rounding, that counts as none.
FEASIBLE = 1e-3
# The line search gives up below this step.
SHORTEST_STEP = 1e-10
# Where the exact Hessian is not convex on the dynamics, its curvature part is
# taken in by this much less at a time until it is, and in the end left out: what
# remains is a Gauss-Newton Hessian. Between the two it converged in a third of
# the steps that a shifted diagonal needed (95 against 309 on the Cobra per joint,
# BB3, 500 intervals, at the first price of a 5 % budget). The next step begins
# with SHARE_RECOVERY times what worked.
SHARE_DECAY, LEAST_SHARE, SHARE_RECOVERY = 0.7, 0.05, 2.0
# Shifts of the diagonal, relative to the problem's scale, tried after that.
SHIFTS = (0.0, 1e-6, 1e-4, 1e-2, 1.0, 1e2)
# Errors within which a result that misses the tolerance may still be used.
ACCEPTABLE = 1e-6

Report: TypeAlias = Callable[[Iteration], None]
Ending: TypeAlias = Literal["converged", "acceptable", "iteration-limit", "diverged"]


@dataclass(frozen=True)
class Outcome:
    """How the method ended.

    Parameters
    ----------
    status : {"converged", "acceptable", "iteration-limit", "diverged"}
        ``acceptable`` is short of the tolerance but within ``ACCEPTABLE``.
    x : (n, 3 + m) array
    multiplier : (n - 1, 3) array
        Of the dynamics.
    cost, optimality, infeasibility : float
    log : tuple of Iteration
    """

    status: Ending
    x: Floats
    multiplier: Floats
    cost: float
    optimality: float
    infeasibility: float
    log: tuple[Iteration, ...]

    @property
    def usable(self) -> bool:
        """Whether the errors are within the tolerance, or acceptable."""
        return self.status in ("converged", "acceptable")


def minimise(
    program: Program,
    x: Floats,
    *,
    tolerance: float = 1e-9,
    max_iterations: int = 200,
    barrier: float = 1.0,
    first_number: int = 0,
    on_iteration: Report | None = None,
) -> Outcome:
    """Minimise a program's cost from a start.

    Parameters
    ----------
    program : Program
    x : (n, 3 + m) array
        The start; pinned unknowns keep these values.
    tolerance : float
        On the first-order conditions, scaled and per unit time, and on the
        violation of dynamics [rad] and scaled inequalities.
    max_iterations : int
    barrier : float
        First barrier parameter, relative to the program's scale.
    first_number : int
        Number of the first line of the log.
    on_iteration : callable, optional
        Called with each line of the log.
    """
    return _Method(program, x, tolerance, barrier).run(max_iterations, first_number, on_iteration)


@dataclass(frozen=True)
class _Local:
    """What is known at one iterate; recomputed after every step."""

    expansion: Expansion
    defect: Floats
    excess: list[Floats]  # two for each set of rows: upper, lower
    rows: list[tuple[Floats, Floats | None]]  # Jacobians
    dynamics: tuple[Floats, Floats]
    movable: Dynamics


@dataclass(frozen=True)
class _Step:
    """A step of everything that moves, and how far it may go."""

    x: Floats
    multiplier: Floats
    slacks: list[Floats]
    duals: list[Floats]
    longest: float
    longest_dual: float


class _Method:
    """The state of one minimisation."""

    def __init__(self, program: Program, x: Floats, tolerance: float, barrier: float) -> None:
        self.program = program
        self.x = x.copy()
        self.n, self.width = x.shape
        self.tolerance = tolerance
        self.multiplier = np.zeros((self.n - 1, 3))
        # the force on one unknown that counts as large
        self.unit = program.scale * float(program.weight.sum()) / self.n
        self.mu = barrier * self.unit
        self.least_mu = 0.1 * tolerance * self.unit
        self.share = 1.0
        self._linear: tuple[tuple[Floats, Floats], Dynamics] | None = None
        self.sides: list[Side] = []
        for rows in program.rows:
            value = rows.value(self.x)
            self.sides.append(Side.at(1.0, value, self.mu))
            self.sides.append(Side.at(-1.0, value, self.mu))
        violation = _violation(program.defect(self.x), self._excess(self.x))
        self.filter = Filter(violation, self.unit)

    def run(self, max_iterations: int, first_number: int, on_iteration: Report | None) -> Outcome:
        log: list[Iteration] = []
        step = 0.0
        status: Ending = "iteration-limit"
        while True:
            local = self._look()
            optimality, infeasibility = self._errors(local)
            log.append(
                Iteration(
                    first_number + len(log), local.expansion.cost, infeasibility, optimality, step
                )
            )
            if on_iteration is not None:
                on_iteration(log[-1])
            gap = max((_largest(s.slack * s.dual) for s in self.sides), default=0.0)
            if max(optimality, infeasibility) <= self.tolerance and gap <= 10 * self.least_mu:
                status = "converged"
                break
            if len(log) > max_iterations:
                break
            self._lower_barrier(max(optimality, infeasibility))
            taken = self._advance(local)
            if taken is None:
                status = "diverged"
                break
            step = taken
        if status != "converged" and max(optimality, infeasibility, gap / self.unit) <= ACCEPTABLE:
            status = "acceptable"
        return Outcome(
            status, self.x, self.multiplier, log[-1].cost, optimality, infeasibility, tuple(log)
        )

    # ------------------------------------------------------------------ at an iterate
    def _look(self) -> _Local:
        return _Local(
            expansion=self.program.expand(self.x),
            defect=self.program.defect(self.x),
            excess=self._excess(self.x),
            rows=[rows.jacobian(self.x) for rows in self.program.rows],
            dynamics=(dynamics := self.program.defect_jacobian(self.x)),
            movable=self._movable(dynamics),
        )

    def _movable(self, dynamics: tuple[Floats, Floats]) -> Dynamics:
        """Return the dynamics of what moves, kept where they are the same at every iterate."""
        if self._linear is None or self._linear[0] is not dynamics:
            self._linear = (dynamics, Dynamics(*dynamics, self.program.pinned))
        return self._linear[1]

    def _excess(self, x: Floats) -> list[Floats]:
        excess = []
        for index, rows in enumerate(self.program.rows):
            value = rows.value(x)
            excess += [side.excess(value) for side in self.sides[2 * index : 2 * index + 2]]
        return excess

    def _errors(self, local: _Local) -> tuple[float, float]:
        """Return the violation of the first-order conditions, and of the constraints."""
        gradient = local.expansion.gradient.copy()
        left, ahead = local.dynamics
        gradient[:-1] += _apply(left, self.multiplier)
        gradient[1:] += _apply(ahead, self.multiplier)
        for index, jacobian in enumerate(local.rows):
            self._push(gradient, index, jacobian, self._net_dual(index))
        gradient[self.program.pinned] = 0.0
        optimality = _largest(gradient / self.program.weight[:, None]) / self.program.scale
        infeasibility = max([_largest(local.defect), *(_largest(e) for e in local.excess)])
        return optimality, infeasibility

    def _net_dual(self, index: int) -> Floats:
        upper, lower = self.sides[2 * index : 2 * index + 2]
        return np.asarray(upper.dual - lower.dual)

    def _push(
        self, force: Floats, index: int, jacobian: tuple[Floats, Floats | None], dual: Floats
    ) -> None:
        """Add the transposed Jacobian of one set of rows times multipliers to a force."""
        node = self.program.rows[index].node
        at_node, at_next = jacobian
        force[node] += _apply(at_node, dual)  # no sample stands in a set of rows twice
        if at_next is not None:
            force[node + 1] += _apply(at_next, dual)

    def _lower_barrier(self, error: float) -> None:
        """Lower the barrier for as long as its problem is solved well enough."""
        while self.sides and self.mu > self.least_mu:
            relative = self.mu / self.unit
            off = max(_largest(s.slack * s.dual - self.mu) for s in self.sides)
            if max(error, off / self.unit) > BARRIER_MARGIN * relative:
                return
            lower = min(BARRIER_FACTOR * relative, relative**BARRIER_POWER)
            self.mu = max(self.least_mu, self.unit * lower)
            self.filter.clear()

    # ------------------------------------------------------------------ one step
    def _advance(self, local: _Local) -> float | None:
        """Take one step; return its length, or None where none is acceptable."""
        convex, bend, across = self._blocks(local)
        size = self.program.scale * float(self.program.weight.max())
        for share, shift in self._convexities():
            hessian = convex + share * bend if bend is not None else convex.copy()
            if shift:
                diagonal = np.arange(self.width)
                hessian[:, diagonal, diagonal] += (
                    shift * self.program.scale * self.program.weight[:, None]
                )
            system = NewtonSystem(hessian, across, local.movable)
            if not system.is_convex(size):
                continue
            try:
                length = self._search(local, system)
            except LinAlgError:
                continue
            if length is not None:
                self.share = max(share, LEAST_SHARE)
                return length
        return None

    def _convexities(self) -> Iterator[tuple[float, float]]:
        """Yield shares of the Hessian's curvature part, and at the end shifts."""
        share = min(1.0, SHARE_RECOVERY * self.share)
        while share >= LEAST_SHARE:
            yield share, 0.0
            share *= SHARE_DECAY
        for shift in SHIFTS:
            yield 0.0, shift

    def _blocks(self, local: _Local) -> tuple[Floats, Floats | None, Floats | None]:
        """Return the convex part of the blocks (k, k), what bends them, and blocks (k, k + 1).

        Slacks and their multipliers are eliminated; the dynamics are not in it.
        """
        hessian = local.expansion.hessian.copy()
        bends = [local.expansion.bend, self.program.defect_curvature(self.x, self.multiplier)]
        across = local.expansion.across
        if across is not None or any(at_next is not None for _, at_next in local.rows):
            across = np.zeros((self.n - 1, self.width, self.width)) if across is None else +across
        for index, (rows, (at_node, at_next)) in enumerate(
            zip(self.program.rows, local.rows, strict=True)
        ):
            upper, lower = self.sides[2 * index : 2 * index + 2]
            stiffness = (upper.stiffness() + lower.stiffness())[:, :, None]
            hessian[rows.node] += transposed(at_node * stiffness) @ at_node
            if at_next is not None:
                hessian[rows.node + 1] += transposed(at_next * stiffness) @ at_next
                assert across is not None
                across[rows.node] += transposed(at_node * stiffness) @ at_next
            bends.append(rows.curvature(self.x, self._net_dual(index)))
        bending = [bend for bend in bends if bend is not None]
        return hessian, sum(bending[1:], start=bending[0]) if bending else None, across

    def _force(self, local: _Local, excess: list[Floats]) -> Floats:
        """Return the gradient of the barrier problem, slacks eliminated, (n, 3 + m)."""
        force = local.expansion.gradient.copy()
        for index, jacobian in enumerate(local.rows):
            pair = range(2 * index, 2 * index + 2)
            push = sum(self.sides[which].push(self.mu, excess[which]) for which in pair)
            self._push(force, index, jacobian, np.asarray(push))
        return force

    def _search(self, local: _Local, system: NewtonSystem) -> float | None:
        """Move along the Newton direction by a backtracking filter line search.

        Where the first step is refused for what the linearisation misses of the
        constraints, it is corrected once to second order.
        """
        step = self._step(local, system, local.defect, local.excess)
        pairs = list(zip(self.sides, step.slacks, strict=True))
        slope = float(np.sum(local.expansion.gradient * step.x)) - self.mu * sum(
            float(np.sum(d / s.slack)) for s, d in pairs
        )
        here = Trial(
            _violation(local.defect, local.excess), self._barrier_cost(local.expansion.cost)
        )
        noise = self.filter.noise(here)
        if here.violation <= FEASIBLE * noise / self.unit and slope > noise:
            return None  # uphill, with no violation to pay for it
        old = [side.slack for side in self.sides]
        length = step.longest
        while length >= SHORTEST_STEP:
            defect, excess, there = self._trial(step, length, old)
            if self.filter.accepts(here, there, length, slope):
                return self._take(step, length)
            if length == step.longest and there.violation >= here.violation > 0.0:
                more_defect = length * local.defect + defect
                more_excess = [length * e + f for e, f in zip(local.excess, excess, strict=True)]
                self._reset_slacks(old)
                corrected = self._step(local, system, more_defect, more_excess)
                there = self._trial(corrected, corrected.longest, old)[2]
                if self.filter.accepts(here, there, corrected.longest, slope):
                    return self._take(corrected, corrected.longest)
            length *= 0.5
        self._reset_slacks(old)
        return None

    def _reset_slacks(self, slacks: list[Floats]) -> None:
        for side, slack in zip(self.sides, slacks, strict=True):
            side.slack = slack

    def _step(
        self, local: _Local, system: NewtonSystem, defect: Floats, excess: list[Floats]
    ) -> _Step:
        """Return the step that removes a defect and an excess to first order."""
        move, multiplier = system.solve(self._force(local, excess), defect)
        slacks = self._slack_moves(local, move, excess)
        duals = [s.dual_move(self.mu, d) for s, d in zip(self.sides, slacks, strict=True)]
        fraction = max(BOUNDARY_FRACTION, 1.0 - self.mu / self.unit)
        pairs = list(zip(self.sides, slacks, duals, strict=True))
        return _Step(
            x=move,
            multiplier=multiplier,
            slacks=slacks,
            duals=duals,
            longest=min((longest_step(s.slack, d, fraction) for s, d, _ in pairs), default=1.0),
            longest_dual=min((longest_step(s.dual, d, fraction) for s, _, d in pairs), default=1.0),
        )

    def _trial(
        self, step: _Step, length: float, old: list[Floats]
    ) -> tuple[Floats, list[Floats], Trial]:
        """Set the slacks of a trial; return its defect, its excess, and what it is worth."""
        x = self.x + length * step.x
        for side, slack, d in zip(self.sides, old, step.slacks, strict=True):
            side.slack = slack + length * d
        defect, excess = self.program.defect(x), self._excess(x)
        there = Trial(_violation(defect, excess), self._barrier_cost(self.program.cost(x)))
        return defect, excess, there

    def _take(self, step: _Step, length: float) -> float:
        self.x = self.x + length * step.x
        self.multiplier = self.multiplier + length * (step.multiplier - self.multiplier)
        for side, d in zip(self.sides, step.duals, strict=True):
            side.dual = side.dual + step.longest_dual * d
        return length

    def _slack_moves(self, local: _Local, move: Floats, excess: list[Floats]) -> list[Floats]:
        """Return the step of every slack that belongs to a step of x."""
        moves: list[Floats] = []
        for index, (rows, (at_node, at_next)) in enumerate(
            zip(self.program.rows, local.rows, strict=True)
        ):
            change = (at_node @ move[rows.node, :, None])[:, :, 0]
            if at_next is not None:
                change = change + (at_next @ move[rows.node + 1, :, None])[:, :, 0]
            for which in (2 * index, 2 * index + 1):
                moves.append(self.sides[which].slack_move(change, excess[which]))
        return moves

    def _barrier_cost(self, cost: float) -> float:
        """Return the cost of the barrier problem at the present slacks."""
        barrier = sum(float(np.sum(np.log(side.slack))) for side in self.sides)
        return float(cost - self.mu * barrier)


def _apply(jacobian: Floats, dual: Floats) -> Floats:
    """Return the transposed Jacobians times vectors."""
    return np.asarray((dual[:, None, :] @ jacobian)[:, 0, :])


def _largest(values: Floats) -> float:
    return float(np.max(np.abs(values), initial=0.0))


def _violation(defect: Floats, excess: list[Floats]) -> float:
    return float(np.sum(np.abs(defect))) + sum(float(np.sum(np.abs(e))) for e in excess)
