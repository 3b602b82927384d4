"""Coarser grids: what they keep, and that the way back is the way there."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from des_cli.reduction.coarse import RATIO, SAMPLES, coarsen, grids, refine
from des_cli.reduction.optimum import find_optimum
from des_cli.reduction.search import TOLERANCE, Search
from des_cli.reduction.transcription import Transcription
from des_cli.solver.interior import minimise


def test_grids_go_from_coarse_to_their_own_in_like_ratios(cobra, pose):
    problem = pose(cobra(40_000))
    found = grids(problem)
    sizes = [len(each.desired.t) for each in found]
    assert found[-1] is problem
    assert SAMPLES <= sizes[0] <= 2 * SAMPLES
    assert all(1.5 < fine / coarse < 1.1 * RATIO for coarse, fine in pairwise(sizes))
    assert grids(pose(cobra(500)))[0].desired.t.size == 501


def test_a_step_of_the_rate_keeps_its_sample_and_its_sides(cobra, pose):
    motion = cobra(1002)  # the cab's rate steps at sample 501, which no stride of 7 meets
    coarse = coarsen(pose(motion, requested=motion), 7)
    kept = coarse.desired
    k = int(np.flatnonzero(kept.t == motion.t[501])[0])
    assert kept.rate_end[k - 1, 2] == motion.rate_end[500, 2]
    assert kept.rate_start[k, 2] == motion.rate_start[501, 2]
    np.testing.assert_array_equal(kept.t[[0, -1]], motion.t[[0, -1]])
    np.testing.assert_array_equal(coarse.reference.rate_start, kept.rate_start)


def test_refining_keeps_samples_and_pins(cobra, pose):
    problem = pose(cobra(100), control="per-joint", held=np.array([False, True, False]))
    coarse = coarsen(problem, 5)
    rough, grid = Transcription(coarse), Transcription(problem)
    x = rough.desired + 0.1 * np.random.default_rng(2).normal(size=rough.desired.shape)
    x[rough.pinned] = rough.desired[rough.pinned]
    fine = refine(x, coarse, grid)
    np.testing.assert_allclose(fine[::5], x, atol=1e-14)
    np.testing.assert_array_equal(fine[grid.pinned], grid.desired[grid.pinned])
    # between samples the deviation is linear
    off = fine - grid.desired
    np.testing.assert_allclose(off[2::5], 0.6 * off[:-5:5] + 0.4 * off[5::5], atol=1e-13)


@pytest.mark.parametrize(
    "options", [{}, {"control": "per-joint"}, {"axes": "seat", "r1": (2, 2, 2)}]
)
def test_the_best_branch_on_the_fine_grid_is_where_one_grid_alone_ends(cobra, pose, options):
    problem = pose(cobra(3000), 0.2, **options)
    search = Search(500)
    solution = find_optimum(problem, search)
    assert solution.converged
    grid = Transcription(problem)
    start = np.hstack([solution.modified.angle, solution.control])
    alone = minimise(grid, start + 1e-3 * ~grid.pinned, tolerance=TOLERANCE)
    assert solution.cost == pytest.approx(alone.cost, rel=1e-12)
    on_coarse = find_optimum(grids(problem)[0], Search(500))
    assert solution.cost == pytest.approx(on_coarse.cost, rel=1e-4)


def test_no_branch_is_lost_on_the_way(cobra, pose):
    # Small weights: worse local minima beside the best one.
    costs = [find_optimum(pose(cobra(n), 0.05), Search(3000)).cost for n in (700, 1400)]
    assert costs[0] == pytest.approx(costs[1], rel=1e-4)
    held = replace(pose(cobra(1400), 0.05), ends="match-start")
    assert find_optimum(held, Search(3000)).cost >= costs[1] * (1.0 - 1e-9)
