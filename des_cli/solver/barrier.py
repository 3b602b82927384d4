"""A feasible primal-dual interior point for few integral budgets and many local limits.

Minimise a cost over x, subject to

    |v_i(x)| <= b_i     linear, local, many          (limits)
    h_k(x)  <= 1        nonlinear, local, many       (bounds at points)
    g_j(x)  <= 1        nonlinear, integral, few     (budgets)

It starts strictly inside and stays there: every iterate is a point that may be used.
Local inequalities add to the banded Hessian without widening it. A budget couples
everything with everything, but only through its gradient: its barrier is a row that
borders the band, taken in by the Sherman-Morrison-Woodbury formula round the one
factorisation. So several budgets cost hardly more than none.

The method is the primal-dual barrier method of Fiacco and McCormick with Newton steps
(Nocedal and Wright, Numerical Optimization, chapter 19), and these particulars:

- A budget's barrier has the weight of many rows (``BUDGET_WEIGHT``). One row among ten
  thousand would let the budget collapse first, and the path would follow its boundary.
- The boundary of a budget, or of a local bound, is curved. Where a full step would overrun
  it, the step is corrected to second order, along H^-1 grad g for a budget, so that it
  meets its linear prediction. Without that, a slack of 1e-8 halves every step.
- The Hessian is exact where that is positive definite; else its curvature part, which
  alone can be indefinite, counts by a share that is halved until it is.
- The fraction to the boundary does not follow the barrier, and a multiplier stays within
  a factor of barrier over slack, so that no single slack collapses early.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, Literal, TypeAlias

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.solver.feasible_program import E, Expansion, Program, System, Values

STILL, ROUNDED = 12, 10.0
"""Full steps that leave the cost as it is, from which a search has come to rest, and by how
much of the tolerance its first-order conditions may then be off: multipliers of limits that
hold almost everywhere cancel, and what is left of them is rounding."""

ROUNDING = 1e-12
"""Relative change of a cost that is the rounding of a sum over thousands of points."""

BoundaryStatus: TypeAlias = Literal["converged", "iteration-limit", "stalled"]

BUDGET_WEIGHT = 0.1
"""Weight of a budget's barrier, in rows per row of the local inequalities."""

FRACTION = 0.995
"""Of the way to the nearest boundary that a step may take: the usual value (Nocedal and
Wright, section 19.2)."""

SPREAD = 1e2
"""A multiplier stays within this factor of barrier over slack, as Waechter and Biegler keep it
(eq. 16), but closer: 1e10 there guards convergence, and a hundred also the centring."""

ARMIJO = 1e-4
"""Share of the predicted decrease that a step must bring, as is usual (Nocedal and Wright,
section 3.1)."""

LEAST_SLACK = 1e-3
"""Share of a nonlinear slack that a step must leave: of what its linear prediction leaves at
the least, 1 - ``FRACTION``, a fifth, for what the prediction misses."""

OVERSHOOT = 0.1
"""A budget or a local bound that misses its linear prediction by this share of its slack is
corrected."""

SHORTEST_CORRECTED = 0.05
"""Shortest first step that is worth a second-order correction."""

CONTRACTION, SUPERLINEAR = 0.3, 1.5
"""The barrier falls to this share, or to this power of the gap, once its problem is solved
to within ``CENTRED`` times the gap: by the rule of Waechter and Biegler (eq. 7), who take
0.2 and 1.5."""

CENTRED = 3.0
"""Error of a barrier's problem, over its gap, at which it counts as solved: less than the 10 of
Waechter and Biegler (kappa_epsilon), for without a filter each iterate is to stay central."""

HALVINGS = 25
"""Of a step, before the search gives up: 2^-25 of it is 3e-8, and moves nothing."""

SHARE_HALVINGS = 5
"""Of the share of the curvature, before it is left out altogether: a step with a thirtieth of
it is as good as one without. Halves, so that shares are exact in binary."""

SHIFTS = (1e-12, 1e-10, 1e-8, 1e-6)
"""Relative shifts of the diagonal, tried where even the convex part is singular to rounding."""


@dataclass(frozen=True, slots=True)
class Options:
    """How far to go.

    Parameters
    ----------
    gap : float
        Complementarity at the end, in the unit of the cost.
    tolerance : float
        On the first-order conditions, relative to the gradients at the start.
    start_gap : float
        Complementarity that the first barrier aims at.
    halfway : float
        Complementarity of an iterate that is kept.
    max_iterations : int
    stop_early : callable, optional
        Told the budgets' values at each iterate; ends the method where it returns True.
    """

    gap: float = 1e-7
    tolerance: float = 1e-7
    start_gap: float = 3.0
    halfway: float = 1e-2
    max_iterations: int = 200
    stop_early: Callable[[Floats], bool] | None = None


@dataclass(frozen=True, slots=True)
class Step:
    """One line of the method's log."""

    number: int
    cost: float
    gap: float
    optimality: float
    length: float


@dataclass(frozen=True)
class Outcome:
    """Where the method ended.

    Parameters
    ----------
    status : {"converged", "iteration-limit", "stalled"}
        Of a stalled search the point is as usable as any other, and not optimal.
    x : (N,) array
    values : Values
    budget_multiplier : (j,) array
        What a unit of each budget is worth.
    gap, optimality : float
        Complementarity, in the unit of the cost, and violation of the first-order conditions,
        relative to the gradients at the start.
    steps : tuple of Step
    halfway : (N,) array
        The first iterate whose complementarity was at most ``Options.halfway``: near the
        optimum, and with room to all bounds, to begin from where these change a little.
    """

    status: BoundaryStatus
    x: Floats
    values: Values
    budget_multiplier: Floats
    gap: float
    optimality: float
    steps: tuple[Step, ...]
    halfway: Floats


def minimise(
    program: Program[E],
    start: Floats,
    options: Options | None = None,
    on_step: Callable[[Step], None] | None = None,
) -> Outcome:
    """Minimise from a point strictly inside.

    Parameters
    ----------
    program : Program
    start : (N,) array
    options : Options, optional
    on_step : callable, optional
        Called with each line of the log.

    Raises
    ------
    ValueError
        If the start is not strictly inside.
    """
    return _Search(program, start, options or Options(), on_step).run()


class _Search(Generic[E]):
    """The state of a minimisation."""

    def __init__(
        self,
        program: Program[E],
        start: Floats,
        options: Options,
        on_step: Callable[[Step], None] | None,
    ) -> None:
        self.program, self.options, self.on_step = program, options, on_step
        self.x = np.array(start, dtype=np.float64)
        self.at = program.values(self.x)
        rows = program.linear(self.x)
        self.m = len(rows)
        self.slack = np.concatenate(
            [program.bounds - rows, program.bounds + rows, 1.0 - self.at.local]
        )
        self.budget_slack = 1.0 - self.at.budgets
        if np.min(self.slack, initial=1.0) <= 0.0 or np.min(self.budget_slack, initial=1.0) <= 0.0:
            raise ValueError("the start is not strictly inside")
        count = len(self.slack)
        self.weight = max(1.0, BUDGET_WEIGHT * count)
        self.total = count + self.weight * len(self.budget_slack)
        self.mu = options.start_gap / max(self.total, 1.0)
        self.dual = self.mu / self.slack
        self.budget_dual = self.mu * self.weight / self.budget_slack
        self.share = 1.0
        self.unit = 0.0
        self.steps: list[Step] = []
        self.length = 0.0

    def _at_rounding(self, gap: float, residual: float) -> bool:
        """Whether nothing moves any more: rounding is all that the conditions are off by."""
        options, last = self.options, self.steps[-STILL:]
        costs = [step.cost for step in last]
        return (
            len(last) == STILL
            and gap <= 1.0001 * options.gap
            and residual <= ROUNDED * options.tolerance
            and min(step.length for step in last) == 1.0
            and max(costs) - min(costs) <= ROUNDING * max(abs(costs[-1]), 1.0)
        )

    def run(self) -> Outcome:
        options = self.options
        status: BoundaryStatus = "iteration-limit"
        halfway: Floats | None = None
        for number in range(options.max_iterations + 1):
            expansion, system = self._linearise()
            residual = self._residual(expansion)
            gap = float(self.slack @ self.dual + self.budget_slack @ self.budget_dual)
            line = Step(number, expansion.cost, gap, residual, self.length)
            self.steps.append(line)
            if self.on_step is not None:
                self.on_step(line)
            if halfway is None and gap <= options.halfway:
                halfway = self.x
            if gap <= 1.0001 * options.gap and residual <= options.tolerance:
                status = "converged"
                break
            if options.stop_early is not None and options.stop_early(self.at.budgets):
                status = "converged"
                break
            if self._at_rounding(gap, residual):
                status = "converged"
                break
            if number == options.max_iterations:
                break
            if system is None:
                status = "stalled"
                break
            self._lower_barrier(residual)
            if not self._advance(expansion, system):
                status = "stalled"
                break
        last = self.steps[-1]
        return Outcome(
            status=status,
            x=self.x,
            values=self.at,
            budget_multiplier=self.budget_dual,
            gap=last.gap,
            optimality=last.optimality,
            steps=tuple(self.steps),
            halfway=self.x if halfway is None else halfway,
        )

    def _linearise(self) -> tuple[E, System | None]:
        """Expand at the iterate and factorise with the largest share that is convex."""
        m = self.m
        stiffness = self.dual / self.slack
        of_rows = stiffness[:m] + stiffness[m : 2 * m]
        expansion = self.program.expand(
            self.x, self.budget_dual, self.dual[2 * m :], stiffness[2 * m :]
        )
        share = self.share
        halvings = 0
        while True:
            system = self.program.system(expansion, share, of_rows, 0.0)
            if system is not None or share == 0.0:
                break
            halvings += 1
            share = 0.0 if halvings >= SHARE_HALVINGS else 0.5 * share
        for shift in SHIFTS:
            if system is not None:
                break
            system = self.program.system(expansion, share, of_rows, shift)
        self.share = min(1.0, 2.0 * share) if share > 0.0 else 0.5**SHARE_HALVINGS
        return expansion, system

    def _residual(self, expansion: E) -> float:
        """Return the scaled violation of the first-order conditions."""
        program, m = self.program, self.m
        of_cost = program.reduce(expansion.gradient)
        if not self.unit:
            sizes = [np.max(np.abs(of_cost), initial=0.0)]
            sizes += [
                np.max(np.abs(program.reduce(column)), initial=0.0)
                for column in expansion.budget_gradients.T
            ]
            self.unit = max(float(max(sizes)), 1e-300)
        force = expansion.gradient + expansion.budget_gradients @ self.budget_dual
        force = force + program.linear_adjoint(self.dual[:m] - self.dual[m : 2 * m])
        force = force + expansion.local_adjoint(self.dual[2 * m :])
        return float(np.max(np.abs(program.reduce(force)), initial=0.0)) / self.unit

    def _lower_barrier(self, residual: float) -> None:
        """Lower the barrier as far as its problem counts as solved."""
        total, least = self.total, 0.5 * self.options.gap / max(self.total, 1.0)
        off = float(np.max(np.abs(self.slack * self.dual - self.mu), initial=0.0)) * total
        error = max(residual, off)
        while error < CENTRED * self.mu * total and self.mu > least:
            gap = self.mu * total
            self.mu = max(min(CONTRACTION * gap, gap**SUPERLINEAR) / total, least)

    def _force(self, expansion: E) -> Floats:
        """Return the gradient of the barrier problem, (N,)."""
        m, inverse = self.m, self.mu / self.slack
        force = expansion.gradient + self.program.linear_adjoint(inverse[:m] - inverse[m : 2 * m])
        force = force + expansion.local_adjoint(inverse[2 * m :])
        return np.asarray(
            force + expansion.budget_gradients @ (self.mu * self.weight / self.budget_slack)
        )

    def _advance(self, expansion: E, system: System) -> bool:
        """Take one step; return whether one was found."""
        border = _Border(system, expansion.budget_gradients, self.budget_slack / self.budget_dual)
        force = self._force(expansion)
        step = border.solve(-force)
        slope = float(force @ step)
        if not slope < 0.0:
            return False
        change = self._slack_change(expansion, step)
        budget_change = -(step @ expansion.budget_gradients)
        dual_step = self.mu / self.slack - self.dual - self.dual / self.slack * change
        budget_dual_step = (
            self.mu * self.weight / self.budget_slack
            - self.budget_dual
            - self.budget_dual / self.budget_slack * budget_change
        )
        longest = _longest(self.slack, change)
        dual_length = min(
            _longest(self.dual, dual_step), _longest(self.budget_dual, budget_dual_step)
        )
        path = _Path(expansion, border, step, budget_change)
        if not self._search(path, slope, longest):
            return False
        self.dual = self.dual + dual_length * dual_step
        self.budget_dual = self.budget_dual + dual_length * budget_dual_step
        central = self.mu / self.slack
        self.dual = np.clip(self.dual, central / SPREAD, central * SPREAD)
        central = self.mu * self.weight / self.budget_slack
        self.budget_dual = np.clip(self.budget_dual, central / SPREAD, central * SPREAD)
        return True

    def _slack_change(self, expansion: E, step: Floats) -> Floats:
        rows = self.program.linear_change(step)
        return np.concatenate([-rows, rows, -expansion.local_change(step)])

    def _merit(self, cost: float, slack: Floats, budget_slack: Floats) -> float:
        """Return the barrier problem's cost."""
        barrier = float(np.sum(np.log(slack)) + self.weight * np.sum(np.log(budget_slack)))
        return cost - self.mu * barrier

    def _search(self, path: _Path, slope: float, longest: float) -> bool:
        """Search along a step, corrected where it would overrun a curved boundary."""
        program, m = self.program, self.m
        merit = self._merit(self.at.cost, self.slack, self.budget_slack)
        noise = 1e-13 * abs(merit) + 1e-14
        length = longest
        correction: Floats | None = None
        for trial in range(HALVINGS):
            move = length * path.step
            if correction is not None:
                move = move + length**2 * correction
            x = self.x + move
            at = program.values(x)
            if trial == 0 and length > SHORTEST_CORRECTED:
                correction = self._correction(path, length, at)
                if correction is not None:
                    move = move + length**2 * correction
                    x = self.x + move
                    at = program.values(x)
            budget_slack = 1.0 - at.budgets
            rows = program.linear_change(move)
            slack = np.concatenate(
                [self.slack[:m] - rows, self.slack[m : 2 * m] + rows, 1.0 - at.local]
            )
            inside = (
                bool(np.all(budget_slack > LEAST_SLACK * self.budget_slack))
                and bool(np.all(slack[: 2 * m] > 0.0))
                and bool(np.all(slack[2 * m :] > LEAST_SLACK * self.slack[2 * m :]))
            )
            if inside:
                reached = self._merit(at.cost, slack, budget_slack)
                if reached <= merit + ARMIJO * length * slope + noise:
                    self.x, self.at = x, at
                    self.slack, self.budget_slack = slack, budget_slack
                    self.length = length
                    return True
            length *= 0.5
            if trial == 1:
                correction = None  # a shorter step follows the boundary by itself
        return False

    def _correction(self, path: _Path, length: float, at: Values) -> Floats | None:
        """Return the second-order correction of a step that misses its linear predictions.

        Parameters
        ----------
        path : _Path
        length : float
            Of the step, 0 to 1.
        at : Values
            Where it leads.

        Returns
        -------
        (N,) array or None
            What the square of a length is times; None where the predictions hold.
        """
        local_slack = self.slack[2 * self.m :]
        predicted = self.at.budgets - length * path.budget_change
        excess = np.maximum(at.budgets - predicted, 0.0)
        local = np.maximum(at.local - (self.at.local + length * path.local_change), 0.0)
        correction: Floats | None = None
        if np.any(local > OVERSHOOT * local_slack):
            force = path.expansion.local_adjoint(self.dual[2 * self.m :] / local_slack * local)
            correction = -path.border.solve(force) / length**2
        if np.any(excess > OVERSHOOT * self.budget_slack):
            of_budgets = path.border.correction(excess) / length**2
            correction = of_budgets if correction is None else correction + of_budgets
        return correction


class _Path:
    """A step, and what the linearised functions say along it."""

    def __init__(
        self, expansion: Expansion, border: _Border, step: Floats, budget_change: Floats
    ) -> None:
        self.expansion, self.border, self.step = expansion, border, step
        self.budget_change = budget_change  # of the budgets' slacks
        self.local_change = expansion.local_change(step)


class _Border:
    """A banded system with a few rank-one terms, by Sherman, Morrison and Woodbury.

    Parameters
    ----------
    system : System
    gradients : (N, j) array
    compliance : (j,) array
        The inverse weights of the rank-one terms.
    """

    def __init__(self, system: System, gradients: Floats, compliance: Floats) -> None:
        self._system, self._gradients = system, gradients
        if gradients.shape[1]:
            self._answers = system.solve(gradients)
            self._between = gradients.T @ self._answers
            self._small = np.linalg.inv(np.diag(compliance) + self._between)

    def solve(self, right: Floats) -> Floats:
        """Solve for one right-hand side, (N,)."""
        plain = self._system.solve(right[:, None])[:, 0]
        if not self._gradients.shape[1]:
            return plain
        return np.asarray(plain - self._answers @ (self._small @ (self._gradients.T @ plain)))

    def correction(self, excess: Floats) -> Floats:
        """Return the shortest move, in the Hessian's norm, that lowers the budgets by so much."""
        inverse = np.linalg.pinv(self._between, rcond=1e-12)  # a gradient may vanish
        return np.asarray(-self._answers @ (inverse @ excess))


def _longest(values: Floats, change: Floats) -> float:
    """Return the longest step, at most 1, that keeps positive values positive."""
    worst = float(np.min(change / values, initial=0.0))
    return min(1.0, FRACTION / -worst) if worst < 0.0 else 1.0
