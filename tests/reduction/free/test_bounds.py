"""Bounds at points: where they reach one, by what is felt on the table."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from des_cli.kinematics.chain import seat_rotation
from des_cli.kinematics.response import respond_on
from des_cli.kinematics.twist import SeatMotion, seat_forms
from des_cli.model.arrays import Floats
from des_cli.model.machine import OccupantBounds, Seat
from des_cli.model.machines import DES
from des_cli.model.metric import ANGULAR_ACCELERATION_PEAK_RATIO, ATTITUDE_ERROR, Budget
from des_cli.model.motion import Motion, Shortfall
from des_cli.reduction.free.bounds import occupant_bounds, point_bound
from des_cli.reduction.free.local_bounds import AttitudeBound, NormBound
from des_cli.reduction.free.unknowns import Unknowns
from des_cli.solver.spline import SplineGrid
from tests.support.free_motions import program_of, smooth, task_of

INTERVALS = 40
DESIRED = smooth(4000)
GRID = SplineGrid(0.0, 0.2, 20)
NONE = np.zeros((3, 0))
EVERYWHERE = slice(None)
PEAK = Budget(ANGULAR_ACCELERATION_PEAK_RATIO, 1.5)


def seats(m: int) -> SeatMotion:
    """Random motions of the seat at points."""
    z = np.random.default_rng(3).uniform(-1.0, 1.0, (8, m))
    return seat_forms(task_of(DESIRED, {}).chain, DES.gravity).at(z)


def g_of(seat: SeatMotion) -> Floats:
    """The pilot's G: the seat's z points down, and Gz to the head counts upwards."""
    return np.asarray(seat.force * np.array([[1.0], [1.0], [-1.0]]) / (32.2 * 0.3048))


def test_occupant_bounds_are_at_one_where_the_felt_is_at_its_bound() -> None:
    occupant = OccupantBounds(
        gx=(-1.5, 2.0), gy=(-3.0, 0.7), gz=(0.2, 1.4), g_onset=0.6, angular_acceleration=0.9
    )
    task = task_of(DESIRED, {}, replace(DES, occupant=occupant))
    program = program_of(task, INTERVALS)
    local = program.values(np.zeros(program.size)).local
    felt = respond_on(task.chain, DES.gravity, DESIRED)
    components, norm, onset = np.split(local, [6 * 2 * INTERVALS, 7 * 2 * INTERVALS])
    g = felt.seat_g.reshape(-1, 3)
    # rows in the order gx most, gx least, gy most, ...
    for row, (axis, bound, sign) in enumerate(
        [(0, 2.0, 1), (0, -1.5, -1), (1, 0.7, 1), (1, -3.0, -1), (2, 1.4, 1), (2, 0.2, -1)]
    ):
        expected = 1.0 + np.max(sign * (g[:, axis] - bound)) / max(abs(bound), 1.0)
        found = np.max(components.reshape(6, -1)[row])
        assert found == pytest.approx(expected, abs=0.02)
    length = np.linalg.norm(felt.seat_angular_acceleration, axis=-1).max()
    assert np.sqrt(norm.max()) == pytest.approx(length / 0.9, rel=0.02)
    rise = np.diff(felt.seat_g.mean(axis=1), axis=0) / DESIRED.step[1:, None]
    assert onset.max() == pytest.approx(np.abs(rise).max() / 0.6, rel=0.03)
    assert len(onset) == 6 * INTERVALS


@pytest.mark.parametrize(
    ("bounds", "rows"),
    [
        ({}, []),
        ({"gx": (-1.0, 2.0)}, [2]),
        ({"gx": (-np.inf, 2.0), "gz": (0.1, np.inf)}, [2]),
        ({"angular_acceleration": 0.4}, [2]),
        ({"g_onset": 0.4}, [6]),
        ({"gy": (-1.0, 1.0), "angular_acceleration": 0.4, "g_onset": 0.4}, [2, 2, 6]),
    ],
)
def test_what_is_not_bounded_has_no_rows(bounds: dict[str, Any], rows: list[int]) -> None:
    found = occupant_bounds(OccupantBounds(**bounds), GRID, 0.0)
    assert [bound.rows for bound in found] == rows


@pytest.mark.parametrize("room", [0.0, 0.02])
def test_room_is_left_on_the_inner_side_of_every_bound(room: float) -> None:
    occupant = OccupantBounds(gx=(-3.0, 0.4), gz=(0.2, 2.5), angular_acceleration=0.9, g_onset=0.6)
    components, length, onset = occupant_bounds(occupant, GRID, room)
    seat = seats(10)
    g, ends = g_of(seat), [(0, 0.4, 1), (0, -3.0, -1), (2, 2.5, 1), (2, 0.2, -1)]
    for row, (axis, bound, sign) in zip(
        components.value(seat, NONE, EVERYWHERE), ends, strict=True
    ):
        scale = max(abs(bound), 1.0)
        drawn_in = bound - sign * room * scale
        np.testing.assert_allclose(row, 1.0 + sign * (g[axis] - drawn_in) / scale, atol=1e-12)
    near, far = np.split(seat.twist_rate[:3], 2, axis=1)
    at_start = near - 0.5 * (np.sqrt(3.0) - 1.0) * (far - near)
    expected = (np.linalg.norm(at_start, axis=0) / (0.9 * (1.0 - room))) ** 2
    np.testing.assert_allclose(length.value(seat, NONE, EVERYWHERE)[0], expected, rtol=1e-12)
    apart = 0.2 / np.sqrt(3.0)  # between the two points of an interval
    rise = (g[:, 5:] - g[:, :5]) / (apart * 0.6 * (1.0 - room))
    np.testing.assert_allclose(
        onset.value(seat, NONE, EVERYWHERE), np.concatenate([rise, -rise]), rtol=1e-12, atol=1e-12
    )


def test_a_peak_is_to_that_of_what_is_asked_for() -> None:
    task = task_of(DESIRED, {})
    felt = respond_on(task.chain, DES.gravity, DESIRED).seat_angular_acceleration
    bound = point_bound(task, np.zeros(0), np.zeros((0, 3)), PEAK)
    assert isinstance(bound, NormBound)
    assert bound.bound == pytest.approx(1.5 * np.linalg.norm(felt, axis=-1).max(), rel=1e-12)
    nothing = np.zeros((4000, 2, 3))
    missing = Shortfall(nothing, felt, nothing, np.zeros((4001, 3)))  # as much again
    asked = point_bound(replace(task, shortfall=missing), np.zeros(0), np.zeros((0, 3)), PEAK)
    assert isinstance(asked, NormBound)
    assert asked.bound == pytest.approx(2.0 * bound.bound, rel=1e-12)


def test_a_peak_is_to_what_nobody_feels_at_the_least() -> None:
    still = Motion(np.linspace(0.0, 4.0, 21), np.zeros((21, 3)), *np.zeros((2, 20, 3)))
    bound = point_bound(task_of(still, {}), np.zeros(0), np.zeros((0, 3)), PEAK)
    assert isinstance(bound, NormBound)
    assert bound.bound == pytest.approx(1.5 * 0.01)


@pytest.mark.parametrize("asked_beyond", [False, True])
def test_an_attitude_is_at_one_where_it_is_off_by_its_budget(asked_beyond: bool) -> None:
    task = task_of(DESIRED, {}, seat=Seat(0.3, -0.2))
    times = Unknowns(GRID, 0).angle_windows.times()
    angle = GRID.values(np.random.default_rng(4).uniform(-1.0, 1.0, (23, 3)), times)
    axis = np.array([0.6, 0.0, 0.8])
    if asked_beyond:
        t, nothing = DESIRED.t, np.zeros((4000, 2, 3))
        missing = Shortfall(nothing, nothing, nothing, 0.1 * t[:, None] * axis)
        task = replace(task, shortfall=missing)
    bound = point_bound(task, times, angle, Budget(ATTITUDE_ERROR, 10.0))
    assert isinstance(bound, AttitudeBound)
    moved = angle + 0.1
    made, wanted = (
        Rotation.from_matrix(seat_rotation(task.chain, each)) for each in (moved, angle)
    )
    if asked_beyond:
        wanted = wanted * Rotation.from_rotvec(0.1 * times[:, None] * axis)
    apart = (wanted.inv() * made).magnitude()
    expected = (np.sin(0.5 * apart) / np.sin(np.radians(5.0))) ** 2
    found = bound.value(seats(len(times)), moved.T, EVERYWHERE)
    np.testing.assert_allclose(found[0], expected, rtol=1e-9)
