from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.chain import (
    chain_of,
    jacobian,
    joint_axes,
    joint_origins,
    linear_jacobian,
    position_second_partials,
    seat_position,
    seat_rotation,
    transform,
)
from des_cli.kinematics.trig_polynomial import BLOCK
from des_cli.model.machine import DHRow, JointLimits, Machine, Seat
from des_cli.model.machines import DES
from des_cli.units import FOOT_M

LIMITS = (JointLimits(np.inf, 1.0, 1.0),) * 3


def in_feet(matrix):
    scaled = matrix.copy()
    scaled[..., :3, 3] /= FOOT_M
    return scaled


def test_reference_states(state, same):
    q = state["q"]
    same(in_feet(transform(state.chain, q)), state["T_0_17"])
    same(linear_jacobian(state.chain, q) / FOOT_M, state["J1"])
    same(np.linalg.det(linear_jacobian(state.chain, q) / FOOT_M), state["det_J1"])
    same(joint_axes(state.chain, q).T, state["J_inertial"])
    same(jacobian(state.chain, q)[3:] @ state["qd"], state["W_inertial"])
    velocity = jacobian(state.chain, q)[:3] @ state["qd"]
    same(velocity / FOOT_M, state["seat_velocity_inertial"])


def test_collapsed_chain_is_the_product_of_the_rows(case, rng):
    angles = rng.uniform(-7.0, 7.0, (50, 3))
    expected = np.array([case.transform(row).real for row in angles])
    np.testing.assert_allclose(transform(case.chain, angles), expected, rtol=0, atol=1e-13)
    np.testing.assert_array_equal(
        seat_position(case.chain, angles), transform(case.chain, angles)[:, :3, 3]
    )
    rotation = seat_rotation(case.chain, angles)
    identity = rotation @ rotation.swapaxes(-1, -2)
    np.testing.assert_allclose(identity, np.broadcast_to(np.eye(3), identity.shape), atol=1e-14)


def test_joint_axes_in_both_frames(case, rng):
    for angles in rng.uniform(-7.0, 7.0, (20, 3)):
        for frame in ("ground", "seat"):
            expected = case.axes(angles, frame).real
            np.testing.assert_allclose(
                joint_axes(case.chain, angles, frame), expected, rtol=0, atol=1e-14
            )


def test_joint_axes_are_the_angular_velocity(case, step, rng):
    """The skew part of dR/dtheta R^T is the axis with its sign."""
    for angles in rng.uniform(-7.0, 7.0, (20, 3)):
        turned = step(lambda x: case.transform(x)[:3, :3], angles)
        skew = turned @ case.transform(angles)[:3, :3].real.T
        axes = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=-1)
        np.testing.assert_allclose(joint_axes(case.chain, angles), axes, rtol=0, atol=1e-14)


def test_axes_turn_about_inner_axes(case, step, rng):
    """dw_k/dtheta_j = w_j x w_k for j < k on the ground; for m > k reversed in the seat."""
    angles = rng.uniform(-7.0, 7.0, 3)
    for frame in ("ground", "seat"):
        w = joint_axes(case.chain, angles, frame)
        slope = step(lambda x, frame=frame: joint_axes(case.chain, x, frame), angles)
        for turned in range(3):
            for k in range(3):
                moves = turned < k if frame == "ground" else turned > k
                expected = np.cross(w[turned], w[k]) * (1 if frame == "ground" else -1)
                np.testing.assert_allclose(slope[turned, k], expected * moves, rtol=0, atol=1e-14)


def test_linear_jacobian(case, step, rng):
    for angles in rng.uniform(-7.0, 7.0, (20, 3)):
        expected = step(lambda x: case.transform(x)[:3, 3], angles)
        np.testing.assert_allclose(
            linear_jacobian(case.chain, angles).T, expected, rtol=1e-13, atol=1e-13
        )
        lever = seat_position(case.chain, angles) - joint_origins(case.chain, angles)
        crossed = np.cross(joint_axes(case.chain, angles), lever)
        np.testing.assert_allclose(crossed, expected, rtol=1e-13, atol=1e-13)


def test_position_second_partials(case, step, rng):
    for angles in rng.uniform(-7.0, 7.0, (20, 3)):
        partials = position_second_partials(case.chain, angles)
        expected = step(lambda x: linear_jacobian(case.chain, x).swapaxes(-1, -2), angles)
        np.testing.assert_allclose(partials, expected, rtol=0, atol=1e-13)
        np.testing.assert_allclose(partials, partials.swapaxes(0, 1), rtol=0, atol=0)
        w, o = joint_axes(case.chain, angles), joint_origins(case.chain, angles)
        p = seat_position(case.chain, angles)
        for i in range(3):
            for j in range(i, 3):
                crossed = np.cross(w[i], np.cross(w[j], p - o[j]))
                np.testing.assert_allclose(partials[i, j], crossed, rtol=0, atol=1e-13)


def test_second_partials_by_finite_difference_of_the_rows(case, step):
    angles, h = np.array([0.3, -0.9, 2.1]), 1e-4
    gradient = lambda x: step(lambda y: case.transform(y)[:3, 3], x)  # noqa: E731
    for i, unit in enumerate(np.eye(3)):
        near = gradient(angles + h * unit) - gradient(angles - h * unit)
        far = gradient(angles + 2 * h * unit) - gradient(angles - 2 * h * unit)
        expected = (8 * near - far) / (12 * h)
        np.testing.assert_allclose(
            position_second_partials(case.chain, angles)[i], expected, rtol=0, atol=1e-10
        )


@pytest.mark.parametrize("shape", [(), (1,), (4, 2), (0,), (BLOCK + 3,)])
def test_leading_dimensions(case, rng, shape):
    angles = rng.uniform(-3.0, 3.0, (*shape, 3))
    stacked = transform(case.chain, angles)
    assert stacked.shape == (*shape, 4, 4)
    assert position_second_partials(case.chain, angles).shape == (*shape, 3, 3, 3)
    assert jacobian(case.chain, angles).shape == (*shape, 6, 3)
    if stacked.size:
        last = transform(case.chain, angles.reshape(-1, 3)[-1])
        np.testing.assert_allclose(stacked.reshape(-1, 4, 4)[-1], last, rtol=0, atol=1e-14)


def test_quarter_turns_leave_exact_zeros():
    """The arm turns about -z0 exactly: nothing of it leaks into i0 and j0."""
    chain = chain_of(DES, Seat())
    assert joint_axes(chain, np.array([0.7, 0.2, -1.0]))[0].tolist() == [0.0, 0.0, -1.0]
    assert chain.ground_axes.joints == (0, 1)
    assert chain.seat_axes.joints == (1, 2)


def test_equal_rows_and_seat_share_a_chain():
    rebuilt = Machine("again", tuple(DES.rows), DES.limits)
    assert chain_of(rebuilt, Seat()) is chain_of(DES, Seat())
    assert chain_of(DES, Seat(yaw=0.1)) is not chain_of(DES, Seat())


@pytest.mark.parametrize(
    "order", [("fork", "arm", "cab"), ("arm", "fork"), ("arm", "fork", "cab", "cab")]
)
def test_joints_out_of_order_are_refused(order):
    machine = Machine("wrong", tuple(DHRow(variable=joint) for joint in order), LIMITS)
    with pytest.raises(ValueError, match="once each in this order"):
        chain_of(machine, Seat())
