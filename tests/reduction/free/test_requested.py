"""What is asked of the seat at points: the projection of a rough record."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.response import respond_on
from des_cli.model.motion import Motion
from des_cli.reduction.free.requested import Requested, is_rough
from des_cli.reduction.free.unknowns import SEAT_VARIABLES
from des_cli.reduction.free.windows import Windows
from des_cli.solver.spline import GAUSS, SplineGrid
from tests.support.free_motions import task_of

GRID = SplineGrid(0.0, 0.05, 80)
WINDOWS = Windows(GRID, SEAT_VARIABLES)


def motion_of(t, noise, seed=3):
    """Slow waves of all joints, with noise in the rates."""
    rng = np.random.default_rng(seed)
    rate = np.stack([0.6 + 0.1 * np.sin(t), 0.3 * np.cos(t), 0.2 * np.sin(2.0 * t)], axis=1)
    rate = rate + noise * rng.normal(size=rate.shape)
    increment = 0.5 * np.diff(t)[:, None] * (rate[1:] + rate[:-1])
    angle = np.vstack([np.zeros(3), np.cumsum(increment, axis=0)])
    return Motion(t, angle, rate[:-1], rate[1:])


def projected(motion):
    task = task_of(motion, {})
    response = respond_on(task.chain, task.machine.gravity, motion)
    return Requested.projected(response, motion.t, WINDOWS), response


@pytest.mark.parametrize("rows", [401, 257, 161], ids=["finer", "uneven", "half a knot"])
def test_squares_of_what_is_linear_between_knots_are_those_at_all_samples(rows):
    t = np.linspace(0.0, 4.0, rows)
    motion = motion_of(t, 0.3)
    requested, response = projected(motion)
    # a W with corners at the knots, and its values at the points
    rng = np.random.default_rng(4)
    ends = rng.normal(size=(3, GRID.intervals, 2))
    points = ends[:, :, :1] + np.array(GAUSS) * (ends[:, :, 1:] - ends[:, :, :1])
    at_points = np.concatenate(
        [
            np.swapaxes(points, 1, 2)[:, :, first:last].reshape(3, -1)
            for first, last in WINDOWS.chunks()
        ],
        axis=1,
    )
    weight = 0.5 * np.diff(t)
    cross = 0.0
    for side, times, shift in ((0, t[:-1], 1e-9), (1, t[1:], -1e-9)):
        k = np.clip(((times + shift) / GRID.step).astype(int), 0, GRID.intervals - 1)
        u = times / GRID.step - k
        value = ends[:, k, 0] + u * (ends[:, k, 1] - ends[:, k, 0])
        cross += np.sum(weight * value * response.seat_rate[:, side].T)
    half = 0.5 * GRID.step
    assert half * np.sum(at_points * requested.values["rate"]) == pytest.approx(cross, rel=1e-9)
    square = np.sum(weight[:, None, None] * response.seat_rate**2)
    assert half * requested.square["rate"] == pytest.approx(square, rel=1e-12)
    left = requested.square["rate"] - np.sum(requested.values["rate"] ** 2)
    assert requested.floor["rate"] == pytest.approx(left, rel=1e-12)


@pytest.mark.parametrize("rows", [401, 257, 161])
def test_a_rough_record_is_told_from_a_maneuver(rows):
    t = np.linspace(0.0, 4.0, rows)
    for noise in (0.3, 0.0):
        _, response = projected(motion_of(t, noise))
        assert is_rough(response, t, GRID.step) == (noise > 0.0)
        # what lies farther apart than the knots, these hold
        assert not is_rough(response, t, 0.5 * (t[1] - t[0]))


@pytest.mark.parametrize("length", [1, 3, 159])
def test_one_rough_place_is_found_in_pieces(length, monkeypatch):
    """Wherever it is, at the ends and where pieces join too."""
    monkeypatch.setattr("des_cli.model.sides.PIECE", length)
    t = np.linspace(0.0, 4.0, 161)
    _, smooth = projected(motion_of(t, 0.0))
    for at in (1, 2, 3, 80, 158, 159):
        rate = smooth.seat_rate.copy()
        rate[at, 0] += 0.8
        rate[at - 1, 1] += 0.8
        assert is_rough(replace(smooth, seat_rate=rate), t, GRID.step)


def test_rows_that_are_longer_than_the_knots_leave_no_interval_without_any():
    t = np.linspace(0.0, 4.0, 21)
    requested, _ = projected(motion_of(t, 0.0))
    assert np.all(np.any(requested.values["rate"] != 0.0, axis=0))
