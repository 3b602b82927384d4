"""The constant factor of the baselines, and the study's sweep beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from des_cli.reduction.baseline import compare, joint_deviation, weighted_energy
from des_cli.reduction.report_sweep import sweep
from des_cli.reduction.transcription import Transcription


def constant(problem, p):
    grid = Transcription(problem)
    return grid.motion(grid.follow(np.full((grid.n, problem.controls), p)))


@pytest.mark.parametrize("axes", ["report", "seat"])
@pytest.mark.parametrize("p", [1e-3, 0.05, 0.3, 0.7, 0.999, 1.0 - 1e-7])
def test_the_constant_factor_of_a_solution_that_is_one(cobra, pose, axes, p):
    problem = pose(cobra(200), axes=axes, r1=(1, 2, 0.5))
    solution = replace(sweep(problem), modified=constant(problem, p))
    found = compare(problem, solution)
    energy = weighted_energy(problem, solution.modified)
    made = constant(problem, found.constant_p)
    assert weighted_energy(problem, made) == pytest.approx(energy, rel=1e-11)
    assert found.constant_deviation == pytest.approx(
        joint_deviation(problem.desired, made), rel=1e-12
    )
    low, high = max(0.0, found.constant_p - 1e-3), min(1.0, found.constant_p + 1e-3)
    root = brentq(
        lambda q: weighted_energy(problem, constant(problem, q)) - energy, low, high, xtol=1e-15
    )
    assert found.constant_p == pytest.approx(root, rel=1e-9)


def test_a_motion_without_reduction_has_the_factor_one(cobra, pose):
    problem = pose(cobra(100))
    worse = replace(sweep(problem), modified=constant(problem, 1.1))
    assert compare(problem, worse).constant_p == 1.0
    still = replace(sweep(problem), modified=constant(problem, 0.0))
    assert compare(problem, still).constant_p == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("control", ["scalar", "per-joint"])
def test_the_sweep_beside_it_is_the_studys_with_one_factor(cobra, pose, control):
    problem = pose(cobra(200), 1.0, control=control)
    found = compare(problem, sweep(problem))
    swept = sweep(pose(cobra(200), 1.0))
    before, after = (weighted_energy(problem, m) for m in (problem.desired, swept.modified))
    assert found.sweep_reduction == pytest.approx(1.0 - after / before, rel=1e-12)
    assert found.sweep_deviation == pytest.approx(
        joint_deviation(problem.desired, swept.modified), rel=1e-12
    )
    ran_away = pose(cobra(200), 1e-9, control=control)
    assert compare(ran_away, sweep(problem)).sweep_reduction is None
