"""Bounds at points: what they bound, and their derivatives by finite differences."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.attitude import geodesic_angle
from des_cli.kinematics.chain import chain_of, seat_rotation
from des_cli.kinematics.trig_polynomial import TrigPolynomial
from des_cli.kinematics.twist import VARIABLES, seat_forms
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.reduction.free.local_bounds import (
    AttitudeBound,
    ComponentBound,
    NormBound,
    OnsetBound,
    at_ends,
)
from des_cli.reduction.free.terms import value_of

STEP = 1e-6
M = 8
CHAIN = chain_of(DES, Seat())
FORMS = seat_forms(CHAIN, DES.gravity)
G = DES.gravity
REFERENCE = np.random.default_rng(1).uniform(-1.0, 1.0, (3, M + 4))
ROTATION = TrigPolynomial(CHAIN.transform.coefficient[..., :3, :3].reshape(3, 3, 3, 9))

COMPONENTS = ComponentBound(
    np.array([[1.0, 0.0, 0.0], [0.0, 0.3, -1.0]]) / G, np.array([2.0, -1.0]), np.array([2.0, 1.5])
)
ONSET = OnsetBound(np.concatenate([np.eye(3), -np.eye(3)]) / (0.7 * G))
ATTITUDE = AttitudeBound(ROTATION, ROTATION(REFERENCE.T).T, 0.4)
NORMS = [NormBound(quantity, 1.7) for quantity in ("rate", "cross", "acceleration", "force")]
BOUNDS = {
    "components": COMPONENTS,
    "onset": ONSET,
    **{f"norm of {each.quantity}": each for each in NORMS},
}


@pytest.fixture
def rng():
    return np.random.default_rng(2)


@pytest.fixture
def z(rng):
    return rng.uniform(-1.2, 1.2, (VARIABLES, M))


@pytest.fixture
def angles(rng):
    return REFERENCE[:, 2 : 2 + M] + rng.uniform(-0.3, 0.3, (3, M))


AT = slice(2, 2 + M)
NONE = np.zeros((3, M))


def differences(function, z):
    """By each variable at each point alone, (v, rows, m): no point depends on another."""
    return np.stack(
        [
            (function(z + STEP * e[:, None]) - function(z - STEP * e[:, None])) / (2.0 * STEP)
            for e in np.eye(len(z))
        ]
    )


def test_components_are_at_one_where_the_bound_is(z):
    seat = FORMS.at(z)
    off = COMPONENTS.direction @ seat.force - COMPONENTS.bound[:, None]
    value = COMPONENTS.value(seat, NONE, AT)
    assert value.shape == (COMPONENTS.rows, M)
    np.testing.assert_array_equal(value > 1.0, off > 0.0)
    np.testing.assert_allclose((value - 1.0) * COMPONENTS.scale[:, None], off, atol=1e-12)


@pytest.mark.parametrize("bound", NORMS, ids=lambda bound: bound.quantity)
def test_lengths_at_the_ends_of_intervals(bound, z):
    seat = FORMS.at(z)
    near, far = np.split(value_of(seat, bound.quantity), 2, axis=1)
    beyond = (0.5 - np.sqrt(3.0) / 6.0) * np.sqrt(3.0) * (far - near)  # to the knot
    ends = [near - beyond, far + beyond]
    value = bound.value(seat, NONE, AT)
    assert value.shape == (2, M // 2)
    np.testing.assert_allclose(np.sqrt(value), np.linalg.norm(ends, axis=1) / 1.7)


def test_what_is_linear_has_its_own_values_at_the_ends():
    t = np.array([0.5 - np.sqrt(3.0) / 6.0, 0.5 + np.sqrt(3.0) / 6.0])
    np.testing.assert_allclose(
        at_ends(3.0 + 2.0 * t[None])[:, 0, 0], [3.0, 5.0], rtol=0, atol=1e-12
    )


def test_attitudes(z, angles):
    value = ATTITUDE.value(FORMS.at(z), angles, AT)
    one = seat_rotation(CHAIN, angles.T)
    other = seat_rotation(CHAIN, REFERENCE[:, AT].T)
    apart = geodesic_angle(one, other)
    np.testing.assert_allclose(value[0], (np.sin(apart / 2.0) / np.sin(0.2)) ** 2, rtol=1e-9)
    np.testing.assert_array_equal(value[0] > 1.0, apart > 0.4)


def test_onset_is_between_the_two_points_of_an_interval(z):
    seat = FORMS.at(z)
    value = ONSET.value(seat, NONE, AT)
    rise = seat.force[:, M // 2 :] - seat.force[:, : M // 2]
    assert value.shape == (6, M // 2)
    np.testing.assert_allclose(value[:3], rise / (0.7 * G), rtol=1e-12)
    np.testing.assert_array_equal(value[3:], -value[:3])


@pytest.mark.parametrize("bound", BOUNDS.values(), ids=list(BOUNDS))
def test_slopes(bound, z):
    slope = bound.slope(FORMS.at(z), NONE, AT)

    def value(y):
        # a row that belongs to two points: move one, keep the other
        if bound.per_interval:
            half = M // 2
            first = np.concatenate([y[:, :half], z[:, half:]], axis=1)
            second = np.concatenate([z[:, :half], y[:, half:]], axis=1)
            return np.concatenate(
                [bound.value(FORMS.at(each), NONE, AT) for each in (first, second)], axis=1
            )
        return bound.value(FORMS.at(y), NONE, AT)

    assert slope.shape == (VARIABLES, bound.rows, M)
    np.testing.assert_allclose(slope, differences(value, z), rtol=1e-5, atol=1e-6)


def test_slope_and_curvature_of_attitudes(z, angles, rng):
    seat, multiplier = FORMS.at(z), rng.normal(size=(1, M))
    slope = ATTITUDE.slope(seat, angles, AT)
    expected = differences(lambda y: ATTITUDE.value(seat, y, AT), angles)
    np.testing.assert_allclose(slope, expected, rtol=1e-6, atol=1e-7)
    found = ATTITUDE.curvature(seat, angles, AT, multiplier)
    expected = differences(lambda y: ATTITUDE.slope(seat, y, AT)[:, 0] * multiplier[0], angles)
    np.testing.assert_allclose(found, expected[np.triu_indices(3)], rtol=1e-6, atol=1e-6)
