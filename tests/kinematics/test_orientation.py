from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of, seat_rotation
from des_cli.kinematics.orientation import (
    SINGULAR_VALUE_THRESHOLD,
    body_jacobian,
    damped_inverse_rates,
    ground_jacobian,
    least_singular_value,
    smallest_singular_value,
)
from des_cli.model.machine import DHRow, Seat
from des_cli.model.machines import DES

CHAIN = chain_of(DES, Seat())


def test_reference_states(state, same):
    same(ground_jacobian(state.chain, state["q"]), state["J_inertial"])
    same(body_jacobian(state.chain, state["q"]), state["J_body_frame17"])
    same(body_jacobian(state.chain, state["q"]) @ state["qd"], state["W_body"])
    same(np.linalg.det(ground_jacobian(state.chain, state["q"])), state["det_J2"])


def test_body_jacobian_is_the_ground_one_turned_into_the_seat(case, rng):
    angles = rng.uniform(-7.0, 7.0, (100, 3))
    turned = seat_rotation(case.chain, angles).swapaxes(-1, -2) @ ground_jacobian(
        case.chain, angles
    )
    np.testing.assert_allclose(body_jacobian(case.chain, angles), turned, rtol=0, atol=1e-14)


@pytest.mark.parametrize("jacobian", [ground_jacobian, body_jacobian])
@pytest.mark.parametrize("seat", [Seat(), Seat(0.8, 0.3)])
def test_determinant_and_singular_values_of_the_des(jacobian, seat, rng):
    angles = rng.uniform(-7.0, 7.0, (1000, 3))
    matrices = jacobian(chain_of(DES, seat), angles)
    s2 = np.sin(angles[:, 1])
    np.testing.assert_allclose(np.linalg.det(matrices), np.cos(angles[:, 1]), rtol=0, atol=1e-14)
    expected = np.sort(np.stack([np.ones(1000), np.sqrt(1 + s2), np.sqrt(1 - s2)], -1))[:, ::-1]
    found = np.linalg.svd(matrices, compute_uv=False)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13)
    np.testing.assert_allclose(
        smallest_singular_value(matrices), expected[:, -1], rtol=0, atol=1e-13
    )


def test_the_least_singular_value_is_that_of_all_samples(case, rng):
    """However the fork moves: anywhere, near the singularity, not at all."""
    for fork in (
        rng.uniform(-7.0, 7.0, 400),
        rng.uniform(0.2, 1.2, 400),
        np.pi / 2 + rng.normal(scale=1e-7, size=400),
        -np.pi / 2 + 1e-3 + rng.normal(scale=1e-5, size=400),
        np.full(400, 0.7),
    ):
        angles = np.stack([rng.uniform(-7.0, 7.0, 400), fork, rng.uniform(-7.0, 7.0, 400)], -1)
        expected = np.min(np.linalg.svd(ground_jacobian(case.chain, angles), compute_uv=False))
        assert least_singular_value(case.chain, angles) == pytest.approx(expected, abs=1e-14)


def test_the_least_singular_value_of_oblique_axes(rng):
    """Where no two axes are at right angles it is at either end of the fork's travel."""
    rows = (
        DHRow(variable="arm"),
        DHRow(alpha=0.7, a=1.0, variable="fork"),
        DHRow(alpha=-1.1, d=0.3, sign=-1, variable="cab"),
        DHRow(alpha=0.4),
    )
    chain = chain_of(replace(DES, rows=rows), Seat())
    for middle in np.linspace(-3.0, 3.0, 13):
        angles = np.array([0.0, middle, 0.0]) + rng.uniform(-0.8, 0.8, (400, 3))
        expected = np.min(np.linalg.svd(ground_jacobian(chain, angles), compute_uv=False))
        assert least_singular_value(chain, angles) == pytest.approx(expected, abs=1e-14)


def test_well_conditioned_inverse_is_exact(case, rng):
    angles = rng.uniform(-7.0, 7.0, (500, 3))
    matrices = body_jacobian(case.chain, angles)
    good = smallest_singular_value(matrices) >= SINGULAR_VALUE_THRESHOLD
    assert 100 < good.sum() < 500
    rates = rng.uniform(-2.0, 2.0, (500, 3))
    w = (matrices @ rates[..., None])[..., 0]
    found, damped, residual = damped_inverse_rates(matrices, w)
    np.testing.assert_array_equal(damped, ~good)
    np.testing.assert_allclose(found[good], rates[good], rtol=0, atol=1e-12)
    np.testing.assert_allclose(residual[good], 0.0, atol=1e-13)


def test_round_trip_through_the_singularity():
    """A W made by J Theta' gives Theta' back, on the singularity as well."""
    fork = np.deg2rad(np.linspace(60.0, 120.0, 121))
    assert np.any(fork == np.pi / 2)
    angles = np.stack([np.linspace(0.0, 3.0, 121), fork, np.linspace(1.0, -1.0, 121)], -1)
    rates = np.stack([np.linspace(1.0, 2.0, 121), np.cos(fork), np.linspace(-1.0, 0.5, 121)], -1)
    matrices = body_jacobian(CHAIN, angles)
    w = (matrices @ rates[..., None])[..., 0]
    found, damped, residual = damped_inverse_rates(matrices, w, reference=rates)
    np.testing.assert_allclose(found, rates, rtol=0, atol=1e-14)
    np.testing.assert_allclose(residual, 0.0, atol=1e-14)
    assert damped[60]
    assert not damped[0]
    lost, _, short = damped_inverse_rates(matrices, w)
    assert np.abs(lost[60] - rates[60]).max() > 0.1  # without the reference it is lost
    np.testing.assert_allclose(short[60], 0.0, atol=1e-14)  # though W itself is reached


def test_a_rate_that_no_joint_can_make_stays_as_residual():
    angles = np.array([0.4, np.pi / 2, 0.2])
    matrix = body_jacobian(CHAIN, angles)
    lost_direction = np.linalg.svd(matrix)[0][:, -1]
    rates, damped, residual = damped_inverse_rates(matrix, 0.7 * lost_direction)
    assert bool(damped)
    np.testing.assert_allclose(rates, 0.0, atol=1e-14)
    np.testing.assert_allclose(residual, 0.7 * lost_direction, atol=1e-14)


def test_gain_and_residual_are_bounded(case, rng):
    """Random demands near the singularity: 1.14/threshold bounds the rates' gain."""
    angles = rng.uniform(-7.0, 7.0, (20000, 3))
    angles[::2, 1] = np.pi / 2 + rng.normal(scale=0.05, size=10000)
    matrices = body_jacobian(case.chain, angles)
    w = rng.normal(size=(20000, 3))
    reference = rng.normal(size=(20000, 3))
    rates, damped, residual = damped_inverse_rates(matrices, w, reference=reference)
    assert damped.sum() > 100
    missing = w - (matrices @ reference[..., None])[..., 0]
    length = np.linalg.norm(missing, axis=-1)
    gain = np.linalg.norm(rates - reference, axis=-1) / length
    assert gain.max() <= 1.1399 / SINGULAR_VALUE_THRESHOLD
    assert np.all(np.linalg.norm(residual, axis=-1) <= length * (1 + 1e-12) + 1e-12)
    made = w - (matrices @ rates[..., None])[..., 0]
    np.testing.assert_allclose(residual, made, rtol=0, atol=1e-13)


def test_damping_sets_in_smoothly():
    """Value and slope of the rates are continuous where the damping begins."""
    threshold = SINGULAR_VALUE_THRESHOLD
    onset = np.arcsin(1 - threshold**2)
    h = 1e-5
    fork = onset + h * np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    angles = np.stack([np.zeros(5), fork, np.full(5, 0.3)], -1)
    matrices = body_jacobian(CHAIN, angles)
    rates, damped, _ = damped_inverse_rates(matrices, np.array([0.3, -0.2, 0.5]) + np.zeros((5, 3)))
    assert damped.tolist()[3:] == [True, True]
    assert damped.tolist()[:2] == [False, False]
    slope = np.diff(rates, axis=0) / h
    scale = np.abs(slope).max()
    assert scale > 1.0
    np.testing.assert_allclose(slope[2:], slope[:2], rtol=0, atol=0.02 * scale)


def test_threshold_and_damping_can_be_chosen(rng):
    matrix = body_jacobian(CHAIN, np.array([0.0, 1.4, 0.3]))  # singular value 0.12
    w = rng.normal(size=3)
    assert not damped_inverse_rates(matrix, w)[1]
    wide, damped, residual = damped_inverse_rates(matrix, w, threshold=0.2)
    assert damped
    assert np.linalg.norm(residual) > 1e-3
    free, _, none = damped_inverse_rates(matrix, w, threshold=0.2, max_damping=0.0)
    np.testing.assert_allclose(none, 0.0, atol=1e-13)
    assert np.linalg.norm(free) > np.linalg.norm(wide)
    dead = damped_inverse_rates(np.diag([1.0, 1.0, 0.0]), np.ones(3), max_damping=0.0)
    np.testing.assert_array_equal(dead[0], [1.0, 1.0, 0.0])
    np.testing.assert_array_equal(dead[2], [0.0, 0.0, 1.0])
