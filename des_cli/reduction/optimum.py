"""The true minimum for given weights, from several starts.

Small weights r2 have worse local minima beside the best one. The way there is a
continuation: from a weight so large that the desired motion itself is nearly
optimal, down to the one asked for. The desired motion and the study's sweep are
starts too, so that the result is never above either, and per joint the scalar
optimum is one. All this happens on the coarsest grid; only the best minimum is
followed to the finer ones.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.solution import Solution
from des_cli.reduction.coarse import grids, refine
from des_cli.reduction.problem import FAINT, Problem
from des_cli.reduction.search import COARSE, TOLERANCE, Search
from des_cli.reduction.study_law import sweep
from des_cli.reduction.transcription import Transcription
from des_cli.solver.interior import Outcome

OUTWEIGH, RATIO = 20.0, 0.6
"""Continuation in r2: it starts where r2 outweighs the cost of the cross-coupling by this
factor, where the desired motion is nearly optimal, and goes down by at most RATIO a level, so
that each optimum is near the next."""

FAR, NEAR = 1.0, 1e-3
"""First barriers, relative to the problem's scale: far from every limit, and nearer, for a
start that is itself a solution."""


def find_optimum(problem: Problem, search: Search) -> Solution:
    """Find the minimum of a problem with weights.

    Parameters
    ----------
    problem : Problem
    search : Search

    Returns
    -------
    Solution
        ``converged``, ``acceptable``, ``iteration-limit`` or ``diverged``.
    """
    if mean_square(problem) <= FAINT:
        return passed_through(problem)
    coarsest, *finer = grids(problem)
    grid = Transcription(coarsest)
    best, starts = _find_best(grid, search)
    for coarse, fine in pairwise((coarsest, *finer)):
        grid = Transcription(fine)
        start = refine(best.x, coarse, grid)
        if best.usable:
            best = search.minimise(grid, start, TOLERANCE, NEAR)
        if not best.usable:
            again, starts = _find_best(grid, search)
            best = best_of([best, again]) if len(best.x) == grid.n else again
    return make_solution(grid, best, search, starts)


def mean_square(problem: Problem) -> float:
    """Return the mean of c' R1 c along the desired motion."""
    grid = Transcription(replace(problem, r2=np.zeros(problem.controls), tracking=np.zeros(3)))
    return 2.0 * grid.cost(grid.desired) / float(grid.weight.sum())


def passed_through(problem: Problem) -> Solution:
    """Return the desired motion, of which nothing is to be reduced."""
    grid = Transcription(problem)
    cost = grid.cost(grid.desired)
    return Solution(
        status="converged",
        message="the desired motion makes no cross-coupling: it is passed through",
        control=np.ones((grid.n, grid.m)),
        modified=grid.motion(grid.desired),
        adjoint=np.zeros((grid.n, 3)),
        cost=cost,
        cost_unreduced=cost,
        optimality=0.0,
        iterations=0,
    )


def _find_best(grid: Transcription, search: Search) -> tuple[Outcome, int]:
    """Return the best outcome on one grid, and the number of starts that it is the best of."""
    outcomes = [
        search.minimise(grid, start, TOLERANCE, barrier)
        for start, barrier in _starts(grid.problem, grid, search)
    ]
    return best_of(outcomes), len(outcomes)


def best_of(outcomes: list[Outcome]) -> Outcome:
    """Return the usable outcome of the lowest cost."""
    order = ("converged", "acceptable", "iteration-limit", "diverged")
    return min(outcomes, key=lambda o: (order.index(o.status), o.cost))


def make_solution(grid: Transcription, best: Outcome, search: Search, starts: int) -> Solution:
    """Turn an outcome into the solution of its problem."""
    return Solution(
        status=best.status,
        message=_sentence(best, starts, search),
        control=best.x[:, 3:],
        modified=grid.motion(best.x),
        adjoint=grid.adjoint(best.x, best.multiplier, best.prices),
        cost=best.cost,
        cost_unreduced=grid.cost(grid.desired),
        optimality=best.optimality,
        iterations=len(search.lines),
        log=tuple(search.lines),
    )


def _starts(
    problem: Problem, grid: Transcription, search: Search
) -> Iterator[tuple[Floats, float]]:
    """Yield starts with their barriers."""
    yield grid.desired, FAR
    if not grid.rows:
        x = grid.desired
        for level in _levels(problem, grid):
            looser = Transcription(replace(problem, r2=level * problem.r2))
            x = search.minimise(looser, x, COARSE).x
        yield x, FAR
        if problem.jacobian == "desired" and not np.any(grid.pinned[:, 3:]):
            swept = grid.follow(sweep(problem).control)
            if grid.cost(swept) < grid.cost(grid.desired):
                yield swept, FAR
    if grid.m == 3 and not np.any(problem.held):
        scalar = Transcription(replace(problem, r2=np.array([problem.r2.sum()])))
        x = search.minimise(scalar, scalar.desired, COARSE).x
        yield np.hstack([x[:, :3], np.repeat(x[:, 3:], 3, axis=1)]), NEAR


def _levels(problem: Problem, grid: Transcription) -> Floats:
    """Return the factors on r2 to go down, largest first, without the last one, 1."""
    coriolis_only = replace(problem, r2=0.0 * problem.r2, tracking=np.zeros(3))
    force = Transcription(coriolis_only).gradient(grid.desired)[:, 3:] / grid.weight[:, None]
    needed = OUTWEIGH * float(np.max(np.abs(force))) / problem.r2.min()
    if needed <= 1.0:
        return np.empty(0)
    count = int(np.ceil(np.log(needed) / -np.log(RATIO)))
    return np.geomspace(needed, 1.0, count + 1)[:-1]


def _sentence(best: Outcome, starts: int, search: Search) -> str:
    steps = f"{len(search.lines)} steps in all"
    if best.status == "converged":
        of = "" if starts == 1 else f", the best of {starts} starts"
        return f"first-order optimal to {best.optimality:.1e}{of}, {steps}"
    off = f"the first-order conditions are off by {best.optimality:.1e}"
    if best.infeasibility > TOLERANCE:
        off += f" and the constraints by {best.infeasibility:.1e}"
    if best.status == "acceptable":
        return f"short of the tolerance {TOLERANCE:g}: {off}; {steps}"
    if best.status == "iteration-limit":
        return f"{off} after {steps}; raise reduction.max_iterations ({search.limit})"
    return f"no step makes it better although {off}; check weights and limits"
