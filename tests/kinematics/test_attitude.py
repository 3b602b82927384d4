"""Attitude from body rates against scipy's rotations and integrators."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from des_cli.kinematics.attitude import (
    geodesic_angle,
    integrate_attitude,
    quaternion_product,
    rotation,
    rotation_of_quaternion,
    rotation_vector,
)
from des_cli.model.profile import BodyRates


def tumble(t):
    """A body rate that never keeps its direction, (..., 3) [rad/s]."""
    t = np.asarray(t, dtype=float)
    return np.stack([np.sin(1.3 * t), 0.8 * np.cos(0.9 * t), 0.5 + 0.4 * np.sin(2.1 * t)], axis=-1)


def sampled(function, t):
    return BodyRates(function(t[:-1]), function(0.5 * (t[:-1] + t[1:])), function(t[1:]))


def exact_attitude(function, t):
    def derivative(at, flat):
        p, q, r = function(at)
        cross = np.array([[0.0, -r, q], [r, 0.0, -p], [-q, p, 0.0]])
        return (flat.reshape(3, 3) @ cross).ravel()

    found = solve_ivp(
        derivative, (t[0], t[-1]), np.eye(3).ravel(), "DOP853", t_eval=t, rtol=1e-12, atol=1e-13
    )
    return found.y.T.reshape(-1, 3, 3)


@pytest.mark.parametrize("size", [0.0, 1e-12, 1e-5, 0.3, 2.0, np.pi, 5.0, 20.0])
def test_rotation_of_a_vector(size):
    vector = size * np.array([[2.0, -1.0, 2.0], [0.0, 0.0, 3.0]]) / 3.0
    np.testing.assert_allclose(
        rotation(vector), Rotation.from_rotvec(vector).as_matrix(), rtol=0, atol=1e-14
    )


def test_rotation_of_a_small_vector_is_exact_to_first_order():
    turned = rotation(np.array([1e-9, 2e-9, -3e-9]))
    assert turned[2, 1] == pytest.approx(1e-9, rel=1e-9)
    assert turned[0, 2] == pytest.approx(2e-9, rel=1e-9)
    assert turned[1, 0] == pytest.approx(-3e-9, rel=1e-9)


def test_rotation_of_a_quaternion_of_any_length():
    rng = np.random.default_rng(2)
    quaternion = rng.normal(size=(5, 4))
    expected = Rotation.from_quat(quaternion[:, [1, 2, 3, 0]]).as_matrix()
    np.testing.assert_allclose(rotation_of_quaternion(quaternion), expected, atol=1e-14)


@pytest.mark.parametrize("angle", [0.0, 1e-10, 1e-4, 1.0, 3.0])
def test_geodesic_angle(angle):
    rng = np.random.default_rng(6)
    first = Rotation.random(4, random_state=rng)
    axis = rng.normal(size=(4, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    second = first * Rotation.from_rotvec(angle * axis)
    found = geodesic_angle(first.as_matrix(), second.as_matrix())
    np.testing.assert_allclose(found, angle, rtol=1e-5, atol=1e-15)


def test_the_largest_angle_is_half_a_turn():
    assert geodesic_angle(np.eye(3), np.diag([1.0, -1.0, -1.0])) == pytest.approx(np.pi)


@pytest.mark.parametrize("count", [1, 2, 3, 7, 16, 37])
def test_constant_rates_turn_about_one_axis(count):
    rate = np.array([0.4, -0.7, 1.1])
    step = np.linspace(0.05, 0.3, count)
    found = integrate_attitude(step, BodyRates(*[np.tile(rate, (count, 1))] * 3))
    time = np.concatenate([[0.0], np.cumsum(step)])
    expected = Rotation.from_rotvec(time[:, None] * rate).as_matrix()
    np.testing.assert_allclose(found, expected, atol=1e-13)


def test_fourth_order_against_an_integrator():
    errors = []
    for intervals in (40, 80, 160):
        t = np.linspace(0.0, 6.0, intervals + 1)
        found = integrate_attitude(np.diff(t), sampled(tumble, t))
        errors.append(np.max(geodesic_angle(found, exact_attitude(tumble, t))))
    assert errors[-1] < 1e-7
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders.min() > 3.8


def test_attitudes_stay_rotations():
    t = np.cumsum(np.random.default_rng(7).uniform(0.005, 0.05, 3001))
    found = integrate_attitude(np.diff(t), sampled(tumble, t))
    np.testing.assert_allclose(np.swapaxes(found, 1, 2) @ found - np.eye(3), 0.0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(found), 1.0, atol=1e-12)


def test_a_rotation_vector_is_scipys_at_every_angle():
    rng = np.random.default_rng(8)
    axis = rng.normal(size=(60, 3))
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    angle = np.concatenate([[0.0, 1e-12, 1e-6, np.pi - 1e-9], rng.uniform(0.0, 3.1, 56)])
    one = Rotation.random(60, random_state=3)
    other = one * Rotation.from_rotvec(axis * angle[:, None])
    found = rotation_vector(one.as_matrix(), other.as_matrix())
    np.testing.assert_allclose(found, axis * angle[:, None], atol=1e-7)
    np.testing.assert_allclose(
        one.as_matrix() @ rotation(found), other.as_matrix(), rtol=0.0, atol=1e-14
    )


def test_the_product_of_quaternions_is_scipy_s():
    vectors = np.random.default_rng(5).normal(size=(2, 6, 3))
    one, other = (Rotation.from_rotvec(each) for each in vectors)
    w_first = [3, 0, 1, 2]
    product = quaternion_product(one.as_quat()[:, w_first], other.as_quat()[:, w_first])
    found = Rotation.from_quat(product[:, [1, 2, 3, 0]])
    np.testing.assert_allclose(found.as_matrix(), (one * other).as_matrix(), atol=1e-14)
