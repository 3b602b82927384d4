"""The attitude at each sample against its bound: rotations, and differences."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from des_cli.kinematics.chain import chain_of, seat_rotation
from des_cli.model.arrays import Floats
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Shortfall
from des_cli.reduction.attitude_rows import AttitudeRows
from tests.support.differences import along

N = 12
CHAIN = chain_of(DES, Seat(0.4, -0.2))


@pytest.fixture
def target() -> Floats:
    return np.random.default_rng(3).uniform(-1.5, 1.5, (N, 3))


@pytest.fixture
def x(target: Floats) -> Floats:
    """An iterate of three factors beside the reference."""
    off = 0.1 * np.random.default_rng(4).normal(size=(N, 6))
    return np.hstack([target, np.ones((N, 3))]) + off


def shortfall_of(attitude: Floats) -> Shortfall:
    """What is asked for beyond the reference, of the attitude alone."""
    nothing = np.zeros((N - 1, 2, 3))
    return Shortfall(nothing, nothing, nothing, attitude)


def apart(x: Floats, target: Floats) -> Floats:
    """The angle between the attitudes [deg]."""
    made, wanted = (Rotation.from_matrix(seat_rotation(CHAIN, each)) for each in (x[:, :3], target))
    return np.asarray(np.degrees((wanted.inv() * made).magnitude()))


def test_an_attitude_reaches_its_bound_at_the_angle_between_the_seats(
    x: Floats, target: Floats
) -> None:
    angle = apart(x, target)
    k = int(np.argmax(angle))
    value = AttitudeRows(CHAIN, target, None, angle[k]).value(x)
    assert value.shape == (N, 1)
    assert np.argmax(value) == k
    assert value[k, 0] == pytest.approx(1.0, rel=1e-9)
    chord = np.sin(np.radians(0.5 * angle))
    np.testing.assert_allclose(value[:, 0], (chord / chord[k]) ** 2, atol=1e-9)


def test_a_missing_rotation_is_apart_by_its_own_angle(x: Floats, target: Floats) -> None:
    missing = np.linspace(0.0, 2.0, N)[:, None] * np.array([2.0, -1.0, 2.0]) / 3.0
    rows = AttitudeRows(CHAIN, target, shortfall_of(missing), 30.0)
    iterate = np.hstack([target, x[:, 3:]])
    expected = (np.sin(np.linspace(0.0, 1.0, N)) / np.sin(np.radians(15.0))) ** 2
    np.testing.assert_allclose(rows.value(iterate)[:, 0], expected, rtol=1e-12, atol=1e-12)


def test_what_makes_up_for_the_shortfall_is_at_zero(x: Floats, target: Floats) -> None:
    made, wanted = (Rotation.from_matrix(seat_rotation(CHAIN, each)) for each in (x[:, :3], target))
    missing = (wanted.inv() * made).as_rotvec()  # along the axes of the reference's seat
    assert np.abs(missing).max() > 0.1
    rows = AttitudeRows(CHAIN, target, shortfall_of(missing), 5.0)
    np.testing.assert_allclose(rows.value(x), 0.0, atol=1e-12)


@pytest.mark.parametrize("asked_beyond", [False, True])
def test_slopes_and_curvatures_are_those_of_the_value(
    asked_beyond: bool, x: Floats, target: Floats
) -> None:
    rng = np.random.default_rng(5)
    missing = shortfall_of(0.3 * rng.normal(size=(N, 3))) if asked_beyond else None
    rows = AttitudeRows(CHAIN, target, missing, 20.0)
    move, multiplier = rng.normal(size=x.shape), rng.normal(size=(N, 1))

    def gradient(at: Floats) -> Floats:
        (block,) = rows.jacobian(at)
        return (multiplier[:, None, :] @ block)[:, 0]

    (block,) = rows.jacobian(x)
    slope = along(rows.value, x, move)
    np.testing.assert_allclose(block @ move[:, :, None], slope[..., None], rtol=1e-8, atol=1e-9)
    bend = rows.curvature(x, multiplier) @ move[:, :, None]
    np.testing.assert_allclose(bend[..., 0], along(gradient, x, move), rtol=1e-7, atol=1e-7)
