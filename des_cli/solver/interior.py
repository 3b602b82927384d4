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
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np
from scipy.linalg import LinAlgError

from des_cli.model.arrays import Floats
from des_cli.model.solution import Iteration
from des_cli.solver.filter import Filter, Trial
from des_cli.solver.newton_system import Border, Dynamics, NewtonSystem, transposed
from des_cli.solver.program import Expansion, Program
from des_cli.solver.slacks import Side, longest_step

BOUNDARY_FRACTION = 0.99
"""Fraction of the way to the boundary that a step may take, at the least (Waechter and
Biegler, eq. 8): 1 - mu, where that is more, lets the last steps be full ones."""

BARRIER_FACTOR, BARRIER_POWER, BARRIER_MARGIN = 0.2, 1.5, 10.0
"""The barrier parameter falls to min(FACTOR * mu, mu ** POWER) once the barrier problem is
solved to MARGIN * mu (ibid., eq. 7): superlinearly at the end, and not before it is centred."""

FEASIBLE = 1e-3
"""Violation, relative to the cost's rounding, that counts as none."""

SHORTEST_STEP = 1e-10
"""Length below which the line search gives up: what it would change is rounding."""

SHARE_DECAY, LEAST_SHARE, SHARE_RECOVERY = 0.7, 0.05, 2.0
"""Where the exact Hessian is not convex on the dynamics, its curvature part is taken in by
this much less at a time until it is, and in the end left out: what remains is a Gauss-Newton
Hessian. Between the two it converged in a third of the steps that a shifted diagonal needed
(95 against 309 on the Cobra per joint, BB3, 500 intervals, at the first price of a 5 %
budget). The next step begins with SHARE_RECOVERY times what worked."""

SHIFTS = (0.0, 1e-6, 1e-4, 1e-2, 1.0, 1e2)
"""Shifts of the diagonal, relative to the problem's scale, tried after that, from none to a
hundred times that scale, where a step is nearly one of steepest descent."""

BUDGET_WEIGHT = 0.1
"""A budget's barrier weighs as much as this share of all the local inequalities together:
with a weight of one the first steps would spend it to the last, and the rest creep along its
curved boundary."""

LEAST_PRICE = 1e-8
"""Multiplier that a budget starts with at the least: inside, multipliers are positive."""

ACCEPTABLE = 1e-6
"""Errors within which a result that misses the tolerance may still be used: 1e-6 rad of an
angle mean nothing to a machine."""

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
        Violation of the first-order conditions, scaled and per unit time, and of the
        dynamics [rad] and the scaled inequalities.
    log : tuple of Iteration
    prices : (s,) array
        Multipliers of the budgets.
    """

    status: Ending
    x: Floats
    multiplier: Floats
    cost: float
    optimality: float
    infeasibility: float
    log: tuple[Iteration, ...]
    prices: Floats = field(default_factory=lambda: np.zeros(0))

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
    prices: Floats | None = None,
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
    prices : (s,) array, optional
        What the multipliers of the budgets are near to.
    first_number : int
        Number of the first line of the log.
    on_iteration : callable, optional
        Called with each line of the log.
    """
    method = _Method(program, x, tolerance, barrier, prices)
    return method.run(max_iterations, first_number, on_iteration)


@dataclass(frozen=True)
class _Local:
    """What is known at one iterate; recomputed after every step."""

    expansion: Expansion
    defect: Floats
    excess: list[Floats]  # two for each set of rows, upper and lower; one for each budget
    rows: list[tuple[Floats, ...]]  # Jacobians
    budgets: list[Expansion]
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

    def __init__(
        self,
        program: Program,
        x: Floats,
        tolerance: float,
        barrier: float,
        prices: Floats | None,
    ) -> None:
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
        self.sides: list[Side] = []  # of the rows, and then of the budgets
        for rows in program.rows:
            value = rows.value(self.x)
            self.sides.append(Side.at(1.0, value, self.mu))
            self.sides.append(Side.at(-1.0, value, self.mu))
        weight = max(1.0, BUDGET_WEIGHT * sum(side.slack.size for side in self.sides))
        self.spending: list[Side] = []
        for index, measure in enumerate(program.budgets):
            value = np.array([measure.value(self.x)])
            self.spending.append(Side.at(1.0, value, self.mu, weight))
            if prices is not None:
                self.spending[-1].dual = np.maximum(prices[index : index + 1], LEAST_PRICE)
        self.sides += self.spending
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
            gap = max((_largest(side.product) for side in self.sides), default=0.0)
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
        prices = np.array([float(side.dual[0]) for side in self.spending])
        cost, lines = log[-1].cost, tuple(log)
        return Outcome(
            status, self.x, self.multiplier, cost, optimality, infeasibility, lines, prices
        )

    # ------------------------------------------------------------------ at an iterate
    def _look(self) -> _Local:
        return _Local(
            expansion=self.program.expand(self.x),
            defect=self.program.defect(self.x),
            excess=self._excess(self.x),
            rows=[rows.jacobian(self.x) for rows in self.program.rows],
            budgets=[measure.expand(self.x) for measure in self.program.budgets],
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
        for side, measure in zip(self.spending, self.program.budgets, strict=True):
            excess.append(side.excess(np.array([measure.value(x)])))
        return excess

    def _errors(self, local: _Local) -> tuple[float, float]:
        """Return the violation of the first-order conditions, and of the constraints."""
        gradient = local.expansion.gradient.copy()
        left, ahead = local.dynamics
        gradient[:-1] += _apply(left, self.multiplier)
        gradient[1:] += _apply(ahead, self.multiplier)
        for index, jacobian in enumerate(local.rows):
            self._add_adjoint(gradient, index, jacobian, self._net_dual(index))
        for side, budget in zip(self.spending, local.budgets, strict=True):
            gradient += float(side.dual[0]) * budget.gradient
        gradient[self.program.pinned] = 0.0
        optimality = _largest(gradient / self.program.weight[:, None]) / self.program.scale
        infeasibility = max([_largest(local.defect), *(_largest(e) for e in local.excess)])
        return optimality, infeasibility

    def _net_dual(self, index: int) -> Floats:
        upper, lower = self.sides[2 * index : 2 * index + 2]
        return np.asarray(upper.dual - lower.dual)

    def _add_adjoint(
        self, force: Floats, index: int, jacobian: tuple[Floats, ...], dual: Floats
    ) -> None:
        """Add the transposed Jacobian of one set of rows times multipliers to a force."""
        node = self.program.rows[index].node
        for ahead, block in enumerate(jacobian):
            force[node + ahead] += _apply(block, dual)  # no sample stands in a set of rows twice

    def _lower_barrier(self, error: float) -> None:
        """Lower the barrier for as long as its problem is solved well enough."""
        while self.sides and self.mu > self.least_mu:
            relative = self.mu / self.unit
            off = max(_largest(side.product - self.mu) for side in self.sides)
            if max(error, off / self.unit) > BARRIER_MARGIN * relative:
                return
            lower = min(BARRIER_FACTOR * relative, relative**BARRIER_POWER)
            self.mu = max(self.least_mu, self.unit * lower)
            self.filter.clear()

    # ------------------------------------------------------------------ one step
    def _advance(self, local: _Local) -> float | None:
        """Take one step; return its length, or None where none is acceptable."""
        convex, curvature, across = self._blocks(local)
        border = self._border(local)
        size = self.program.scale * float(self.program.weight.max())
        for share, shift in self._convexities():
            hessian = convex + share * curvature if curvature is not None else convex.copy()
            if shift:
                diagonal = np.arange(self.width)
                hessian[:, diagonal, diagonal] += (
                    shift * self.program.scale * self.program.weight[:, None]
                )
            blocks = [each.copy() for each in across]
            system = NewtonSystem(hessian, blocks, local.movable, border)
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

    def _blocks(self, local: _Local) -> tuple[Floats, Floats | None, list[Floats]]:
        """Return the convex part of the blocks (k, k), their curvature, and blocks off them.

        Slacks and their multipliers are eliminated; the dynamics are not in it, nor
        what couples all samples.
        """
        whole = local.expansion
        for side, budget in zip(self.spending, local.budgets, strict=True):
            whole = whole.plus(float(side.dual[0]), budget)
        hessian = whole.hessian.copy()
        parts = [whole.curvature, self.program.defect_curvature(self.x, self.multiplier)]
        across = [] if whole.across is None else [whole.across.copy()]
        for index, (rows, jacobian) in enumerate(zip(self.program.rows, local.rows, strict=True)):
            upper, lower = self.sides[2 * index : 2 * index + 2]
            stiffness = (upper.stiffness() + lower.stiffness())[:, :, None]
            heavy = [transposed(block * stiffness) for block in jacobian]
            while len(across) < len(jacobian) - 1:
                across.append(np.zeros((self.n - 1 - len(across), self.width, self.width)))
            for i, one in enumerate(heavy):
                hessian[rows.node + i] += one @ jacobian[i]
                for j in range(i + 1, len(jacobian)):
                    across[j - i - 1][rows.node + i] += one @ jacobian[j]
            parts.append(rows.curvature(self.x, self._net_dual(index)))
        curvatures = [part for part in parts if part is not None]
        return hessian, sum(curvatures[1:], start=curvatures[0]) if curvatures else None, across

    def _border(self, local: _Local) -> Border | None:
        """Return what the budgets' eliminated slacks add to the Hessian."""
        if not self.spending:
            return None
        vectors = np.stack([budget.gradient for budget in local.budgets], axis=2)
        return Border(vectors, np.array([float(s.stiffness()[0]) for s in self.spending]))

    def _force(self, local: _Local, excess: list[Floats]) -> Floats:
        """Return the gradient of the barrier problem, slacks eliminated, (n, 3 + m)."""
        force = local.expansion.gradient.copy()
        for index, jacobian in enumerate(local.rows):
            pair = range(2 * index, 2 * index + 2)
            multiplier = sum(
                self.sides[which].barrier_multiplier(self.mu, excess[which]) for which in pair
            )
            self._add_adjoint(force, index, jacobian, np.asarray(multiplier))
        first = 2 * len(self.program.rows)
        for which, budget in enumerate(local.budgets, start=first):
            force += (
                float(self.sides[which].barrier_multiplier(self.mu, excess[which])[0])
                * budget.gradient
            )
        return force

    def _search(self, local: _Local, system: NewtonSystem) -> float | None:
        """Move along the Newton direction by a backtracking filter line search.

        Where the first step is refused for what the linearisation misses of the
        constraints, it is corrected once to second order.
        """
        step = self._step(local, system, local.defect, local.excess)
        pairs = list(zip(self.sides, step.slacks, strict=True))
        slope = float(np.sum(local.expansion.gradient * step.x)) + self.mu * sum(
            side.barrier_slope(move) for side, move in pairs
        )
        current = Trial(
            _violation(local.defect, local.excess), self._barrier_cost(local.expansion.cost)
        )
        noise = self.filter.noise(current)
        if current.violation <= FEASIBLE * noise / self.unit and slope > noise:
            return None  # uphill, with no violation to pay for it
        old = [side.slack for side in self.sides]
        length = step.longest
        while length >= SHORTEST_STEP:
            defect, excess, trial = self._trial(step, length, old)
            if self.filter.accepts(current, trial, length, slope):
                return self._take(step, length)
            if length == step.longest and trial.violation >= current.violation > 0.0:
                more_defect = length * local.defect + defect
                more_excess = [length * e + f for e, f in zip(local.excess, excess, strict=True)]
                self._reset_slacks(old)
                corrected = self._step(local, system, more_defect, more_excess)
                trial = self._trial(corrected, corrected.longest, old)[2]
                if self.filter.accepts(current, trial, corrected.longest, slope):
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
        trial = Trial(_violation(defect, excess), self._barrier_cost(self.program.cost(x)))
        return defect, excess, trial

    def _take(self, step: _Step, length: float) -> float:
        self.x = self.x + length * step.x
        self.multiplier = self.multiplier + length * (step.multiplier - self.multiplier)
        for side, d in zip(self.sides, step.duals, strict=True):
            side.dual = side.dual + step.longest_dual * d
        return length

    def _slack_moves(self, local: _Local, move: Floats, excess: list[Floats]) -> list[Floats]:
        """Return the step of every slack that belongs to a step of x."""
        moves: list[Floats] = []
        for index, (rows, jacobian) in enumerate(zip(self.program.rows, local.rows, strict=True)):
            change = sum(
                (block @ move[rows.node + ahead, :, None])[:, :, 0]
                for ahead, block in enumerate(jacobian)
            )
            for which in (2 * index, 2 * index + 1):
                moves.append(self.sides[which].slack_move(np.asarray(change), excess[which]))
        for which, budget in enumerate(local.budgets, start=len(moves)):
            change = np.array([np.sum(budget.gradient * move)])
            moves.append(self.sides[which].slack_move(change, excess[which]))
        return moves

    def _barrier_cost(self, cost: float) -> float:
        """Return the cost of the barrier problem at the present slacks."""
        return float(cost + self.mu * sum(side.barrier() for side in self.sides))


def _apply(jacobian: Floats, dual: Floats) -> Floats:
    """Return the transposed Jacobians times vectors."""
    return np.asarray((dual[:, None, :] @ jacobian)[:, 0, :])


def _largest(values: Floats) -> float:
    return float(np.max(np.abs(values), initial=0.0))


def _violation(defect: Floats, excess: list[Floats]) -> float:
    return float(np.sum(np.abs(defect))) + sum(float(np.sum(np.abs(e))) for e in excess)
