"""Measures that a budget is set on: the metrics themselves, with true derivatives."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from des_cli.kinematics.chain import seat_rotation
from des_cli.kinematics.response import respond
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.reduction.measures import MEASURES, AttitudeRows
from des_cli.reduction.transcription import Transcription

BUDGET = 0.3


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
    wanted, made = grid.problem.desired, grid.motion(x)
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
    felt = square(after.seat_g - before.seat_g)
    relative = name == "seat_g_deviation_relative"
    return np.sqrt(felt / (square(before.seat_g) if relative else step.sum()))


@pytest.mark.parametrize("name", list(MEASURES))
def test_at_its_budget_a_measure_is_one(name, grid, x):
    value = metric(name, grid, x)
    at_budget = MEASURES[name](grid, value, DES.gravity)
    assert at_budget.value(x) == pytest.approx(1.0, rel=1e-9)
    assert at_budget.expand(x).cost == pytest.approx(1.0, rel=1e-9)
    assert at_budget.value(grid.desired) == pytest.approx(0.0, abs=1e-20)
    assert MEASURES[name](grid, 2.0 * value, DES.gravity).value(x) < 0.6


@pytest.mark.parametrize("name", list(MEASURES))
def test_gradient_and_hessian(name, grid, x):
    measure = MEASURES[name](grid, BUDGET, DES.gravity)
    rng = np.random.default_rng(6)
    expansion = measure.expand(x)
    for _ in range(4):
        move, h = rng.normal(size=x.shape), 1e-5
        ahead, behind = x + h * move, x - h * move
        slope = (measure.value(ahead) - measure.value(behind)) / (2.0 * h)
        assert np.sum(expansion.gradient * move) == pytest.approx(slope, rel=1e-6)
    # At the desired motion nothing is missed: there Gauss and Newton's Hessian is exact.
    expansion = measure.expand(grid.desired)
    for _ in range(4):
        move, h = rng.normal(size=x.shape), 1e-5
        ahead, behind = (measure.expand(grid.desired + s * h * move).gradient for s in (1, -1))
        bend = (ahead - behind) / (2.0 * h)
        found = (expansion.hessian @ move[:, :, None])[:, :, 0]
        if expansion.across is not None:
            found[:-1] += (expansion.across @ move[1:, :, None])[:, :, 0]
            found[1:] += (np.swapaxes(expansion.across, 1, 2) @ move[:-1, :, None])[:, :, 0]
        np.testing.assert_allclose(found, bend, rtol=1e-5, atol=1e-6 * np.abs(bend).max())


def test_what_bends_a_hessian_is_exact(grid, x):
    # Where a measure tells its curvature, the sum is the exact Hessian anywhere.
    measure = MEASURES["seat_rate_deviation_relative"](grid, BUDGET, DES.gravity)
    expansion = measure.expand(x)
    assert expansion.bend is not None
    move, h = np.random.default_rng(7).normal(size=x.shape), 1e-5
    ahead, behind = (measure.expand(x + s * h * move).gradient for s in (1, -1))
    bend = (ahead - behind) / (2.0 * h)
    found = ((expansion.hessian + expansion.bend) @ move[:, :, None])[:, :, 0]
    np.testing.assert_allclose(found, bend, rtol=1e-5, atol=1e-6 * np.abs(bend).max())


def test_attitude_rows(grid, x):
    frames = SimpleNamespace(
        made=seat_rotation(grid.problem.chain, x[:, :3]),
        wanted=seat_rotation(grid.problem.chain, grid.desired[:, :3]),
    )
    cosine = 0.5 * (np.einsum("kij,kij->k", frames.made, frames.wanted) - 1.0)
    angle = np.arccos(np.clip(cosine, -1.0, 1.0))
    largest = angle.max()
    rows = AttitudeRows(grid, largest)
    value = rows.value(x)[:, 0]
    assert value.max() == pytest.approx(1.0, rel=1e-9)
    np.testing.assert_allclose(value, (np.sin(angle / 2) / np.sin(largest / 2)) ** 2, rtol=1e-6)
    rng = np.random.default_rng(8)
    move, multiplier, h = rng.normal(size=x.shape), rng.normal(size=(len(x), 1)), 1e-5
    slope = (rows.value(x + h * move) - rows.value(x - h * move))[:, 0] / (2.0 * h)
    found = (rows.jacobian(x)[0] @ move[:, :, None])[:, 0, 0]
    np.testing.assert_allclose(found, slope, rtol=1e-6, atol=1e-8)
    ahead, behind = (multiplier * rows.jacobian(x + s * h * move)[0][:, 0] for s in (1, -1))
    bent = (rows.curvature(x, multiplier) @ move[:, :, None])[:, :, 0]
    np.testing.assert_allclose(bent, (ahead - behind) / (2.0 * h), rtol=1e-5, atol=1e-6)
