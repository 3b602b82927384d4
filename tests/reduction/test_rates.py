"""Adapted joint rates: what they turn the seat with, and their derivatives by differences."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.model.arrays import Floats
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.reduction.rates import DAMPING_BELOW, AdaptedRates, DesiredRates, Rates
from tests.support.differences import along

Q = 7
CHAIN = chain_of(DES, Seat())
JOINT = {"scalar": np.ones((3, 1)), "per-joint": np.eye(3)}
SINGULAR = np.pi / 2
CONTROLS = pytest.mark.parametrize("control", list(JOINT))
DAMPED = pytest.mark.parametrize("fork", [0.3, SINGULAR - 0.2, SINGULAR], ids=str)


def angles_of(fork: float) -> Floats:
    """Desired angles at the points, with a fork at an angle."""
    angle = np.random.default_rng(1).uniform(-1.0, 1.0, (Q, 3))
    angle[:, 1] = fork
    return angle


RATE = np.random.default_rng(2).uniform(-1.0, 1.0, (Q, 3))


def adapted(fork: float, control: str) -> tuple[AdaptedRates, Floats]:
    """Rates about desired angles, and an iterate a little beside these."""
    rng, angle, joint = np.random.default_rng(3), angles_of(fork), JOINT[control]
    off = 0.03 * rng.normal(size=(Q, 3))
    factors = rng.uniform(0.3, 1.4, (Q, joint.shape[1]))
    return AdaptedRates(CHAIN, angle, RATE, joint), np.hstack([angle + off, factors])


def seat_rate(angle: Floats, rate: Floats) -> Floats:
    """The angular velocity in ground axes, a sum over the joints."""
    return np.asarray(np.einsum("kjc,kj->kc", CHAIN.ground_axes(angle), rate))


def require_true_derivatives(rates: Rates, x: Floats) -> None:
    """Compare Jacobian and curvature with differences of value and Jacobian."""
    rng = np.random.default_rng(4)
    move, multiplier = rng.normal(size=x.shape), rng.normal(size=(Q, 3))
    value, jacobian = rates.expand(x)
    np.testing.assert_allclose(value, rates.value(x), rtol=0, atol=1e-14)
    change = (jacobian @ move[:, :, None])[..., 0]
    expected = along(rates.value, x, move, 1e-4)
    np.testing.assert_allclose(change, expected, rtol=1e-7, atol=1e-8)

    def gradient(at: Floats) -> Floats:
        return np.asarray((multiplier[:, None, :] @ rates.expand(at)[1])[:, 0])

    curvature = rates.curvature(x, multiplier)
    assert (curvature is None) is isinstance(rates, DesiredRates)
    bend = 0.0 * x if curvature is None else (curvature @ move[:, :, None])[..., 0]
    np.testing.assert_allclose(bend, along(gradient, x, move, 1e-4), rtol=1e-6, atol=1e-6)


@CONTROLS
def test_desired_rates_are_multiplied_by_their_factors(control: str) -> None:
    rates, joint = DesiredRates(RATE, JOINT[control]), JOINT[control]
    x = np.random.default_rng(5).normal(size=(Q, 3 + joint.shape[1]))
    np.testing.assert_allclose(rates.value(x), x[:, 3:] * RATE, rtol=1e-14)
    require_true_derivatives(rates, x)


@CONTROLS
@DAMPED
def test_derivatives_of_adapted_rates_damped_or_not(control: str, fork: float) -> None:
    rates, x = adapted(fork, control)
    require_true_derivatives(rates, x)
    curvature = rates.curvature(x, RATE)
    np.testing.assert_allclose(curvature, curvature.swapaxes(1, 2), rtol=1e-9, atol=1e-9)


def test_where_nothing_is_damped_unit_factors_turn_the_seat_as_desired() -> None:
    rates, x = adapted(0.3, "per-joint")
    x[:, 3:] = 1.0
    assert np.abs(x[:, :3] - angles_of(0.3)).max() > 0.03
    found = seat_rate(x[:, :3], rates.value(x))
    np.testing.assert_allclose(found, seat_rate(angles_of(0.3), RATE), rtol=0, atol=1e-13)


@DAMPED
def test_on_the_desired_angles_the_rates_are_the_desired_ones(fork: float) -> None:
    rates, x = adapted(fork, "per-joint")
    x[:, :3] = angles_of(fork)
    np.testing.assert_allclose(rates.value(x), x[:, 3:] * RATE, rtol=0, atol=1e-13)


def test_damped_rates_are_the_least_squares_of_what_is_missing() -> None:
    """At the singularity: |W - J phi|^2 + 0.3^2 |phi - Theta'|^2 is least."""
    angle = angles_of(SINGULAR)
    rates = AdaptedRates(CHAIN, angle + np.array([0.1, 0.3, 0.0]), RATE, np.eye(3))
    found = rates.value(np.hstack([angle, np.ones((Q, 3))]))
    missing = seat_rate(angle + np.array([0.1, 0.3, 0.0]), RATE) - seat_rate(angle, RATE)
    for k in range(Q):
        jacobian = CHAIN.ground_axes(angle[k]).T
        assert np.linalg.det(jacobian) == pytest.approx(0.0, abs=1e-12)
        stacked = np.vstack([jacobian, 0.3 * np.eye(3)])
        more = np.linalg.lstsq(stacked, np.append(missing[k], np.zeros(3)), rcond=None)[0]
        np.testing.assert_allclose(found[k], RATE[k] + more, rtol=0, atol=1e-12)
        assert np.linalg.norm(more) <= np.linalg.norm(missing[k]) / 0.6


def test_the_damping_sets_in_smoothly() -> None:
    """Where |det J| = |cos fork| falls below its bound, the slope of the rates does not jump."""
    rates, x = adapted(0.3, "per-joint")
    slopes = []
    for beyond in (-1e-7, 1e-7):
        x[:, 1] = np.arccos(DAMPING_BELOW) + beyond
        slopes.append(rates.expand(x)[1])
    np.testing.assert_allclose(slopes[0], slopes[1], rtol=0, atol=1e-4)
