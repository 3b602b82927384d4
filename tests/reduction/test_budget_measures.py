"""Measures that a budget is set on: the metrics themselves, with true derivatives."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.response import respond
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.reduction.budget_measures import measure_of
from des_cli.reduction.transcription import Transcription
from tests.support.seat_turning import angular_acceleration

BUDGET = 0.3
INTEGRALS = [
    "joint_deviation_relative",
    "joint_deviation_relative_squared",
    "mean_square_one_minus_p",
    "seat_rate_deviation_relative",
    "seat_g_deviation_relative",
    "seat_g_rms_error_g",
    "seat_angular_acceleration_deviation_relative",
    "seat_angular_acceleration_rms_error_rad_s2",
]


@pytest.fixture(params=["scalar", "per-joint"])
def grid(request, wave, pose):
    motion = wave([[0.5, 0.2, 0.1], [0.2, 0.3, 0.1], [0.2, -0.2, 0.15]], intervals=15)
    return Transcription(pose(motion, control=request.param))


@pytest.fixture
def x(grid):
    return grid.desired + 0.1 * np.random.default_rng(4).normal(size=grid.desired.shape)


def trapezoids(step, sides):
    return float(np.sum(0.5 * step * np.sum(sides, axis=1)))


def metric(name, grid, x):
    """A metric by its definition, on sides; factors and angles as they stand in x."""
    wanted, made = grid.problem.reference, grid.motion(x)
    step = wanted.step
    before, after = (respond(DES, Seat(), each) for each in (wanted, made))

    def square(values):
        return trapezoids(step, np.sum(values**2, axis=-1))

    if name.startswith("joint_deviation"):
        squared = square(made.angle_sides - wanted.angle_sides) / square(wanted.angle_sides)
        return squared if name.endswith("squared") else np.sqrt(squared)
    if name == "mean_square_one_minus_p":
        idle = 1.0 - np.stack([x[:-1, 3:], x[1:, 3:]], axis=1)
        return square(idle) / step.sum() / idle.shape[-1]
    if name == "seat_rate_deviation_relative":
        return np.sqrt(square(after.seat_rate - before.seat_rate) / square(before.seat_rate))
    before, after = before.seat_g, after.seat_g
    if name.startswith("seat_angular_acceleration"):
        before, after = angular_acceleration(wanted), angular_acceleration(made)
    relative = name.endswith("relative")
    return np.sqrt(square(after - before) / (square(before) if relative else step.sum()))


@pytest.mark.parametrize("name", INTEGRALS)
def test_at_its_budget_a_measure_is_one(name, grid, x):
    value = metric(name, grid, x)
    at_budget = measure_of(grid, name, value)
    assert at_budget.value(x) == pytest.approx(1.0, rel=1e-8)
    assert at_budget.expand(x).cost == pytest.approx(1.0, rel=1e-8)
    assert at_budget.value(grid.desired) == pytest.approx(0.0, abs=1e-20)
    assert measure_of(grid, name, 2.0 * value).value(x) < 0.6


@pytest.mark.parametrize("name", INTEGRALS)
def test_gradient(name, grid, x):
    measure = measure_of(grid, name, BUDGET)
    rng = np.random.default_rng(6)
    expansion = measure.expand(x)
    for _ in range(4):
        move, h = rng.normal(size=x.shape), 1e-5
        ahead, behind = x + h * move, x - h * move
        slope = (measure.value(ahead) - measure.value(behind)) / (2.0 * h)
        assert np.sum(expansion.gradient * move) == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize("name", INTEGRALS)
def test_where_nothing_is_missed_the_gauss_newton_hessian_is_exact(name, grid, x):
    measure = measure_of(grid, name, BUDGET)
    rng = np.random.default_rng(6)
    expansion = measure.expand(grid.desired)
    for _ in range(4):
        move, h = rng.normal(size=x.shape), 1e-5
        ahead, behind = (measure.expand(grid.desired + s * h * move).gradient for s in (1, -1))
        second = (ahead - behind) / (2.0 * h)
        found = (expansion.hessian @ move[:, :, None])[:, :, 0]
        if expansion.across is not None:
            found[:-1] += (expansion.across @ move[1:, :, None])[:, :, 0]
            found[1:] += (np.swapaxes(expansion.across, 1, 2) @ move[:-1, :, None])[:, :, 0]
        np.testing.assert_allclose(found, second, rtol=1e-5, atol=1e-6 * np.abs(second).max())


def test_what_bends_a_hessian_is_exact(grid, x):
    # Where a measure tells its curvature, the sum is the exact Hessian anywhere.
    measure = measure_of(grid, "seat_rate_deviation_relative", BUDGET)
    expansion = measure.expand(x)
    assert expansion.curvature is not None
    move, h = np.random.default_rng(7).normal(size=x.shape), 1e-5
    ahead, behind = (measure.expand(x + s * h * move).gradient for s in (1, -1))
    second = (ahead - behind) / (2.0 * h)
    found = ((expansion.hessian + expansion.curvature) @ move[:, :, None])[:, :, 0]
    np.testing.assert_allclose(found, second, rtol=1e-5, atol=1e-6 * np.abs(second).max())


@pytest.mark.parametrize("name", [n for n in INTEGRALS if not n.startswith("mean")])
def test_a_reference_of_its_own_whose_rates_step(name, grid, x, pose, wave):
    # What the profile asks for is not what the machine starts from.
    requested = wave([[0.5, 0.25, 0.1], [0.25, 0.3, 0.1], [0.2, -0.2, 0.1]], intervals=15)
    start, end = requested.rate_start.copy(), requested.rate_end.copy()
    start[7:] += 0.3
    end[7:] += 0.3
    requested = Motion(requested.t, requested.angle, start, end)
    grid = Transcription(replace(grid.problem, requested=requested))
    value = metric(name, grid, x)
    measure = measure_of(grid, name, value)
    assert measure.value(x) == pytest.approx(1.0, rel=1e-8)
    assert measure.expand(x).cost == pytest.approx(1.0, rel=1e-8)
    assert measure.value(grid.desired) > 1e-4


def sizes(grid, x):
    """|dW/dt| on sides, of the reference and of an iterate."""
    motions = (grid.problem.reference, grid.motion(x))
    return [np.linalg.norm(angular_acceleration(motion), axis=-1) for motion in motions]


def test_the_ratio_of_the_root_mean_squares(grid, x):
    step = grid.problem.reference.step
    before, after = (trapezoids(step, size**2) for size in sizes(grid, x))
    name = "seat_angular_acceleration_rms_ratio"
    measure = measure_of(grid, name, np.sqrt(after / before))
    assert measure.value(x) == pytest.approx(1.0, rel=1e-8)
    assert measure.value(grid.desired) == pytest.approx(before / after, rel=1e-8)
    move, h = np.random.default_rng(6).normal(size=x.shape), 1e-5
    slope = (measure.value(x + h * move) - measure.value(x - h * move)) / (2.0 * h)
    assert np.sum(measure.expand(x).gradient * move) == pytest.approx(slope, rel=1e-6)
