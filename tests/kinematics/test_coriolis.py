from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of, seat_rotation
from des_cli.kinematics.coriolis import (
    angular_acceleration_split,
    coriolis,
    coriolis_curvature,
    coriolis_derivatives,
    coriolis_pairs,
    coriolis_pairs_gradient,
    coriolis_pairs_hessian,
)
from des_cli.kinematics.trig_polynomial import BLOCK
from des_cli.model.machine import Seat
from des_cli.model.machines import DES

AXES = pytest.mark.parametrize("axes", ["report", "seat"])


def test_reference_states(state, same):
    q, qd, qdd = state["q"], state["qd"], state["qdd"]
    same(coriolis(state.chain, q, qd, "report"), state["Wc_dot_22_24"])
    same(coriolis(state.chain, q, qd, "seat"), state["Wc_dot_body"])
    same(sum(angular_acceleration_split(state.chain, q, qd, qdd, "report")), state["W_dot_16_18"])
    same(sum(angular_acceleration_split(state.chain, q, qd, qdd, "seat")), state["W_dot_body"])


@AXES
def test_pairs_are_cross_products_of_the_joint_axes(case, rng, axes):
    for angles in rng.uniform(-7.0, 7.0, (20, 3)):
        expected = case.pairs(angles, axes).real
        np.testing.assert_allclose(coriolis_pairs(case.chain, angles, axes), expected, atol=1e-14)


@AXES
def test_coriolis_is_the_rate_product_part_of_the_angular_acceleration(case, step, rng, axes):
    """In ground axes c = d/dt(J_in) theta'; in the seat the same vector turned."""
    angles, rates = rng.uniform(-7.0, 7.0, 3), rng.uniform(-3.0, 3.0, 3)
    slope = step(lambda x: case.axes(x, "ground"), angles)  # angle, joint, component
    expected = np.einsum("m,k,mki->i", rates, rates, slope)
    if axes == "seat":
        expected = seat_rotation(case.chain, angles).T @ expected
    np.testing.assert_allclose(coriolis(case.chain, angles, rates, axes), expected, atol=1e-13)


@AXES
def test_pair_derivatives(case, step, rng, axes):
    """Against the complex step of cross products of the rows' joint axes."""
    for angles in rng.uniform(-7.0, 7.0, (10, 3)):
        gradient = coriolis_pairs_gradient(case.chain, angles, axes)
        expected = step(lambda x: case.pairs(x, axes), angles)
        np.testing.assert_allclose(gradient, expected, rtol=0, atol=1e-13)
        hessian = coriolis_pairs_hessian(case.chain, angles, axes)
        expected = step(lambda x: coriolis_pairs_gradient(case.chain, x, axes), angles)
        np.testing.assert_allclose(hessian, expected, rtol=0, atol=1e-13)


@AXES
def test_pair_hessian_by_finite_difference_of_the_rows(case, step, axes):
    angles, h = np.array([0.4, 1.1, -2.0]), 1e-4
    hessian = coriolis_pairs_hessian(case.chain, angles, axes)
    gradient = lambda x: step(lambda y: case.pairs(y, axes), x)  # noqa: E731
    for i, unit in enumerate(np.eye(3)):
        near = gradient(angles + h * unit) - gradient(angles - h * unit)
        far = gradient(angles + 2 * h * unit) - gradient(angles - 2 * h * unit)
        np.testing.assert_allclose(hessian[i], (8 * near - far) / (12 * h), rtol=0, atol=1e-10)


@AXES
def test_coriolis_derivatives(case, step, rng, axes):
    for _ in range(10):
        angles, rates = rng.uniform(-7.0, 7.0, 3), rng.uniform(-3.0, 3.0, 3)
        c, dc_dangle, dc_drate = coriolis_derivatives(case.chain, angles, rates, axes)
        np.testing.assert_allclose(c, case.coriolis(angles, rates, axes).real, rtol=0, atol=1e-13)
        by_angle = step(lambda x, rates=rates: case.coriolis(x, rates, axes), angles)
        by_rate = step(lambda x, angles=angles: case.coriolis(angles, x, axes), rates)
        np.testing.assert_allclose(dc_dangle, by_angle.T, rtol=0, atol=1e-12)
        np.testing.assert_allclose(dc_drate, by_rate.T, rtol=0, atol=1e-13)


@AXES
def test_an_azimuth_or_a_cab_angle_can_be_ignored(rng, axes):
    """On the DES c is independent of the cab in report axes, of the arm in the seat's."""
    ignorable = 2 if axes == "report" else 0
    angles, rates = rng.uniform(-7.0, 7.0, (200, 3)), rng.uniform(-3.0, 3.0, (200, 3))
    chain = chain_of(DES, Seat(0.8, 0.3))
    moved = angles.copy()
    moved[:, ignorable] += rng.uniform(-3.0, 3.0, 200)
    np.testing.assert_array_equal(
        coriolis(chain, moved, rates, axes), coriolis(chain, angles, rates, axes)
    )
    slope = coriolis_derivatives(chain, angles, rates, axes)[1]
    assert not slope[..., ignorable].any()
    assert slope[..., 1].any()


def test_identities_of_the_des(rng):
    """dBB3/dtheta1 = -AB3; dBB3/dtheta2 = theta3'(theta2' c1 c2 - theta1' s1 s2)."""
    angles, rates = rng.uniform(-7.0, 7.0, (1000, 3)), rng.uniform(-3.0, 3.0, (1000, 3))
    c, slope, _ = coriolis_derivatives(chain_of(DES, Seat()), angles, rates, "report")
    (s1, s2, _), (c1, c2, _) = np.sin(angles).T, np.cos(angles).T
    d1, d2, d3 = rates.T
    np.testing.assert_allclose(slope[:, 1, 0], -c[:, 0], rtol=0, atol=1e-14)
    expected = d3 * (d2 * c1 * c2 - d1 * s1 * s2)
    np.testing.assert_allclose(slope[:, 1, 1], expected, rtol=0, atol=1e-13)


@AXES
def test_norm_of_the_des(rng, axes):
    """||c||^2 = theta2'^2 (theta1' - theta3' s2)^2 + theta3'^2 (theta1'^2 + theta2'^2) c2^2."""
    angles, rates = rng.uniform(-7.0, 7.0, (1000, 3)), rng.uniform(-3.0, 3.0, (1000, 3))
    c = coriolis(chain_of(DES, Seat(0.8, 0.3)), angles, rates, axes)
    s2, c2 = np.sin(angles[:, 1]), np.cos(angles[:, 1])
    d1, d2, d3 = rates.T
    expected = d2**2 * (d1 - d3 * s2) ** 2 + d3**2 * (d1**2 + d2**2) * c2**2
    np.testing.assert_allclose((c**2).sum(-1), expected, rtol=1e-12, atol=1e-13)


@AXES
def test_c_scales_with_the_square_of_a_common_factor(case, rng, axes):
    angles, rates = rng.uniform(-7.0, 7.0, (50, 3)), rng.uniform(-3.0, 3.0, (50, 3))
    scaled = coriolis(case.chain, angles, 0.3 * rates, axes)
    np.testing.assert_allclose(scaled, 0.09 * coriolis(case.chain, angles, rates, axes), atol=1e-13)
    alone = np.eye(3) * rates[:3]  # one joint at a time: no square terms
    assert not coriolis(case.chain, angles[:3], alone, axes).any()


@AXES
@pytest.mark.parametrize("shape", [(), (0,), (4, 2), (BLOCK + 3,)])
def test_leading_dimensions_and_broadcasting(case, rng, axes, shape):
    angles, rates = rng.uniform(-3.0, 3.0, (*shape, 3)), rng.uniform(-3.0, 3.0, 3)
    c, dc_dangle, dc_drate = coriolis_derivatives(case.chain, angles, rates, axes)
    assert c.shape == (*shape, 3)
    assert dc_dangle.shape == dc_drate.shape == (*shape, 3, 3)
    assert coriolis_pairs_hessian(case.chain, angles, axes).shape == (*shape, 3, 3, 3, 3)
    if c.size:
        last = coriolis_derivatives(case.chain, angles.reshape(-1, 3)[-1], rates, axes)
        np.testing.assert_allclose(c.reshape(-1, 3)[-1], last[0], rtol=0, atol=1e-13)
        np.testing.assert_allclose(dc_dangle.reshape(-1, 3, 3)[-1], last[1], rtol=0, atol=1e-13)


@AXES
def test_curvature(case, step, rng, axes):
    """Against the complex step of the first derivatives; more samples than a block."""
    n = BLOCK + 3
    angles, rates, weight = rng.uniform(-3.0, 3.0, (3, n, 3))
    found = coriolis_curvature(case.chain, angles, rates, weight, axes)
    for k in (0, 5, n - 1):

        def slopes(theta, speed, k=k):
            _, by_angle, by_rate = coriolis_derivatives(case.chain, theta, speed, axes)
            return weight[k] @ by_angle, weight[k] @ by_rate

        expected = (
            step(lambda x, k=k: slopes(x, rates[k])[0], angles[k]),
            step(lambda x, k=k: slopes(x, rates[k])[1], angles[k]),
            step(lambda x, k=k: slopes(angles[k], x)[1], rates[k]),
        )
        for block, exact in zip(found, expected, strict=True):
            np.testing.assert_allclose(block[k], exact, rtol=0, atol=1e-12)
