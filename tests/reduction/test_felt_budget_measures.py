"""Measures of what accelerations make the seat feel: by definition and by differences."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.kinematics.response import respond
from des_cli.model.arrays import Floats
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.metric import UNFELT_ANGULAR_ACCELERATION
from des_cli.model.motion import Motion, Shortfall
from des_cli.reduction.felt_budget_measures import (
    IntervalDeviation,
    SeatAccelerationDeviation,
    SeatAccelerationRows,
    SeatAccelerationSize,
    SeatGDeviation,
)
from des_cli.reduction.transcription import Transcription
from tests.support.differences import along
from tests.support.seat_turning import angular_acceleration

KINDS = pytest.mark.parametrize("kind", [SeatGDeviation, SeatAccelerationDeviation])


@pytest.fixture(params=["scalar", "per-joint"])
def grid(
    request: pytest.FixtureRequest, wave: Callable[..., Motion], pose: Callable[..., Any]
) -> Transcription:
    motion = wave([[0.5, 0.2, 0.1], [0.2, 0.3, 0.1], [0.2, -0.2, 0.15]], intervals=15)
    return Transcription(pose(motion, control=request.param))


@pytest.fixture
def x(grid: Transcription) -> Floats:
    return grid.desired + 0.1 * np.random.default_rng(4).normal(size=grid.desired.shape)


def test_the_seat_feels_gravity_and_the_centripetal_acceleration(grid: Transcription) -> None:
    measure, rng = SeatGDeviation(grid, 1.0, relative=False), np.random.default_rng(1)
    angle, still = rng.uniform(-2.0, 2.0, (20, 3)), np.zeros((20, 3))
    np.testing.assert_allclose(
        np.linalg.norm(measure.vector(angle, still, still), axis=1), 1.0, rtol=1e-12
    )
    turning = np.tile([1.5, 0.0, 0.0], (20, 1))
    horizontal = (
        np.hypot(*grid.problem.chain.transform(angle)[:, :2, 3].T) * 1.5**2 / (32.2 * 0.3048)
    )
    np.testing.assert_allclose(
        np.linalg.norm(measure.vector(angle, turning, still), axis=1),
        np.hypot(horizontal, 1.0),
        rtol=1e-12,
    )


def test_an_arm_that_spins_up_turns_the_seat_about_the_vertical(grid: Transcription) -> None:
    measure = SeatAccelerationDeviation(grid, 1.0, relative=False)
    angle = np.random.default_rng(1).uniform(-2.0, 2.0, (20, 3))
    rate, acceleration = np.tile([2.0, 0.0, 0.0], (20, 1)), np.tile([0.6, 0.0, 0.0], (20, 1))
    found = np.linalg.norm(measure.vector(angle, rate, acceleration), axis=1)
    np.testing.assert_allclose(found, 0.6, rtol=1e-12)


@KINDS
def test_derivatives_of_the_vector(kind: type[IntervalDeviation], grid: Transcription) -> None:
    measure, rng = kind(grid, 1.0, relative=False), np.random.default_rng(2)
    state = rng.uniform(-1.0, 1.0, (3, 8, 3))
    for index, slope in enumerate(measure.derivatives(*state)):
        move = np.zeros_like(state)
        move[index] = rng.normal(size=(8, 3))
        expected = along(lambda each: measure.vector(*each), state, move)
        np.testing.assert_allclose(
            (slope @ move[index][:, :, None])[..., 0], expected, rtol=1e-8, atol=1e-9
        )


@KINDS
@pytest.mark.parametrize("relative", [False, True])
def test_a_shortfall_is_asked_for_beside_the_reference(
    kind: type[IntervalDeviation], relative: bool, grid: Transcription, x: Floats
) -> None:
    """What an iterate has more than the reference, asked for, is missed by the latter alone."""
    wanted, made = grid.problem.reference, grid.motion(x)
    nothing = np.zeros((15, 2, 3))
    g = respond(DES, Seat(), made).seat_g - respond(DES, Seat(), wanted).seat_g
    turning = angular_acceleration(made) - angular_acceleration(wanted)
    missing = Shortfall(nothing, turning, g, np.zeros((16, 3)))
    measure = kind(Transcription(replace(grid.problem, shortfall=missing)), 0.3, relative=relative)
    assert measure.value(x) == pytest.approx(0.0, abs=1e-15)
    half, kinds = 0.5 * wanted.step, (g, turning)
    off = kinds[kind is SeatAccelerationDeviation]
    size = wanted.step.sum()
    if relative:
        asked = respond(DES, Seat(), made).seat_g if off is g else angular_acceleration(made)
        size = half @ np.sum(asked**2, axis=(1, 2))
    expected = half @ np.sum(off**2, axis=(1, 2)) / (0.3**2 * size)
    assert measure.value(grid.desired) == pytest.approx(expected, rel=1e-8)


def test_the_ratio_of_the_peaks_bounds_both_ends_of_every_interval(
    grid: Transcription, x: Floats
) -> None:
    before, after = (
        np.linalg.norm(angular_acceleration(motion), axis=-1)
        for motion in (grid.problem.reference, grid.motion(x))
    )
    rows = SeatAccelerationRows(grid, 1.1)
    expected = (after / (1.1 * before.max())) ** 2
    np.testing.assert_allclose(rows.value(x), expected, rtol=1e-8)
    move = np.random.default_rng(6).normal(size=x.shape)
    left, right = rows.jacobian(x)
    found = left @ move[:-1, :, None] + right @ move[1:, :, None]
    np.testing.assert_allclose(found[..., 0], along(rows.value, x, move), rtol=1e-8, atol=1e-8)


def test_ratios_are_to_what_nobody_feels_at_the_least(grid: Transcription, x: Floats) -> None:
    wanted = grid.problem.desired
    standing = Motion(wanted.t, np.tile([0.1, -0.4, 0.3], (16, 1)), *np.zeros((2, 15, 3)))
    grid = Transcription(replace(grid.problem, requested=standing))
    turning = np.linalg.norm(angular_acceleration(grid.motion(x)), axis=-1)
    rms = np.sqrt(0.5 * wanted.step @ np.sum(turning**2, axis=1) / wanted.step.sum())
    unfelt = UNFELT_ANGULAR_ACCELERATION
    found = SeatAccelerationSize(grid, 3.0).value(x)
    assert np.sqrt(found) == pytest.approx(rms / unfelt / 3.0, rel=1e-8)
    found = SeatAccelerationRows(grid, 2.0).value(x)
    np.testing.assert_allclose(np.sqrt(found), turning / unfelt / 2.0, rtol=1e-8)
