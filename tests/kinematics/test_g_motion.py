"""Arm rate and gimbal angles of a requested G, against the forces that they make."""

from __future__ import annotations

import numpy as np
import pytest
from support.seat_forms import by_chain

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.g_motion import gimbal_angles, requested_directions, steady_joints
from des_cli.kinematics.response import respond
from des_cli.model.machine import Machine, Seat
from des_cli.model.machines import COVISART, DES, JOHNSVILLE
from des_cli.model.motion import Motion

N = 41
RISE = np.linspace(1.4, 9.0, N)
SWING = np.sin(np.linspace(0.0, 2.0 * np.pi, N))


def held(machine: Machine, seat: Seat, requested: np.ndarray) -> np.ndarray:
    """The G of each sample's joints, each held by a motion of its own, (n, 3) [g]."""
    steady = steady_joints(machine, chain_of(machine, seat), requested)
    made = []
    for arm, gimbal in zip(steady.arm_rate, steady.gimbal, strict=True):
        rate = np.array([[arm, 0.0, 0.0]])
        angle = np.vstack([np.append(0.0, gimbal), np.append(arm, gimbal)])
        motion = Motion(np.array([0.0, 1.0]), angle, rate, rate)
        made.append(respond(machine, seat, motion).seat_g[0, 0])
    return np.array(made)


@pytest.mark.parametrize(
    ("machine", "yaw_deg"), [(DES, 270), (DES, 90), (DES, 30), (JOHNSVILLE, 0), (JOHNSVILLE, 90)]
)
@pytest.mark.parametrize(
    "requested",
    [
        np.column_stack([0 * RISE, 0 * RISE, RISE]),
        np.column_stack([0.4 * SWING, 0.3 * SWING, RISE]),
        np.column_stack([0 * RISE, 0 * RISE, -RISE]),
    ],
    ids=["along the spine", "all components", "negative"],
)
def test_what_is_asked_is_made_in_steady_turning(
    machine: Machine, yaw_deg: float, requested: np.ndarray
) -> None:
    seat = Seat(yaw=np.radians(yaw_deg), pitch=0.1)
    np.testing.assert_allclose(held(machine, seat, requested), requested, atol=1e-9)


def test_the_des_makes_it_by_a_formula_that_shares_nothing() -> None:
    requested = np.column_stack([0.4 * SWING, 0.3 * SWING, RISE])
    yaw = np.radians(270)
    steady = steady_joints(DES, chain_of(DES, Seat(yaw=yaw)), requested)
    zero = np.zeros(N)
    felt = by_chain(
        np.column_stack([zero, steady.gimbal]),
        np.column_stack([steady.arm_rate, zero, zero]),
        np.zeros((N, 3)),
        yaw,
        0.0,
    )
    np.testing.assert_allclose(felt.g, requested, atol=1e-9)


def test_less_than_gravity_is_rest_and_too_much_is_the_arms_limit() -> None:
    requested = np.array([[0.0, 0.0, 0.5], [0.0, 0.0, 1000.0]])
    steady = steady_joints(DES, chain_of(DES, Seat()), requested)
    np.testing.assert_array_equal(steady.arm_rate, [0.0, DES.limits[0].rate])
    np.testing.assert_allclose(held(DES, Seat(), requested)[0], [0.0, 0.0, 1.0], atol=1e-12)


def test_a_machine_without_an_arm_turns_none() -> None:
    steady = steady_joints(COVISART, chain_of(COVISART, Seat(yaw=0.0)), np.array([[0.0, 0.6, 3.0]]))
    assert steady.arm_rate == 0.0


def test_a_direction_out_of_reach_is_the_nearest() -> None:
    # along the cab's axis the fork has gravity alone: 1 g of the 2 g that are asked
    made = held(DES, Seat(yaw=np.radians(270)), np.array([[2.0, 0.0, 3.0]]))[0]
    assert made[0] == pytest.approx(1.0, abs=1e-5)  # and what the seat is beside the arm
    assert made[1] == pytest.approx(0.0, abs=1e-5)


def test_angles_are_continuous_through_whole_turns() -> None:
    chain = chain_of(JOHNSVILLE, Seat(yaw=0.0))
    turn = np.linspace(0.0, 4.0 * np.pi, 201)
    force = np.tile([-1.0, 0.0, 1.0], (201, 1))
    direction = np.column_stack([np.sin(turn), 0 * turn, -np.cos(turn)])
    gimbal = gimbal_angles(chain, force, direction)
    assert np.abs(np.diff(gimbal, axis=0)).max() < 0.1
    assert np.abs(gimbal).max() <= 2.0 * np.pi + 0.1


def test_no_g_has_the_direction_before_it() -> None:
    requested = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 0], [0, 0, 2.0]])
    np.testing.assert_array_equal(
        requested_directions(requested), [[1, 0, 0], [1, 0, 0], [1, 0, 0], [0, 0, -1]]
    )
    np.testing.assert_array_equal(requested_directions(np.zeros((1, 3))), [[0, 0, -1]])
