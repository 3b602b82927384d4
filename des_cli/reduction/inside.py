"""A point strictly inside budgets and bounds, from one that may be outside.

The budgets' sum is minimised, with everything that is still exceeded relaxed to just
beyond where it stands, and relaxed less and less until all is inside.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.reduction.motion_program import JointBudget, MotionProgram
from des_cli.reduction.motion_system import MotionExpansion
from des_cli.reduction.terms import Term
from des_cli.solver.barrier import Options, Step, Values, minimise

ROOM = 0.02
"""Share of a squared budget that a start leaves: one that is nearly spent from the
beginning takes hundreds of steps."""

LITTLE_ROOM = 1e-3
"""The same of a warm start."""

BEYOND = 0.05
"""How far beyond where it stands an exceeded bound is relaxed."""

PROGRESS = 0.02
"""Share by which a round must lower the worst excess."""

ROUNDS, EACH = 40, 12
"""Rounds, and Newton steps in each."""


def find_inside(
    program: MotionProgram, x: Floats, on_step: Callable[[Step], None] | None = None
) -> Floats | None:
    """Return a point inside, or None where none was found.

    Parameters
    ----------
    program : MotionProgram
    x : (N,) array
        Inside the limits on the joints.
    on_step : callable, optional
        Called with each Newton step.
    """
    values = program.values(x)
    limits = program.linear(x)
    if np.any(np.abs(limits) >= program.bounds):
        return None
    if _worst(values) < -LITTLE_ROOM:
        return x
    nearest = _nearest(program)
    for _ in range(ROUNDS):
        worst = _worst(values)
        if worst < -ROOM:
            return x
        shift = max(worst + BEYOND, 0.0)
        relaxed = _Relaxed(nearest, shift)
        options = Options(gap=1e-2, start_gap=0.1, max_iterations=EACH, stop_early=relaxed.inside)
        outcome = minimise(relaxed, x, options, on_step)
        x, values = outcome.x, program.values(outcome.x)
        if _worst(values) < -ROOM or _worst(values) > worst - PROGRESS * max(worst, ROOM):
            break
    return x if _worst(values) < -LITTLE_ROOM else None


def _worst(values: Values) -> float:
    """Return the largest excess of a budget or bound over one."""
    both = np.concatenate([values.budgets, values.local])
    return float(np.max(both, initial=-1.0)) - 1.0 if len(both) else -1.0


def _nearest(program: MotionProgram) -> MotionProgram:
    """Return the program whose cost is the sum of the budgets."""
    problem = program.problem
    terms = [budget for budget in problem.budgets if isinstance(budget, Term)]
    keep = [budget for budget in problem.budgets if isinstance(budget, JointBudget)]
    cost = terms or list(problem.cost)
    return MotionProgram(replace(problem, cost=cost, budgets=[*terms, *keep]))


class _Relaxed:
    """A program whose budgets and bounds count from a shift on."""

    def __init__(self, program: MotionProgram, shift: float) -> None:
        self._program, self._shift = program, shift
        self.bounds = program.bounds
        self.linear, self.linear_change = program.linear, program.linear_change
        self.linear_adjoint, self.reduce = program.linear_adjoint, program.reduce
        self.system = program.system
        self._last: Values | None = None

    def values(self, x: Floats) -> Values:
        """Evaluate, shifted."""
        self._last = values = self._program.values(x)
        return Values(values.cost, values.budgets - self._shift, values.local - self._shift)

    def expand(
        self, x: Floats, budget: Floats, local: Floats, stiffness: Floats, share: float
    ) -> MotionExpansion:
        """Expand, shifted."""
        expansion = self._program.expand(x, budget, local, stiffness, share)
        expansion.budgets = expansion.budgets - self._shift
        expansion.local = expansion.local - self._shift
        return expansion

    def inside(self, budgets: Floats) -> bool:
        """Return whether the last iterate is inside without the shift."""
        return self._last is not None and _worst(self._last) < -ROOM
