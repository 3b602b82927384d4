"""The most Coriolis reduction for a budget, instead of weights that must be guessed.

Minimise 1/2 int c' R1 c over the factors, inside the limits, with one measure of
fidelity at most its budget. The measure is paid for at a price; the price at which
exactly the budget is spent is found by a bracketing search. For the joint deviation
the price is a tracking weight Q that nobody had to know.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.metric import MetricKey
from des_cli.model.solution import Solution
from des_cli.reduction.coarse import coarsen, refine
from des_cli.reduction.measures import measure_of
from des_cli.reduction.optimum import FAR, NEAR, make_solution
from des_cli.reduction.problem import Problem
from des_cli.reduction.search import TOLERANCE, Search
from des_cli.reduction.transcription import Measure, Transcription
from des_cli.solver.interior import Outcome

REGULARISATION = 2e-3
"""Weight on (1 - u)^2 beside a budget, relative to the mean of the desired motion's
c' R1 c: enough that the factors are determined everywhere, and no more."""

TARGET = 0.999
"""Share of the squared budget that the search aims at."""

SPENT, PATIENCE, IMPATIENCE = 0.997, 4, 0.02
"""Share of the squared budget that counts as spent; after PATIENCE prices it falls by
IMPATIENCE with each further one. Between two local minima what is spent jumps with the
price, and the gap cannot be closed by prices."""

EACH_PRICE = 200
"""Newton steps at one price on the way, at the most: most take a tenth of that."""

OTHER_START = 150  # Newton steps that another start may take
COARSE = 1e-4  # tolerance on the way
MOST_PRICES = 20
WIDEST_STEP = 30.0  # factor between two prices while nothing brackets the right one
NOTHING_LEFT = 1e-3
"""Share of the unreduced cost below which there is nothing left to buy: a solution
that spends less than its budget is then the better one."""

WARM = 1e-2  # first barrier from a solution at another price, relative
CLOSE = 1e-3  # relative width of a bracket in which the measure jumps


@dataclass(frozen=True)
class _Priced:
    """A solution at one price."""

    price: float
    spent: float  # the measure's value; the budget is one
    outcome: Outcome


def spend_budget(problem: Problem, metric: MetricKey, budget: float, search: Search) -> Solution:
    """Find the most reduction that a budget buys.

    Parameters
    ----------
    problem : Problem
        As ``pose_budget`` makes it.
    metric : str
        A metric of ``fidelity``.
    budget : float
        The largest value of the metric.
    search : Search

    Returns
    -------
    Solution
        Its cost is J without the price of the measure.
    """
    grid = Transcription(problem)
    measure = measure_of(grid, metric, budget)
    found = _search_price(
        grid, measure, search, _coarse_start(problem, grid, metric, budget, search)
    )
    found = _better_start(grid, measure, found, search)
    grid.priced = [(found.price, measure)]
    solution = make_solution(grid, found.outcome, search, 1)
    grid.priced = []
    share = float(np.sqrt(found.spent))
    return replace(
        solution,
        cost=grid.cost(found.outcome.x),
        cost_unreduced=grid.cost(grid.desired),
        message=f"{solution.message}; {share:.2%} of the budget on {metric} is spent",
    )


def pose_budget(problem: Problem) -> Problem:
    """Return the problem with a small regularising r2 instead of r2 and tracking."""
    m = problem.controls
    bare = replace(problem, r2=np.zeros(m), tracking=np.zeros(3))
    grid = Transcription(bare)
    mean = 2.0 * grid.cost(grid.desired) / grid.weight.sum()
    return replace(bare, r2=np.full(m, max(REGULARISATION * mean, 1e-9) / m))


def _coarse_start(
    problem: Problem, grid: Transcription, metric: MetricKey, budget: float, search: Search
) -> tuple[float, Floats] | None:
    """Return price and iterate that a coarser grid finds, or None without one."""
    every = len(problem.desired.t) // 250
    if every < 2:
        return None
    coarse = coarsen(problem, every)
    rough = Transcription(coarse)
    found = _search_price(rough, measure_of(rough, metric, budget), search, None)
    return found.price, refine(found.outcome.x, coarse, grid)


def _search_price(
    grid: Transcription, measure: Measure, search: Search, start: tuple[float, Floats] | None
) -> _Priced:
    """Return the solution at the price at which the budget is spent, from inside it."""
    unit = max(grid.cost(grid.desired), 1e-12)
    price, x, barrier = (unit, grid.desired, FAR) if start is None else (*start, NEAR)
    tries = [_at_price(grid, measure, price, x, barrier, COARSE, search)]
    while len(tries) < MOST_PRICES and search.left:
        within = [t for t in tries if t.spent <= 1.0]
        inside = min(within, key=lambda t: t.price, default=None)
        outside = max((t for t in tries if t.spent > 1.0), key=lambda t: t.price, default=None)
        enough = SPENT - IMPATIENCE * max(0, len(tries) - PATIENCE)
        if inside and (inside.spent >= enough or _rest(inside) <= NOTHING_LEFT * unit):
            break
        if inside and outside and inside.price < outside.price * (1.0 + CLOSE):
            break
        # from the motion that spends most inside the budget: on one branch of local
        # minima what is spent follows the price without jumps
        known = max(within, key=lambda t: t.spent, default=tries[-1])
        price = _next_price(tries, inside, outside)
        tries.append(_at_price(grid, measure, price, known.outcome.x, WARM, COARSE, search))
    best = max((t for t in tries if t.spent <= 1.0), key=lambda t: t.spent, default=tries[-1])
    return _polish(grid, measure, best, search)


def _rest(tried: _Priced) -> float:
    """Return the cost without the price."""
    return tried.outcome.cost - tried.price * tried.spent


def _next_price(tries: list[_Priced], inside: _Priced | None, outside: _Priced | None) -> float:
    """Return the next price: a secant in the logarithms, inside the bracket if there is one."""
    last = tries[-1]
    slope = -1.25  # of log spent over log price, until two prices tell
    if len(tries) > 1 and tries[-2].price != last.price:
        before = tries[-2]
        seen = np.log(max(last.spent, 1e-12) / max(before.spent, 1e-12))
        slope = min(-0.1, float(seen / np.log(last.price / before.price)))
    step = np.log(TARGET / max(last.spent, 1e-12)) / slope
    price = last.price * float(np.exp(np.clip(step, -np.log(WIDEST_STEP), np.log(WIDEST_STEP))))
    if inside is None or outside is None:
        return price
    low, high = sorted((inside.price, outside.price))
    width = high / low
    return float(np.clip(price, low * width**0.05, high / width**0.05))


def _at_price(
    grid: Transcription,
    measure: Measure,
    price: float,
    x: Floats,
    barrier: float,
    tolerance: float,
    search: Search,
) -> _Priced:
    grid.priced = [(price, measure)]
    most = EACH_PRICE if tolerance > TOLERANCE else None
    outcome = search.minimise(grid, x, tolerance, barrier, most=most)
    return _Priced(price, measure.spent(outcome.x), outcome)


def _polish(grid: Transcription, measure: Measure, found: _Priced, search: Search) -> _Priced:
    """Solve to the full tolerance; raise the price a little if that overspends."""
    price, x = found.price, found.outcome.x
    for round_ in range(MOST_PRICES):
        fine = _at_price(grid, measure, price, x, NEAR, TOLERANCE, search)
        if fine.spent <= 1.0 or search.left == 0:
            return fine
        # little at first; a solution far outside has left for another branch
        price *= float(np.clip(fine.spent**2, 1.0 + 1e-4 * 4**round_, WIDEST_STEP))
        x = fine.outcome.x
    return fine


def _better_start(grid: Transcription, measure: Measure, found: _Priced, search: Search) -> _Priced:
    """Try the same price from other starts; keep what is better and inside the budget."""
    grid.priced = [(found.price, measure)]
    for barrier in (0.1,):
        outcome = search.minimise(grid, grid.desired, TOLERANCE, barrier, most=OTHER_START)
        spent = measure.spent(outcome.x)
        usable = outcome.status == "converged" and spent <= 1.0
        if usable and outcome.cost < found.outcome.cost - 1e-9 * abs(found.outcome.cost):
            found = _Priced(found.price, spent, outcome)
    return found
