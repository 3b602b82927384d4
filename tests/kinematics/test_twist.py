"""The seat's twist against the kinematics by frames, closed forms and finite differences."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of, joint_axes, linear_jacobian
from des_cli.kinematics.coriolis import angular_acceleration_split, coriolis
from des_cli.kinematics.seat import in_seat_axes, linear_acceleration_parts, specific_force
from des_cli.kinematics.twist import VARIABLES, seat_forms
from des_cli.model.machine import DHRow, Seat
from des_cli.model.machines import COVISART, DES, JOHNSVILLE
from des_cli.units import FOOT_M, STANDARD_GRAVITY_M_S2
from tests.support.seat_forms import by_closed_forms

MACHINES = (DES, JOHNSVILLE, COVISART)
SEATS = (Seat(), Seat(0.0, 0.0), Seat(0.8, -0.3), Seat(-2.1, 1.2))
STEP = 1e-6
UPPER = np.triu_indices(VARIABLES)


@pytest.fixture(params=MACHINES, ids=lambda machine: machine.name)
def machine(request):
    return request.param


@pytest.fixture(params=SEATS, ids=lambda seat: f"{seat.yaw:.1f},{seat.pitch:.1f}")
def seat(request):
    return request.param


@pytest.fixture
def states(rng):
    """Angles (the arm's too), rates and accelerations at 30 points, (3, m) each."""
    return rng.uniform(-3.0, 3.0, (3, 3, 30))


def variables(states):
    """What the forms take of the states, (8, m)."""
    return np.concatenate([states[0, 1:], states[1], states[2]])


def quantities(motion):
    """W, c, dW/dt and the force, (4, 3, m)."""
    return np.stack([motion.twist[:3], motion.products[:3], motion.twist_rate[:3], motion.force])


def differences(function, z, step=STEP):
    """Central differences by each variable, (8, ...)."""
    return np.stack(
        [
            (function(z + step * unit[:, None]) - function(z - step * unit[:, None])) / (2 * step)
            for unit in np.eye(VARIABLES)
        ]
    )


def test_against_the_kinematics_by_frames(machine, seat, states):
    chain = chain_of(machine, seat)
    angles, rates, accelerations = (each.T for each in states)
    motion = seat_forms(chain, machine.gravity).at(variables(states))
    spin = (rates[:, None, :] @ joint_axes(chain, angles, "seat"))[:, 0]
    np.testing.assert_allclose(motion.twist[:3].T, spin, atol=1e-12)
    speed = (linear_jacobian(chain, angles) @ rates[..., None])[..., 0]
    np.testing.assert_allclose(
        motion.twist[3:].T, in_seat_axes(chain, angles, speed[:, None])[:, 0], atol=1e-10
    )
    euler, cross = angular_acceleration_split(chain, angles, rates, accelerations, "seat")
    np.testing.assert_allclose(motion.products[:3].T, cross, atol=1e-12)
    np.testing.assert_allclose(
        motion.products[:3].T, coriolis(chain, angles, rates, "seat"), atol=1e-12
    )
    np.testing.assert_allclose(motion.twist_rate[:3].T, euler + cross, atol=1e-12)
    parts = linear_acceleration_parts(chain, angles, rates, accelerations)
    force = specific_force(chain, angles, parts.sum(axis=-2), machine.gravity)
    np.testing.assert_allclose(motion.force.T, STANDARD_GRAVITY_M_S2 * force, atol=1e-9)


def test_the_closed_forms_of_the_study(states):
    angles, rates, accelerations = (each.T for each in states)
    felt = by_closed_forms(angles, rates, accelerations)  # yaw 90 degrees, pitch 0
    motion = seat_forms(chain_of(DES, Seat()), DES.gravity).at(variables(states))
    np.testing.assert_allclose(motion.twist[:3].T, felt.rate, atol=1e-12)
    np.testing.assert_allclose(motion.products[:3].T, felt.cross, atol=1e-12)
    np.testing.assert_allclose(motion.twist_rate[:3].T, felt.turning, atol=1e-12)
    in_g = motion.force.T / (32.2 * FOOT_M) * [1.0, 1.0, -1.0]
    np.testing.assert_allclose(in_g, felt.g, atol=1e-11)


def test_slopes_are_those_of_finite_differences(machine, seat, states):
    forms = seat_forms(chain_of(machine, seat), machine.gravity)
    z = variables(states)
    motion = forms.at(z)
    for name in ("twist", "products", "twist_rate", "force"):
        slope = getattr(motion, f"{name}_slope")
        expected = differences(lambda at, name=name: getattr(forms.at(at), name), z)
        np.testing.assert_allclose(slope, expected[: len(slope)], rtol=1e-7, atol=1e-6)
        assert not expected[len(slope) :].any()  # what is left out does not matter


@pytest.mark.parametrize("weighed", [(0,), (1,), (2,), (3,), (0, 1), (2, 3), (0, 1, 2, 3)], ids=str)
def test_curvature_is_that_of_finite_differences(machine, seat, states, rng, weighed):
    forms = seat_forms(chain_of(machine, seat), machine.gravity)
    z = variables(states)
    multipliers = np.zeros((4, 3, z.shape[1]))
    multipliers[list(weighed)] = rng.normal(size=(len(weighed), 3, z.shape[1]))

    def gradient(at):
        motion, total = forms.at(at), np.zeros((VARIABLES, z.shape[1]))
        slopes = (
            motion.twist_slope[:, :3],
            motion.products_slope[:, :3],
            motion.twist_rate_slope[:, :3],
            motion.force_slope,
        )
        for slope, multiplier in zip(slopes, multipliers, strict=True):
            total[: len(slope)] += np.einsum("kcm,cm->km", slope, multiplier)
        return total

    omega, products, rate, force = (
        multiplier if k in weighed or k == 1 else None for k, multiplier in enumerate(multipliers)
    )
    found = forms.at(z).curvature(omega, products, rate, force)
    expected = differences(gradient, z)[UPPER]
    np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-5)


def test_mapped_forms_give_mapped_quantities(states, rng):
    forms = seat_forms(chain_of(DES, Seat()), DES.gravity)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.linalg.det(turn)  # a rotation: cross products turn with their factors
    twist = np.kron(np.eye(2), turn)
    mapped = forms.changed(twist, turn).at(variables(states))
    expected = turn @ quantities(forms.at(variables(states)))
    np.testing.assert_allclose(quantities(mapped), expected, atol=1e-10)


def test_an_arm_that_turns_about_the_vertical(machine, seat):
    assert seat_forms(chain_of(machine, seat), machine.gravity).vertical


@pytest.mark.parametrize("tilt", [0.3, 1e-6])
def test_an_arm_that_does_not(machine, tilt):
    leaning = replace(machine, rows=(DHRow(alpha=tilt), *machine.rows))
    assert not seat_forms(chain_of(leaning, Seat()), machine.gravity).vertical
    # without gravity there is nothing that tells one azimuth from another
    assert seat_forms(chain_of(leaning, Seat()), 0.0).vertical
