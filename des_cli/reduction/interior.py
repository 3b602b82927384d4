"""A primal-dual interior-point method for problems that are banded in time.

The problem is a cost at samples, dynamics between neighbours, and inequalities
that are local in time. Each iteration solves the Newton system of the perturbed
optimality conditions by one banded factorisation, so that its price is linear
in the number of samples. Without inequalities it is Newton's method with a line
search.

The method is that of Waechter and Biegler (Mathematical Programming 106, 2006)
with a line search on an l1 merit function (Nocedal and Wright, Numerical
Optimization, chapter 19). Where the exact Hessian is not convex on the
dynamics, its curvature part is taken in until it is; that is found out by a
banded Cholesky factorisation, where a general sparse code would count the
pivots of an indefinite one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol, TypeAlias

import numpy as np

from des_cli.model.arrays import Flags, Floats
from des_cli.model.solution import Iteration
from des_cli.reduction.banded import is_positive_definite, solve_block_tridiagonal
from des_cli.reduction.constraints import Rows
from des_cli.reduction.transcription import Expansion

# Fraction of the way to the boundary that a step may take, at the least
# (Waechter and Biegler, eq. 8).
BOUNDARY_FRACTION = 0.99
# The barrier parameter falls to min(FACTOR * mu, mu ** POWER) once the barrier
# problem is solved to MARGIN * mu (ibid., eq. 7).
BARRIER_FACTOR, BARRIER_POWER, BARRIER_MARGIN = 0.2, 1.5, 10.0
# Slacks start at least this far inside (rows are scaled to bounds of about 1).
FIRST_SLACK = 1e-2
# Sufficient decrease in the line search (Armijo).
ARMIJO = 1e-4
# The line search gives up below this step.
SHORTEST_STEP = 1e-10
# Where the exact Hessian is not convex on the dynamics, its curvature part is
# taken in by this much less at a time until it is, and in the end left out: what
# remains is a Gauss-Newton Hessian. Between the two it converges in a third of
# the steps that a shifted diagonal needs here (95 against 309 on the Cobra per
# joint at 5 %). The next step begins with SHARE_RECOVERY times what worked.
SHARE_DECAY, LEAST_SHARE, SHARE_RECOVERY = 0.7, 0.05, 2.0
# Shifts of the diagonal, relative to the problem's scale, tried after that.
SHIFTS = (0.0, 1e-6, 1e-4, 1e-2, 1.0, 1e2)
# Errors within which a result that misses the tolerance may still be used.
ACCEPTABLE = 1e-6
# Weight on the squared dynamics, relative to the problem's scale, in the test
# for convexity: large against any negative curvature, small against 1e16.
DYNAMICS_WEIGHT = 1e6

Report: TypeAlias = Callable[[Iteration], None]
Ending: TypeAlias = Literal["converged", "acceptable", "iteration-limit", "diverged"]


class Program(Protocol):
    """What the method needs to know of a problem.

    Attributes
    ----------
    rows : sequence of Rows
    pinned : (n, 3 + m) array of bool
        Unknowns that keep their first value.
    weight : (n,) array
        Quadrature weight of each sample; residuals are judged per unit time.
    scale : float
        Typical size of the running cost's derivative.
    """

    @property
    def rows(self) -> Sequence[Rows]: ...
    @property
    def pinned(self) -> Flags: ...
    @property
    def weight(self) -> Floats: ...
    @property
    def scale(self) -> float: ...

    def cost(self, x: Floats) -> float:
        """Return the cost."""

    def expand(self, x: Floats) -> Expansion:
        """Expand the cost to second order."""

    def defect(self, x: Floats) -> Floats:
        """Return the residual of the dynamics, (n - 1, 3)."""

    def defect_jacobian(self, x: Floats) -> tuple[Floats, Floats]:
        """Return d defect_k / d x_k and / d x_{k+1}, (n - 1, 3, 3 + m) each."""

    def defect_curvature(self, x: Floats, multiplier: Floats) -> Floats | None:
        """Return the second derivatives of multiplier' defect, (n, 3 + m, 3 + m), or None."""


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


@dataclass
class _Side:
    """Slack and multiplier of one side of the bounds of one set of rows."""

    sign: float  # +1 upper bound, -1 lower bound
    slack: Floats
    dual: Floats

    @classmethod
    def at(cls, sign: float, value: Floats, mu: float) -> _Side:
        slack = np.maximum(1.0 - sign * value, FIRST_SLACK)
        return cls(sign, slack, mu / slack)

    def excess(self, value: Floats) -> Floats:
        """Return how far value and slack together miss the bound."""
        return self.sign * value + self.slack - 1.0

    def stiffness(self) -> Floats:
        return self.dual / self.slack

    def push(self, mu: float, excess: Floats) -> Floats:
        """Return the signed multiplier after a step that leaves x alone."""
        return self.sign * (mu + self.dual * excess) / self.slack

    def slack_move(self, change: Floats, excess: Floats) -> Floats:
        """Return the slack's step for a change of the value."""
        return -self.sign * change - excess

    def dual_move(self, mu: float, slack_move: Floats) -> Floats:
        return (mu - self.dual * slack_move) / self.slack - self.dual


@dataclass(frozen=True)
class _Local:
    """What is known at one iterate; recomputed after every step."""

    expansion: Expansion
    defect: Floats
    excess: list[Floats]  # two for each set of rows: upper, lower
    rows: list[tuple[Floats, Floats | None]]  # Jacobians
    dynamics: tuple[Floats, Floats]


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
        self.penalty = 0.0
        self.share = 1.0
        self.sides: list[_Side] = []
        for rows in program.rows:
            value = rows.value(self.x)
            self.sides.append(_Side.at(1.0, value, self.mu))
            self.sides.append(_Side.at(-1.0, value, self.mu))

    def run(self, max_iterations: int, first_number: int, on_iteration: Report | None) -> Outcome:
        log: list[Iteration] = []
        step: float | None = 0.0
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
            step = self._advance(local)
            if step is None:
                status = "diverged"
                break
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
            dynamics=self.program.defect_jacobian(self.x),
        )

    def _excess(self, x: Floats) -> list[Floats]:
        values = [rows.value(x) for rows in self.program.rows for _ in range(2)]
        return [side.excess(value) for side, value in zip(self.sides, values, strict=True)]

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
            self.penalty = 0.0

    # ------------------------------------------------------------------ one step
    def _advance(self, local: _Local) -> float | None:
        """Take one step; return its length, or None where none is acceptable."""
        convex, bend, across, force = self._newton(local)
        for share, shift in self._convexities():
            direction = self._direction(local, convex + share * bend, across, force, shift)
            if direction is not None:
                length = self._search(local, *direction)
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

    def _newton(self, local: _Local) -> tuple[Floats, Floats, Floats, Floats]:
        """Return the Newton system without the dynamics.

        Slacks and their multipliers are eliminated. First the convex part of the
        blocks (k, k), then what bends them, the blocks (k, k + 1), and the force.
        """
        hessian = local.expansion.hessian.copy()
        bends = [local.expansion.bend, self.program.defect_curvature(self.x, self.multiplier)]
        across = np.zeros((self.n - 1, self.width, self.width))
        if local.expansion.across is not None:
            across += local.expansion.across
        force = local.expansion.gradient.copy()
        for index, (rows, (at_node, at_next)) in enumerate(
            zip(self.program.rows, local.rows, strict=True)
        ):
            pair = self.sides[2 * index : 2 * index + 2]
            stiffness = (pair[0].stiffness() + pair[1].stiffness())[:, :, None]
            push = sum(
                side.push(self.mu, local.excess[2 * index + which])
                for which, side in enumerate(pair)
            )
            self._push(force, index, (at_node, at_next), np.asarray(push))
            hessian[rows.node] += _transposed(at_node * stiffness) @ at_node
            if at_next is not None:
                hessian[rows.node + 1] += _transposed(at_next * stiffness) @ at_next
                across[rows.node] += _transposed(at_node * stiffness) @ at_next
            bends.append(rows.curvature(self.x, self._net_dual(index)))
        bend = sum((b for b in bends if b is not None), start=np.zeros_like(hessian))
        return hessian, bend, across, force

    def _direction(
        self, local: _Local, hessian: Floats, across: Floats, force: Floats, shift: float
    ) -> tuple[Floats, Floats] | None:
        """Solve the Newton system for the step in x and the new multipliers.

        Returns None where the system is not convex on the dynamics.
        """
        n, width, program = self.n, self.width, self.program
        free = ~program.pinned
        left, ahead = (
            block * mask[:, None, :]
            for block, mask in zip(local.dynamics, (free[:-1], free[1:]), strict=True)
        )
        here = hessian * free[:, :, None] * free[:, None, :]
        next_ = across * free[:-1, :, None] * free[1:, None, :]
        ends = np.arange(width)
        here[:, ends, ends] += program.pinned + shift * program.scale * program.weight[:, None]
        weight = DYNAMICS_WEIGHT * program.scale * float(program.weight.max())
        squared = here.copy()
        squared[:-1] += weight * _transposed(left) @ left
        squared[1:] += weight * _transposed(ahead) @ ahead
        if not is_positive_definite(squared, next_ + weight * _transposed(left) @ ahead):
            return None
        block = width + 3
        diagonal = np.zeros((n, block, block))
        upper, lower = np.zeros((n - 1, block, block)), np.zeros((n - 1, block, block))
        diagonal[:, :width, :width] = here
        diagonal[:-1, width:, :width], diagonal[:-1, :width, width:] = left, _transposed(left)
        diagonal[-1, width:, width:] = np.eye(3)  # the last sample begins no interval
        upper[:, :width, :width], lower[:, :width, :width] = next_, _transposed(next_)
        upper[:, width:, :width], lower[:, :width, width:] = ahead, _transposed(ahead)
        right = np.zeros((n, block, 1))
        right[:, :width, 0] = -force * free
        right[:-1, width:, 0] = -local.defect
        solution = solve_block_tridiagonal(diagonal, upper, lower, right)
        if solution is None:
            return None
        return solution[:, :width, 0], solution[:-1, width:, 0]

    def _search(self, local: _Local, move: Floats, multiplier: Floats) -> float | None:
        """Move along a direction by a backtracking search on an l1 merit function."""
        slack_moves = self._slack_moves(local, move)
        pairs = list(zip(self.sides, slack_moves, strict=True))
        fraction = max(BOUNDARY_FRACTION, 1.0 - self.mu / self.unit)
        length = min((_boundary(s.slack, d, fraction) for s, d in pairs), default=1.0)
        dual_moves = [side.dual_move(self.mu, d) for side, d in pairs]
        duals = [s.dual + d for s, d in zip(self.sides, dual_moves, strict=True)]
        self.penalty = max(self.penalty, 1.1 * max(map(_largest, [multiplier, *duals])))
        slope = (
            float(np.sum(local.expansion.gradient * move))
            - self.mu * sum(float(np.sum(d / s.slack)) for s, d in pairs)
            - self.penalty * _violation(local.defect, local.excess)
        )
        # below this the merit function's own rounding decides
        noise = 1e-13 * (abs(local.expansion.cost) + self.unit + self.penalty)
        if slope > noise:
            return None
        start = self._merit(local.expansion.cost, local.defect, local.excess)
        slacks = [side.slack for side in self.sides]
        while length >= SHORTEST_STEP:
            x = self.x + length * move
            for side, slack, d in zip(self.sides, slacks, slack_moves, strict=True):
                side.slack = slack + length * d
            merit = self._merit(self.program.cost(x), self.program.defect(x), self._excess(x))
            if merit <= start + ARMIJO * length * slope + noise:
                self.x = x
                self.multiplier = self.multiplier + length * (multiplier - self.multiplier)
                moves = list(zip(self.sides, dual_moves, strict=True))
                along = min((_boundary(s.dual, d, fraction) for s, d in moves), default=1.0)
                for side, d in moves:
                    side.dual = side.dual + along * d
                return length
            length *= 0.5
        for side, slack in zip(self.sides, slacks, strict=True):
            side.slack = slack
        return None

    def _slack_moves(self, local: _Local, move: Floats) -> list[Floats]:
        """Return the step of every slack that belongs to a step of x."""
        moves: list[Floats] = []
        for index, (rows, (at_node, at_next)) in enumerate(
            zip(self.program.rows, local.rows, strict=True)
        ):
            change = (at_node @ move[rows.node, :, None])[:, :, 0]
            if at_next is not None:
                change = change + (at_next @ move[rows.node + 1, :, None])[:, :, 0]
            for which in (2 * index, 2 * index + 1):
                moves.append(self.sides[which].slack_move(change, local.excess[which]))
        return moves

    def _merit(self, cost: float, defect: Floats, excess: list[Floats]) -> float:
        barrier = sum(float(np.sum(np.log(side.slack))) for side in self.sides)
        merit = cost - self.mu * barrier + self.penalty * _violation(defect, excess)
        return merit if np.isfinite(merit) else np.inf


def _transposed(blocks: Floats) -> Floats:
    return np.swapaxes(blocks, 1, 2)


def _apply(jacobian: Floats, dual: Floats) -> Floats:
    """Return the transposed Jacobians times vectors."""
    return np.asarray((dual[:, None, :] @ jacobian)[:, 0, :])


def _boundary(values: Floats, moves: Floats, fraction: float) -> float:
    """Return the longest step, at most one, that keeps values positive."""
    shrinking = moves < 0.0
    if not np.any(shrinking):
        return 1.0
    return float(min(1.0, fraction * np.min(-values[shrinking] / moves[shrinking])))


def _largest(values: Floats) -> float:
    return float(np.max(np.abs(values), initial=0.0))


def _violation(defect: Floats, excess: list[Floats]) -> float:
    return float(np.sum(np.abs(defect))) + sum(float(np.sum(np.abs(e))) for e in excess)
