"""Zero Coriolis along the whole path: the study's Method 1, (25)-(27) and (48)-(57).

Minimise 1/2 int r2 (1 - u)^2 + (Theta - theta)' Q (Theta - theta) dt with the
weighted Coriolis components zero, to a tolerance, along the path. By the method of
multipliers (Nocedal and Wright, Numerical Optimization, section 17.3): the
multiplier nu of (51) enters as an offset, ``rho/2 |c + nu/rho|^2``, so that each
problem on the way is one of minimum Coriolis.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from des_cli.model.arrays import Flags, Floats
from des_cli.model.solution import Solution, Status
from des_cli.reduction.optimum import FAR, make_solution
from des_cli.reduction.problem import Problem
from des_cli.reduction.search import COARSE, TOLERANCE, Search
from des_cli.reduction.transcription import Transcription
from des_cli.solver.interior import Outcome

WITHIN = 0.5
"""Share of the tolerance that is allowed at samples: between them the Coriolis vector
bulges by a part that falls with the square of the step."""

FIRST_PENALTY, GROWTH, ENOUGH = 1e2, 10.0, 0.25
"""The penalty rho starts at this multiple of the mean running cost's weight over the
cross-coupling that it weighs, and grows by GROWTH where a round leaves more than the share
ENOUGH (Nocedal and Wright, framework 17.3)."""

LARGEST_PENALTY = 1e10
"""Beyond it the penalty would leave six of a double's sixteen digits to the rest of the cost."""

MOST_ROUNDS = 40
"""Rounds at the most: with ``PATIENCE`` a limit that is not met where anything is gained."""

EACH_ROUND = 300
"""Newton steps in one round, at the most."""

PATIENCE = 6
"""Rounds without progress after which zero counts as out of reach."""

FROZEN = 0.05
"""Share of the desired motion's squared rates below which a motion counts as frozen:
a machine that stands still has no Coriolis, and is no answer."""

WARM = 1e-2
"""First barrier from the solution of the round before, relative."""


@dataclass
class _Best:
    """The round that came closest to zero."""

    largest: float
    outcome: Outcome | None = None
    since: int = 0


def pose_zero(problem: Problem) -> Problem:
    """Return the problem of (25): no Coriolis in the cost; without a tracking weight, Q = I."""
    tracking = problem.tracking if np.any(problem.tracking) else np.ones(3)
    return replace(problem, tracking=tracking, r1=np.zeros((3, 3)))


def find_zero(problem: Problem, chosen: Flags, tolerance: float, search: Search) -> Solution:
    """Find the motion nearest to the desired one without the weighted Coriolis components.

    Parameters
    ----------
    problem : Problem
        As ``pose_zero`` makes it.
    chosen : (3,) array of bool
        The components that are to vanish.
    tolerance : float
        Largest component that may remain [rad/s^2].
    search : Search

    Returns
    -------
    Solution
        Its cost is (25). ``infeasible`` where the tolerance cannot be reached,
        with the smallest that was.
    """
    free = Transcription(problem)
    rho = FIRST_PENALTY
    offset = np.zeros((len(free.points.node), 3))
    best = _Best(_largest(free, free.desired, chosen))
    x, barrier, precision = free.desired, FAR, COARSE
    for _ in range(MOST_ROUNDS):
        grid = Transcription(replace(problem, r1=rho * np.diag(chosen.astype(float))))
        grid.offset = offset
        outcome = search.minimise(grid, x, precision, barrier, most=EACH_ROUND)
        largest = _largest(free, outcome.x, chosen)
        moving = _liveliness(free, outcome.x) >= FROZEN
        usable = moving and outcome.usable
        done = usable and largest <= WITHIN * tolerance
        if done and precision == TOLERANCE:
            return _solution(free, outcome, search)
        x, barrier = outcome.x, WARM
        if done:
            precision = TOLERANCE  # the multipliers serve; once more, to the end
            continue
        offset = offset + np.where(chosen, free.coriolis(x), 0.0)
        if largest > ENOUGH * best.largest and rho < LARGEST_PENALTY:
            rho *= GROWTH
            offset = offset / GROWTH
        best.since += 1
        if usable and largest < 0.9 * best.largest:
            best = _Best(largest, outcome)
        if best.since >= PATIENCE or search.left == 0:
            break
    return _refuse(free, problem, best, outcome, tolerance, search)


def _largest(grid: Transcription, x: Floats, chosen: Flags) -> float:
    return float(np.max(np.abs(grid.coriolis(x)[:, chosen]), initial=0.0))


def _liveliness(grid: Transcription, x: Floats) -> float:
    """Return the squared rates of an iterate over those of the desired motion."""
    rate, desired = grid.rates.value(grid.points.gather(x)), grid.points.rate
    weight = grid.points.weight
    size = float(weight @ np.sum(desired**2, axis=1))
    if size == 0.0:
        return 1.0  # it is asked to stand still
    return float(weight @ np.sum(rate**2, axis=1)) / size


def _solution(grid: Transcription, outcome: Outcome, search: Search) -> Solution:
    return make_solution(grid, replace(outcome, cost=grid.cost(outcome.x)), search, 1)


def _refuse(
    grid: Transcription,
    problem: Problem,
    best: _Best,
    last: Outcome,
    tolerance: float,
    search: Search,
) -> Solution:
    """Return what came closest, with why it is not enough."""
    if problem.controls == 1:
        why = (
            "a scalar factor can only freeze the machine or jump between branches where a "
            "Coriolis component is to vanish; use control: per-joint"
        )
    elif problem.machine is not None:
        why = "no motion inside the limits that was found keeps it"
    else:
        why = "no motion that was found keeps it; inside the limits (limits: enforce) one may"
    status: Status = "infeasible"
    if not search.left:
        status, why = "iteration-limit", f"raise reduction.max_iterations ({search.limit})"
    return replace(
        _solution(grid, best.outcome or last, search),
        status=status,
        message=(
            f"Coriolis within {tolerance:g} rad/s^2 was not reached: {why}; "
            f"the smallest tolerance reached is {best.largest / WITHIN:.2g} rad/s^2"
        ),
    )
