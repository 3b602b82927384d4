"""The vector of a free motion's unknowns, against the spline that it stands for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.response import respond
from des_cli.kinematics.twist import seat_forms
from des_cli.model.arrays import Floats
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.reduction.free.unknowns import Unknowns
from des_cli.solver.spline import SplineGrid

GRID = SplineGrid(0.3, 0.2, 9)


@pytest.fixture
def unknowns() -> Unknowns:
    return Unknowns(GRID, 2)


@pytest.fixture
def x(unknowns: Unknowns) -> Floats:
    return np.random.default_rng(1).normal(size=unknowns.size)


@pytest.mark.parametrize("angles", [0, 1, 2])
def test_control_points_come_first_and_the_seats_angles_last(angles: int) -> None:
    unknowns = Unknowns(GRID, angles)
    assert unknowns.size == 3 * 12 + angles
    x = np.arange(float(unknowns.size))
    np.testing.assert_array_equal(unknowns.control(x)[1], [3.0, 4.0, 5.0])
    np.testing.assert_array_equal(unknowns.seat_angles(x), 36.0 + np.arange(angles))


def test_the_parts_of_a_vector_are_views_of_it(unknowns: Unknowns, x: Floats) -> None:
    unknowns.control(x)[:] = 1.0
    unknowns.seat_angles(x)[:] = 2.0
    np.testing.assert_array_equal(x, [1.0] * 36 + [2.0] * 2)


def test_the_joint_angles_are_the_splines(unknowns: Unknowns, x: Floats) -> None:
    control, windows = unknowns.control(x), unknowns.angle_windows
    found = windows.gather(control, 0, GRID.intervals)
    expected = GRID.values(control, windows.times())
    np.testing.assert_allclose(found.T, expected, rtol=0, atol=1e-12)


def test_the_seats_variables_are_in_the_order_in_which_its_motion_takes_them(
    unknowns: Unknowns, x: Floats
) -> None:
    """What they make of the seat is what joint states at the same times make of it."""
    control, windows = unknowns.control(x), unknowns.seat_windows
    chain = chain_of(DES, Seat())
    found = seat_forms(chain, DES.gravity).at(windows.gather(control, 0, GRID.intervals))
    for k, t in enumerate(windows.times()):
        angle, rate, acceleration = (
            GRID.values(control, np.array([t]), order)[0] for order in (0, 1, 2)
        )
        h = 1e-3
        motion = Motion(
            np.array([t, t + h]),
            np.stack([angle, angle + h * rate + 0.5 * h**2 * acceleration]),
            rate[None],
            (rate + h * acceleration)[None],
        )
        felt = respond(DES, Seat(), motion)
        np.testing.assert_allclose(found.twist[:3, k], felt.seat_rate[0, 0], atol=1e-10)
        turning = felt.seat_angular_acceleration[0, 0]
        np.testing.assert_allclose(found.twist_rate[:3, k], turning, atol=1e-9)


def test_the_maps_are_made_once(unknowns: Unknowns) -> None:
    assert unknowns.seat_windows is unknowns.seat_windows
    assert unknowns.angle_windows is unknowns.angle_windows
    assert replace(unknowns, angles=1).seat_windows is not unknowns.seat_windows
