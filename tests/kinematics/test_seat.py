from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of, seat_position, seat_rotation
from des_cli.kinematics.seat import (
    in_seat_axes,
    linear_acceleration_parts,
    pilot_g,
    specific_force,
)
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.units import FOOT_M, STANDARD_GRAVITY_M_S2

PARTS = ("tangential", "centripetal", "coriolis")


def test_reference_states(state, same):
    q = state["q"]
    parts = linear_acceleration_parts(state.chain, q, state["qd"], state["qdd"])
    ground, seat = state["a_inertial_ftps2"], state["a_body_g_no_gravity"]
    same(parts / FOOT_M, [ground[name] for name in PARTS])
    same(parts.sum(axis=0) / FOOT_M, ground["total"])
    in_g = in_seat_axes(state.chain, q, parts) / STANDARD_GRAVITY_M_S2
    same(in_g, [seat[name] for name in PARTS])
    force = specific_force(state.chain, q, parts.sum(axis=0))
    same(force, state["specific_force_body_g_with_gravity"])


def test_parts_add_up_to_the_second_time_derivative_of_the_position(case, rng):
    """Eighth-order central difference of the position along a parabola of angles."""
    weights = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5])
    h = 0.02
    for _ in range(10):
        q, qd, qdd = rng.uniform(-2.0, 2.0, (3, 3))
        parts = linear_acceleration_parts(case.chain, q, qd, qdd)
        at = lambda t, q=q, qd=qd, qdd=qdd: seat_position(  # noqa: E731
            case.chain, q + qd * t + 0.5 * qdd * t * t
        )
        second = -205 / 72 * at(0.0)
        for weight, k in zip(weights, (4, 3, 2, 1), strict=True):
            second = second + weight * (at(k * h) + at(-k * h))
        np.testing.assert_allclose(parts.sum(axis=0), second / h**2, rtol=1e-8, atol=1e-8)


def test_each_part_answers_to_its_own_cause(case, rng):
    q, qd, qdd = rng.uniform(-2.0, 2.0, (3, 3))
    zero = np.zeros(3)
    assert not linear_acceleration_parts(case.chain, q, zero, qdd)[1:].any()
    one_joint = linear_acceleration_parts(case.chain, q, qd * [0, 1, 0], zero)
    assert one_joint[1].any()
    assert not one_joint[[0, 2]].any()
    reversed_rates = linear_acceleration_parts(case.chain, q, -qd, -qdd)
    parts = linear_acceleration_parts(case.chain, q, qd, qdd)
    np.testing.assert_array_equal(reversed_rates * [[-1], [1], [1]], parts)


def test_specific_force_at_rest_is_the_seat_pushing_up(case, rng):
    q = rng.uniform(-3.0, 3.0, (20, 3))
    force = specific_force(case.chain, q, np.zeros((20, 3)))
    np.testing.assert_allclose(force, seat_rotation(case.chain, q)[:, 2], rtol=0, atol=1e-14)
    moon = specific_force(case.chain, q, np.zeros((20, 3)), gravity=STANDARD_GRAVITY_M_S2 / 6)
    np.testing.assert_allclose(moon, force / 6, rtol=0, atol=1e-14)
    falling = specific_force(case.chain, q, np.array([0.0, 0.0, -STANDARD_GRAVITY_M_S2]))
    np.testing.assert_allclose(falling, 0.0, atol=1e-14)


def test_upright_pilot_at_rest_has_plus_one_gz():
    chain = chain_of(DES, Seat())
    force = specific_force(chain, np.zeros(3), np.zeros(3))
    assert pilot_g(force).tolist() == [0.0, 0.0, 1.0]


@pytest.mark.parametrize(
    ("pushed", "felt"),
    [
        ([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]),  # forward: eyeballs in, +Gx
        ([0.0, 1.0, 0.0], [0.0, 1.0, 0.0]),  # to the right: eyeballs left, +Gy
        ([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]),  # headward: eyeballs down, +Gz
    ],
)
def test_pilots_names(pushed, felt):
    assert pilot_g(np.array(pushed)).tolist() == felt


def test_spinning_arm_pushes_the_pilot_inward():
    """At home the seat faces along +y0 with the arm's axis to its left."""
    chain = chain_of(DES, Seat())
    rate = 1.3
    parts = linear_acceleration_parts(chain, np.zeros(3), np.array([rate, 0, 0]), np.zeros(3))
    force = specific_force(chain, np.zeros(3), parts.sum(axis=0))
    radius = seat_position(chain, np.zeros(3))[0]
    gx, gy, gz = pilot_g(force)
    assert gy == pytest.approx(-(rate**2) * radius / STANDARD_GRAVITY_M_S2, rel=1e-12)
    assert gz == pytest.approx(1.0, rel=1e-12)
    assert abs(gx) < 0.01
