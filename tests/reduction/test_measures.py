"""Measures that a budget is set on: the metrics themselves, with true derivatives."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.chain import seat_rotation
from des_cli.kinematics.response import respond
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.reduction.measures import measure_of
from des_cli.reduction.transcription import Transcription

BUDGET = 0.3
INTEGRALS = [
    "joint_deviation_relative",
    "joint_deviation_relative_squared",
    "mean_square_one_minus_p",
    "seat_rate_deviation_relative",
    "seat_g_deviation_relative",
    "seat_g_rms_error_g",
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


@pytest.mark.parametrize("name", INTEGRALS)
def test_at_its_budget_a_measure_is_one(name, grid, x):
    value = metric(name, grid, x)
    at_budget = measure_of(grid, name, value)
    assert at_budget.spent(x) == pytest.approx(1.0, rel=1e-9)
    assert at_budget.expand(x).cost == pytest.approx(1.0, rel=1e-9)
    assert at_budget.value(grid.desired) == pytest.approx(0.0, abs=1e-20)
    assert measure_of(grid, name, 2.0 * value).value(x) < 0.6


@pytest.mark.parametrize("name", [*INTEGRALS, "attitude_error_max_deg"])
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
        bend = (ahead - behind) / (2.0 * h)
        found = (expansion.hessian @ move[:, :, None])[:, :, 0]
        if expansion.across is not None:
            found[:-1] += (expansion.across @ move[1:, :, None])[:, :, 0]
            found[1:] += (np.swapaxes(expansion.across, 1, 2) @ move[:-1, :, None])[:, :, 0]
        np.testing.assert_allclose(found, bend, rtol=1e-5, atol=1e-6 * np.abs(bend).max())


@pytest.mark.parametrize("name", ["seat_rate_deviation_relative", "attitude_error_max_deg"])
def test_what_bends_a_hessian_is_exact(name, grid, x):
    # Where a measure tells its curvature, the sum is the exact Hessian anywhere.
    measure = measure_of(grid, name, BUDGET)
    expansion = measure.expand(x)
    assert expansion.bend is not None
    move, h = np.random.default_rng(7).normal(size=x.shape), 1e-5
    ahead, behind = (measure.expand(x + s * h * move).gradient for s in (1, -1))
    bend = (ahead - behind) / (2.0 * h)
    found = ((expansion.hessian + expansion.bend) @ move[:, :, None])[:, :, 0]
    np.testing.assert_allclose(found, bend, rtol=1e-5, atol=1e-6 * np.abs(bend).max())


def test_the_largest_attitude_error_is_what_is_spent(grid, x):
    made, wanted = (seat_rotation(grid.problem.chain, each[:, :3]) for each in (x, grid.desired))
    cosine = 0.5 * (np.einsum("kij,kij->k", made, wanted) - 1.0)
    angle = np.arccos(np.clip(cosine, -1.0, 1.0))
    measure = measure_of(grid, "attitude_error_max_deg", np.degrees(angle.max()))
    assert measure.spent(x) == pytest.approx(1.0, rel=1e-9)
    # Priced is the mean of the eighth power of the chord.
    share = np.sin(angle / 2.0) / np.sin(angle.max() / 2.0)
    mean = np.trapezoid(share**8, grid.problem.desired.t) / np.ptp(grid.problem.desired.t)
    assert measure.value(x) == pytest.approx(mean, rel=1e-9)
