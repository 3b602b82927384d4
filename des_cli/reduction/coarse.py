"""A coarser grid on which a search is cheap, and the way back from it.

What makes a search long is finding the right branch and price, not resolution:
both are found on every k-th sample, and the fine grid starts from there.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.motion import Motion
from des_cli.reduction.problem import Problem
from des_cli.reduction.transcription import Transcription

SAMPLES = 250
"""Samples of a coarse grid, about: on the Cobra at 5 % per joint they tell the reduction
to half a per cent."""


def coarsen(problem: Problem) -> Problem | None:
    """Return a problem on every k-th sample, or None where the grid is coarse already.

    The last sample stays; rates that step keep their sides.
    """
    n = len(problem.desired.t)
    every = n // SAMPLES
    if every < 2:
        return None
    kept = np.unique(np.append(np.arange(0, n, every), n - 1))
    desired = problem.desired
    coarse = Motion(
        t=desired.t[kept],
        angle=desired.angle[kept],
        rate_start=desired.rate_start[kept[:-1]],
        rate_end=desired.rate_end[kept[1:] - 1],
    )
    return replace(problem, desired=coarse)


def refine(x: Floats, coarse: Problem, grid: Transcription) -> Floats:
    """Return a coarse iterate on the fine grid: deviations and factors between its samples.

    Its angles do not quite keep the fine dynamics; the method begins by mending that.
    """
    t = grid.problem.desired.t
    off = x.copy()
    off[:, :3] -= coarse.desired.angle
    fine = np.stack([np.interp(t, coarse.desired.t, column) for column in off.T], axis=1)
    fine[:, :3] += grid.problem.desired.angle
    fine[grid.pinned] = grid.desired[grid.pinned]
    return fine
