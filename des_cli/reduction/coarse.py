"""Coarser grids on which a search is cheap, and the way back from them.

What makes a search long is finding the right branch, not resolution: it is found
on every k-th sample, and each finer grid starts from the one before.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.motion import Motion, Shortfall
from des_cli.reduction.problem import Problem
from des_cli.reduction.transcription import Transcription
from des_cli.solver.program import Indices

SAMPLES = 400
"""Samples of the coarsest grid, at least: the Cobra's factors there are within 1e-3 of
those between all samples, and local minima of its cost are as many."""

RATIO = 10.0
"""Samples of a grid over those of the next coarser one, at the most: one that is within
1e-3 of a solution needs two Newton steps to be within 1e-9, of another ten times finer
grid one."""


def grids(problem: Problem) -> list[Problem]:
    """Return the problem on grids from coarse to its own."""
    n = len(problem.desired.t)
    every = n // SAMPLES
    if every < 2:
        return [problem]
    count = int(np.ceil(np.log(every) / np.log(RATIO)))
    strides = np.unique(np.round(every ** (np.arange(1, count + 1) / count)).astype(int))
    return [coarsen(problem, int(stride)) for stride in strides[::-1]] + [problem]


def coarsen(problem: Problem, every: int) -> Problem:
    """Return a problem on every so many samples.

    The last sample stays, and so do those at which a rate steps unless they are many.
    """
    n = len(problem.desired.t)
    keep = np.zeros(n, dtype=bool)
    keep[::every] = keep[-1] = True
    steps = np.any(problem.desired.rate_step != 0.0, axis=1)
    steps |= np.any(problem.reference.rate_step != 0.0, axis=1)
    stepping = 1 + np.flatnonzero(steps)
    if len(stepping) < n // (2 * every):
        keep[stepping] = True
    kept = np.flatnonzero(keep)
    return replace(
        problem,
        desired=_at(problem.desired, kept),
        requested=None if problem.requested is None else _at(problem.requested, kept),
        shortfall=None if problem.shortfall is None else _shortfall_at(problem.shortfall, kept),
    )


def _shortfall_at(missing: Shortfall, kept: Indices) -> Shortfall:
    def sides(values: Floats) -> Floats:
        return np.stack([values[kept[:-1], 0], values[kept[1:] - 1, 1]], axis=1)

    return Shortfall(
        sides(missing.seat_rate),
        sides(missing.seat_angular_acceleration),
        sides(missing.seat_g),
        missing.attitude[kept],
    )


def _at(motion: Motion, kept: Indices) -> Motion:
    """Return a motion at some of its samples; rates that step keep their sides."""
    return Motion(
        t=motion.t[kept],
        angle=motion.angle[kept],
        rate_start=motion.rate_start[kept[:-1]],
        rate_end=motion.rate_end[kept[1:] - 1],
    )


def refine(x: Floats, coarse: Problem, grid: Transcription) -> Floats:
    """Return a coarse iterate on a finer grid: deviations and factors between its samples.

    Its angles do not quite keep the fine dynamics; the method begins by mending that.
    """
    t = grid.problem.desired.t
    off = x.copy()
    off[:, :3] -= coarse.desired.angle
    fine = np.stack([np.interp(t, coarse.desired.t, column) for column in off.T], axis=1)
    fine[:, :3] += grid.problem.desired.angle
    fine[grid.pinned] = grid.desired[grid.pinned]
    return fine
