"""First-order conditions of factors on the desired rates, by finite differences of the cost."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from des_cli.model.arrays import Flags, Floats
from des_cli.model.metric import FACTOR_DEVIATION, PEAK_METRICS, Budget
from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.reduction.problem import Problem
from des_cli.verify.budgets import (
    at_states,
    integrand,
    mean_square_one_minus_p,
    size,
    spent_budgets,
)
from des_cli.verify.claim import Claim
from des_cli.verify.factors import cost_of, integrated
from des_cli.verify.felt import Felt
from des_cli.verify.multipliers import least_residual

OPTIMALITY_TOLERANCE = 1e-5
"""Largest slope of the cost along a test direction, relative to the largest slope
that the desired motion has along any of them."""

TIGHT = 1.0 - 1e-3
"""Share of a limit above which it may hold a factor: nearer, a barrier has a force."""

DIFFERENCE_STEP = 1e-4
"""Half step of the central difference; the cost is quartic in it, so that its
truncation error is of the order of 1e-8."""

DIRECTIONS = 12
"""Directions for tables of up to LONG rows."""

FEW, LONG = 4, 10_000
"""Directions beyond the number of budgets that are enough for longer tables: each costs two
evaluations of the whole motion. FEW are enough for the desired motion's slope."""

SEED = 20_240_229
"""Of the random directions: any number, always the same, so that a verdict is too."""


def check_optimality(claim: Claim, problem: Problem) -> Check:
    """Test the first-order conditions along directions.

    The directions change no factor that a limit holds: along them the cost has no
    slope, or, with budgets, nonnegative multiples of what these have.
    """
    test = _Slopes(claim, problem)
    control, ones = claim.solution.control, np.ones_like(claim.solution.control)
    free = _free(claim, problem)
    spent = spent_budgets(claim)
    count = DIRECTIONS if len(control) <= LONG else FEW + len(spent)
    at_desired, of_cost, of_budget = 0.0, [], []
    for index, direction in enumerate(_directions(problem, control.shape, count)):
        if index < FEW:
            at_desired = max(at_desired, abs(test.cost(ones, direction)))
        along = _keeping_ends(problem, direction * free)
        of_cost.append(test.cost(control, along))
        of_budget.append([test.budget(b, control, along) for b in spent])
    residual = least_residual(np.array(of_cost), np.array(of_budget).reshape(count, -1))
    floor = claim.duration * float(np.min(problem.r2)) * 1e-3
    return Check(
        "optimality",
        "slope of the cost at the optimum, relative to the desired motion's",
        float(np.max(np.abs(residual))) / max(at_desired, floor),
        OPTIMALITY_TOLERANCE,
    )


@dataclass(frozen=True, eq=False)
class _Slopes:
    """Slopes of cost and budgets along changes of the factors."""

    claim: Claim
    problem: Problem

    def cost(self, control: Floats, direction: Floats) -> float:
        ahead, behind = (
            cost_of(self.claim, self.problem, moved, self._felt(moved))
            for moved in _both_ways(control, direction)
        )
        return (ahead - behind) / (2.0 * DIFFERENCE_STEP)

    def budget(self, budget: Budget, control: Floats, direction: Floats) -> float:
        ahead, behind = (
            self._spent(budget, moved)
            for moved in (
                control + DIFFERENCE_STEP * direction,
                control - DIFFERENCE_STEP * direction,
            )
        )
        return (ahead - behind) / (2.0 * DIFFERENCE_STEP)

    def _felt(self, control: Floats) -> Felt:
        """Return what is felt along the motion of factors on the desired rates."""
        desired = self.problem.desired
        factor = np.broadcast_to(control, (len(control), 3))
        start, end = factor[:-1] * desired.rate_start, factor[1:] * desired.rate_end
        angle = integrated(self.problem, factor, start, end)
        return self.claim.chain.along(Motion(desired.t, angle, start, end))

    def _spent(self, budget: Budget, control: Floats) -> float:
        """Return the square of a metric over that of its budget, or a multiple of it."""
        claim, metric = self.claim, budget.metric
        if metric == FACTOR_DEVIATION:
            return mean_square_one_minus_p(claim, control) / budget.most
        square = float(claim.weight @ integrand(metric, self._felt(control), claim.before))
        return square / (size(claim, metric) * budget.most**2)


def _both_ways(control: Floats, direction: Floats) -> tuple[Floats, Floats]:
    return control + DIFFERENCE_STEP * direction, control - DIFFERENCE_STEP * direction


def _free(claim: Claim, problem: Problem) -> Flags:
    """Return the factors that can move both ways, (n, m)."""
    motion, shape = claim.modified, claim.solution.control.shape
    free = np.tile(~problem.held if shape[1] == 3 else np.ones(3, dtype=bool), (shape[0], 1))
    if problem.machine is not None:
        rate, acceleration, jerk, angle = (
            np.array([getattr(limit, name) for limit in problem.machine.limits])
            for name in ("rate", "acceleration", "jerk", "angle")
        )
        fastest = np.maximum(np.abs(motion.rate_start), np.abs(motion.rate_end))
        tight = (fastest > TIGHT * rate) | (np.abs(motion.acceleration) > TIGHT * acceleration)
        free[:-1] &= ~tight
        free[1:] &= ~tight
        sharp = np.abs(motion.jerk) > TIGHT * jerk  # of three factors
        for first in range(3):
            free[first : len(free) - 2 + first] &= ~sharp
        free &= ~_now_or_later(np.abs(motion.angle) > TIGHT * angle)
    for budget in claim.reduction.budget:
        if budget.metric in PEAK_METRICS:
            tight = at_states(claim, budget.metric, claim.after) > TIGHT * budget.most
            held = np.zeros(shape[0], dtype=bool)
            held[:-1] = tight[: len(tight) // 2]
            held[1:] |= tight[len(tight) // 2 :]
            free &= ~_now_or_later(held[:, None])
    if problem.ends != "free":
        free[0] = False
    if problem.ends == "match-both":
        free[-1] = False
    return np.asarray(free if shape[1] == 3 else free.all(axis=1, keepdims=True))


def _now_or_later(tight: Flags) -> Flags:
    """Return where a flag is set or will be: an angle depends on every factor before it."""
    return np.asarray(np.logical_or.accumulate(tight[::-1], axis=0)[::-1])


def _keeping_ends(problem: Problem, direction: Floats) -> Floats:
    """Return the part of a direction that leaves the last angles alone, if they must match."""
    if problem.ends != "match-both":
        return direction
    desired = problem.desired
    half = 0.5 * np.diff(desired.t)[:, None]
    missed = np.diff(desired.angle, axis=0) - half * (desired.rate_start + desired.rate_end)
    missed[:, 0] = 0.0
    reach = np.zeros_like(desired.angle)  # d theta(tf) / d u_k, joint by joint
    reach[:-1] += half * desired.rate_start + 0.5 * missed
    reach[1:] += half * desired.rate_end + 0.5 * missed
    reach = reach * (direction != 0.0)
    if direction.shape[1] == 1:
        amounts = np.linalg.lstsq(reach.T @ reach, reach.T @ direction, rcond=None)[0]
        return np.asarray(direction - reach @ amounts)
    norm = np.maximum(np.sum(reach**2, axis=0), 1e-300)
    return np.asarray(direction - reach * (np.sum(reach * direction, axis=0) / norm))


def _directions(problem: Problem, shape: tuple[int, ...], count: int) -> Iterator[Floats]:
    """Yield smooth changes of the factors of size one, always the same ones."""
    generator = np.random.default_rng(SEED)
    time = (problem.desired.t - problem.desired.t[0]) / np.ptp(problem.desired.t)
    for index in range(count):
        if index % 2:  # a bump somewhere, of some width
            bump = np.exp(-(((time - generator.uniform()) / generator.uniform(0.02, 0.3)) ** 2))
            direction = bump[:, None] * generator.normal(size=shape[1])
        else:  # a wave over the whole motion
            waves = np.cos(np.pi * np.arange(12) * time[:, None])
            direction = waves @ generator.normal(size=(12, shape[1]))
        yield direction / np.max(np.abs(direction))
