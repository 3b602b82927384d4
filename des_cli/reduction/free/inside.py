"""A point strictly inside budgets and bounds, from one that may be outside.

Bounds at points are approached by a penalty, the squares of what exceeds them. Budgets
that are exceeded are approached by minimising their sum, relaxed to just beyond where
they stand, and less and less until all is inside. What is kept stays kept.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from des_cli.model.arrays import Flags, Floats
from des_cli.reduction.free.expansion import MotionExpansion
from des_cli.reduction.free.program import MotionProgram
from des_cli.reduction.free.system import MotionSystem
from des_cli.solver.barrier import Options, Step, minimise
from des_cli.solver.feasible_program import Values

ROOM = 0.02
"""Share of a squared budget that a start leaves: one that is nearly spent from the
beginning takes hundreds of steps."""

LITTLE_ROOM = 1e-3
"""The least that it may leave."""

AIM = 0.01
"""How far inside a bound at points the penalty aims."""

BEYOND = 0.05
"""How far beyond where it stands an exceeded budget is relaxed."""

PROGRESS = 0.02
"""Share by which a round must lower the worst excess."""

ROUNDS, EACH = 40, 12
"""Rounds, and Newton steps in each."""

CENTRAL = Options(gap=1.0, start_gap=10.0, max_iterations=EACH)
"""A large barrier keeps away from everything that could be in the way."""

ACTING = Options(gap=1e-4, start_gap=0.1, max_iterations=4 * EACH)
"""A small one lets the penalty act."""


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
    if np.any(np.abs(program.linear(x)) >= program.bounds):
        return None
    if is_inside(program, x):
        return x
    plain = MotionProgram(replace(program.problem, cost=[], ground=None))
    for _ in range(ROUNDS):
        over = np.maximum(values.budgets - 1.0 + BEYOND, 0.0)
        over[values.budgets < 1.0 - LITTLE_ROOM] = 0.0  # what is kept is kept
        if _worst(values) < -LITTLE_ROOM:
            return x
        at_points = _largest(values.local) >= 1.0 - LITTLE_ROOM
        before = _excess(values, at_points)
        if at_points:
            penalised = _Penalised(plain, over)
            x = minimise(penalised, x, replace(ACTING, stop_early=penalised.inside), on_step).x
        else:
            relaxed = _Relaxed(_nearest(program, over > 0.0), over)
            x = minimise(relaxed, x, replace(CENTRAL, stop_early=relaxed.inside), on_step).x
        values = program.values(x)
        # each round is judged by what it lowers: the other may be the larger excess
        after = _excess(values, at_points)
        if _worst(values) < -ROOM or after > before - PROGRESS * max(before, ROOM):
            break
    return x if _worst(values) < -LITTLE_ROOM else None


def is_inside(program: MotionProgram, x: Floats) -> bool:
    """Return whether a point inside the limits on the joints has room to budgets and bounds."""
    return _worst(program.values(x)) < -LITTLE_ROOM


def _largest(values: Floats) -> float:
    return float(np.max(values, initial=0.0))


def _worst(values: Values) -> float:
    """Return the largest excess of a budget or bound over one."""
    return max(_excess(values, at_points=True), _excess(values, at_points=False))


def _excess(values: Values, at_points: bool) -> float:
    """Return the largest excess over one of a bound at points, or of a budget."""
    return _largest(values.local if at_points else values.budgets) - 1.0


def _nearest(program: MotionProgram, exceeded: Flags) -> MotionProgram:
    """Return the program whose cost is the sum of the budgets that are exceeded."""
    problem = program.problem
    cost = [budget for budget, over in zip(problem.budgets, exceeded, strict=True) if over]
    return MotionProgram(replace(problem, cost=cost, ground=None))


class _Wrapped:
    """A program that shares its limits and its systems with another.

    Parameters
    ----------
    program : MotionProgram
    shift : (j,) array
        From which on each budget counts.
    """

    def __init__(self, program: MotionProgram, shift: Floats) -> None:
        self._program, self._shift = program, shift
        self.bounds = program.bounds
        self.linear, self.linear_change = program.linear, program.linear_change
        self.linear_adjoint, self.reduce = program.linear_adjoint, program.reduce
        self._last: Values | None = None


class _Relaxed(_Wrapped):
    """A program whose budgets count from a shift on."""

    def values(self, x: Floats) -> Values:
        """Evaluate, shifted."""
        self._last = values = self._program.values(x)
        return Values(values.cost, values.budgets - self._shift, values.local)

    def expand(
        self, x: Floats, budget: Floats, local: Floats, stiffness: Floats
    ) -> MotionExpansion:
        """Expand, shifted."""
        expansion = self._program.expand(x, budget, local, stiffness)
        expansion.budgets = expansion.budgets - self._shift
        return expansion

    def system(
        self, expansion: MotionExpansion, share: float, stiffness: Floats, shift: float
    ) -> MotionSystem | None:
        """Factorise."""
        return self._program.system(expansion, share, stiffness, shift)

    def inside(self, budgets: Floats) -> bool:
        """Return whether the last iterate is inside without the shift."""
        return self._last is not None and _worst(self._last) < -ROOM


class _Penalised(_Wrapped):
    """A program whose cost is the mean square of what exceeds bounds at points.

    Its budgets count from a shift on; it has no bounds at points of its own.
    """

    def values(self, x: Floats) -> Values:
        """Evaluate the penalty."""
        self._last = values = self._program.values(x)
        excess = np.maximum(values.local - (1.0 - AIM), 0.0)
        cost = values.cost + float(np.mean(excess**2))
        return Values(cost, values.budgets - self._shift, np.zeros(0))

    def expand(
        self, x: Floats, budget: Floats, local: Floats, stiffness: Floats
    ) -> _PenaltyExpansion:
        """Expand the penalty; where it is zero it has no curvature."""
        excess = np.maximum(self._program.values(x).local - (1.0 - AIM), 0.0)
        slope = 2.0 * excess / len(excess)
        curvature = 2.0 * (excess > 0.0) / len(excess)
        inner = self._program.expand(x, budget, slope, curvature)
        return _PenaltyExpansion(inner, float(np.mean(excess**2)), slope, self._shift)

    def system(
        self, expansion: _PenaltyExpansion, share: float, stiffness: Floats, shift: float
    ) -> MotionSystem | None:
        """Factorise."""
        return self._program.system(expansion.inner, share, stiffness, shift)

    def inside(self, budgets: Floats) -> bool:
        """Return whether the last iterate keeps the bounds at points."""
        return self._last is not None and _largest(self._last.local) < 1.0 - 0.5 * AIM


class _PenaltyExpansion:
    """The expansion of a penalised program."""

    def __init__(
        self, inner: MotionExpansion, penalty: float, slope: Floats, shift: Floats
    ) -> None:
        self.inner = inner
        self.cost = inner.cost + penalty
        self.budgets = inner.budgets - shift
        self.gradient: Floats = inner.gradient + inner.local_adjoint(slope)
        self.budget_gradients = inner.budget_gradients

    def local_change(self, step: Floats) -> Floats:
        """Return nothing: there are no bounds."""
        return np.zeros(0)

    def local_adjoint(self, multiplier: Floats) -> Floats:
        """Return zero."""
        return np.zeros_like(self.gradient)
