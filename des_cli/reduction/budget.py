"""The most Coriolis reduction for budgets, instead of weights that must be guessed.

Minimise 1/2 int c' R1 c over the factors, inside the limits, with each measure of
fidelity at most its budget. The desired motion itself spends nothing, or what its
executable replacement costs: it is the start.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from des_cli.model.metric import ANGULAR_ACCELERATION_PEAK_RATIO, ATTITUDE_ERROR, METRICS, Budget
from des_cli.model.solution import Solution
from des_cli.reduction.attitude_rows import AttitudeRows
from des_cli.reduction.budget_measures import measure_of
from des_cli.reduction.coarse import grids, refine
from des_cli.reduction.felt_budget_measures import SeatAccelerationRows
from des_cli.reduction.optimum import (
    FAR,
    NEAR,
    best_of,
    make_solution,
    mean_square,
    passed_through,
)
from des_cli.reduction.problem import FAINT, Problem
from des_cli.reduction.search import TOLERANCE, Search
from des_cli.reduction.transcription import Transcription
from des_cli.solver.interior import Outcome
from des_cli.units import percent

REGULARISATION = 2e-3
"""Weight on (1 - u)^2 beside a budget, relative to the mean of the desired motion's
c' R1 c: enough that the factors are determined everywhere, and no more."""

BARRIERS = (FAR, 0.1)
"""First barriers of the starts from the desired motion: where there are several minima
they lead to different ones."""

EACH_START = 400
"""Newton steps that a start may take on the coarsest grid, so that one that creeps leaves the
others their share of all steps."""

ROOM = 1e-6
"""Share of a budget that stays unspent, for the rounding of whoever measures it anew."""


def spend_budgets(problem: Problem, budgets: Sequence[Budget], search: Search) -> Solution:
    """Find the most reduction that budgets buy.

    Parameters
    ----------
    problem : Problem
        As ``pose_budget`` makes it.
    budgets : sequence of Budget
    search : Search

    Returns
    -------
    Solution
    """
    if mean_square(problem) <= FAINT:
        return passed_through(problem)
    coarsest, *finer = grids(problem)
    grid = _with_budgets(coarsest, budgets)
    best = _from_desired(grid, search)
    starts = len(BARRIERS)
    for coarse, fine in pairwise((coarsest, *finer)):
        grid = _with_budgets(fine, budgets)
        followed = best
        if best.usable:
            start = refine(best.x, coarse, grid)
            followed = search.minimise(grid, start, TOLERANCE, NEAR, prices=best.prices)
        if not (best.usable and followed.usable):
            again = _from_desired(grid, search)
            followed = best_of([followed, again]) if len(followed.x) == grid.n else again
        best = followed
    solution = make_solution(grid, best, search, starts)
    return replace(solution, message=f"{solution.message}; {_spent(grid, budgets, best)}")


def pose_budget(problem: Problem) -> Problem:
    """Return the problem with a small regularising r2 instead of r2 and tracking."""
    m = problem.controls
    r2 = max(REGULARISATION * mean_square(problem), 1e-9)
    return replace(problem, r2=np.full(m, r2 / m), tracking=np.zeros(3))


def _with_budgets(problem: Problem, budgets: Sequence[Budget]) -> Transcription:
    """Return a problem on its grid, with budgets on whole motions and at samples."""
    grid = Transcription(problem)
    for budget in budgets:
        most = budget.most * (1.0 - ROOM)
        if budget.metric == ATTITUDE_ERROR:
            requested = problem.reference.angle, problem.shortfall
            grid.rows.append(AttitudeRows(problem.chain, *requested, most))
        elif budget.metric == ANGULAR_ACCELERATION_PEAK_RATIO:
            grid.rows.append(SeatAccelerationRows(grid, most))
        else:
            grid.budgets.append(measure_of(grid, budget.metric, most))
    return grid


def _from_desired(grid: Transcription, search: Search) -> Outcome:
    """Return the best outcome from the desired motion."""
    return best_of(
        [
            search.minimise(grid, grid.desired, TOLERANCE, barrier, most=EACH_START)
            for barrier in BARRIERS
        ]
    )


def _spent(grid: Transcription, budgets: Sequence[Budget], best: Outcome) -> str:
    """Return the sentence on what is spent of each budget."""
    measures = iter(grid.budgets)
    bounds = {type(rows): rows for rows in grid.rows}
    shares = []
    for budget in budgets:
        if budget.metric == ATTITUDE_ERROR:
            square = float(np.max(bounds[AttitudeRows].value(best.x)))
        elif budget.metric == ANGULAR_ACCELERATION_PEAK_RATIO:
            square = float(np.max(bounds[SeatAccelerationRows].value(best.x)))
        else:
            square = next(measures).value(best.x)
        shares.append(
            f"{percent(float(np.sqrt(square)), 4)} of the budget on {METRICS[budget.metric].key}"
        )
    sentence = f"{', '.join(shares)} {'is' if len(shares) == 1 else 'are'} spent"
    if not best.usable and any(measure.value(grid.desired) > 1.0 for measure in grid.budgets):
        sentence += "; the nearest motion inside the limits overspends already: allow more"
    return sentence
