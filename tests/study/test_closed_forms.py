"""The study's closed forms against the general chain, and the misprint of (10h)."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of, linear_jacobian, transform
from des_cli.kinematics.coriolis import angular_acceleration_split, coriolis
from des_cli.kinematics.orientation import body_jacobian, ground_jacobian
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.study.closed_forms import (
    closed_form_angular_acceleration,
    closed_form_body_jacobian,
    closed_form_coriolis,
    closed_form_ground_jacobian,
    closed_form_transform,
    report_jacobian,
    seat_turn,
)
from des_cli.units import FOOT_M

MANY = 100_000


@pytest.fixture(params=[Seat(), Seat(0.8, 0.3), Seat(3 * np.pi / 2, 0.5)], ids=str)
def seat(request):
    return request.param


@pytest.fixture
def angles(rng):
    return rng.uniform(-7.0, 7.0, (MANY, 3))


@pytest.fixture
def rates(rng):
    return rng.uniform(-3.0, 3.0, (MANY, 3))


def test_reference_states(state, same):
    q, qd, qdd = state["q"], state["qd"], state["qdd"]
    found = closed_form_transform(DES.lengths, state.seat, q)
    found[:3, 3] /= FOOT_M
    same(found, state["T_0_17"])
    printed = closed_form_transform(DES.lengths, state.seat, q, misprint=True)
    same(printed[1, 3] / FOOT_M, state["T24_as_printed"])
    same(report_jacobian(q, state.seat), state["J2_eq32"])
    same(seat_turn(state.seat), state["M_seat"])
    same(closed_form_body_jacobian(q, state.seat), state["J_body_frame17"])
    same(closed_form_coriolis(q, qd), state["Wc_dot_22_24"])
    same(closed_form_angular_acceleration(q, qd, qdd), state["W_dot_16_18"])


def test_transform(seat, angles):
    expected = closed_form_transform(DES.lengths, seat, angles)
    np.testing.assert_allclose(transform(chain_of(DES, seat), angles), expected, rtol=0, atol=1e-12)


def test_jacobians(seat, angles):
    chain = chain_of(DES, seat)
    ground = ground_jacobian(chain, angles)
    np.testing.assert_allclose(closed_form_ground_jacobian(angles), ground, rtol=0, atol=1e-12)
    body = body_jacobian(chain, angles)
    np.testing.assert_allclose(closed_form_body_jacobian(angles, seat), body, rtol=0, atol=1e-12)


def test_j2_is_the_ground_jacobian_in_constant_axes(seat, angles):
    turn = seat_turn(seat)
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), rtol=0, atol=1e-15)
    assert np.linalg.det(turn) == pytest.approx(1.0, abs=1e-15)
    j2 = report_jacobian(angles, seat)
    np.testing.assert_allclose(j2, turn @ closed_form_ground_jacobian(angles), rtol=0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(j2), np.cos(angles[:, 1]), rtol=0, atol=1e-12)


def test_j2_at_the_studys_seat_is_33():
    s1, c1, s2, c2 = np.sin(0.4), np.cos(0.4), np.sin(1.1), np.cos(1.1)
    printed = [[1, 0, s2], [0, s1, c1 * c2], [0, -c1, s1 * c2]]
    found = report_jacobian(np.array([0.4, 1.1, 0.9]), Seat(np.pi / 2, 0.0))
    np.testing.assert_allclose(found, printed, rtol=0, atol=1e-15)


def test_angular_acceleration(seat, angles, rates, rng):
    chain = chain_of(DES, seat)
    accelerations = rng.uniform(-3.0, 3.0, (MANY, 3))
    expected = closed_form_coriolis(angles, rates)
    found = coriolis(chain, angles, rates, "report")
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)
    split = angular_acceleration_split(chain, angles, rates, accelerations, "report")
    expected = closed_form_angular_acceleration(angles, rates, accelerations)
    np.testing.assert_allclose(split[0] + split[1], expected, rtol=0, atol=1e-12)


@pytest.mark.parametrize("misprint", [False, True])
def test_only_the_corrected_10h_is_a_rotation_about_z0(seat, step, misprint):
    """The arm turns the seat about -z0, so dT14/dtheta1 = T24."""
    at = np.array([0.8, 1.2, 1.7])
    form = lambda x: closed_form_transform(DES.lengths, seat, x, misprint=misprint)  # noqa: E731
    slope, value = step(form, at)[0, 0, 3], form(at)[1, 3]
    assert (abs(slope - value) < 1e-14) is not misprint
    if misprint:
        assert abs(slope - value) > 1.0  # the arm's length is missing [m]
        position = linear_jacobian(chain_of(DES, seat), at)[0, 0]
        assert abs(slope - position) < 1e-14
