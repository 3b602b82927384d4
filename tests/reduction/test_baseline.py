"""The constant factor of the baselines, and the study's sweep beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from des_cli.kinematics.chain import chain_of
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.reduction.baseline import (
    compare,
    joint_deviation,
    objective_reduction,
    weighted_energy,
)
from des_cli.reduction.study_law import sweep
from des_cli.reduction.transcription import Transcription


def constant(problem, p):
    grid = Transcription(problem)
    return grid.motion(grid.follow(np.full((grid.n, problem.controls), p)))


@pytest.mark.parametrize("axes", ["report", "seat"])
@pytest.mark.parametrize("p", [1e-3, 0.05, 0.3, 0.7, 0.999, 1.0 - 1e-7])
def test_the_constant_factor_of_a_solution_that_is_one(cobra, pose, axes, p):
    problem = pose(cobra(200), axes=axes, r1=(1, 2, 0.5))
    modified = constant(problem, p)
    found = compare(problem, modified)
    assert objective_reduction(problem, modified) == found.reduction
    energy = weighted_energy(problem, modified)
    before = weighted_energy(problem, problem.desired)
    assert found.reduction == pytest.approx(1.0 - energy / before, rel=1e-12)
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
    worse = compare(problem, constant(problem, 1.1))
    assert worse.constant_p == 1.0
    assert worse.reduction < 0.0
    still = compare(problem, constant(problem, 0.0))
    assert still.constant_p == pytest.approx(0.0, abs=1e-12)
    assert still.reduction == pytest.approx(1.0)


@pytest.mark.parametrize("control", ["scalar", "per-joint"])
def test_the_sweep_beside_it_is_the_studys_with_one_factor(cobra, pose, control):
    problem = pose(cobra(200), 1.0, control=control)
    found = compare(problem, sweep(problem).modified)
    swept = sweep(pose(cobra(200), 1.0))
    before, after = (weighted_energy(problem, m) for m in (problem.desired, swept.modified))
    assert found.sweep_reduction == pytest.approx(1.0 - after / before, rel=1e-12)
    assert found.sweep_deviation == pytest.approx(
        joint_deviation(problem.desired, swept.modified), rel=1e-12
    )
    ran_away = pose(cobra(200), 1e-9, control=control)
    assert compare(ran_away, sweep(problem).modified).sweep_reduction is None


def test_reductions_are_relative_to_what_the_profile_asks_for(cobra, pose):
    # The executable motion is slower than the record here: what it loses is reduction too.
    record = cobra(200)
    desired = constant(pose(record), 0.9)
    alone, beside = pose(desired), pose(desired, requested=record)
    modified = constant(alone, 0.8)
    energies = [weighted_energy(alone, motion) for motion in (record, desired, modified)]
    assert energies[0] > 1.1 * energies[1]
    for problem, before in ((beside, energies[0]), (alone, energies[1])):
        found = compare(problem, modified)
        assert found.reduction == pytest.approx(1.0 - energies[2] / before, rel=1e-12)
        swept = weighted_energy(alone, sweep(problem).modified)
        assert found.sweep_reduction == pytest.approx(1.0 - swept / before, rel=1e-12)


def test_a_turned_seat_is_weighed_where_it_is(cobra, pose):
    # Weighed along the seat's y alone, another seat sees another part of the same vector.
    problem = pose(cobra(200), axes="seat", r1=(0, 2, 0))
    turned = chain_of(DES, Seat(yaw=0.3, pitch=0.1))
    modified = constant(problem, 0.7)
    before = weighted_energy(problem, problem.desired)
    after = weighted_energy(replace(problem, chain=turned), modified)
    found = compare(problem, modified, turned)
    assert found.reduction == pytest.approx(1.0 - after / before, rel=1e-12)
    assert abs(found.reduction - compare(problem, modified).reduction) > 1e-3
