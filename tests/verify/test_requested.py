"""What is requested for beyond a joint motion, as the verification has it."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion, Shortfall
from des_cli.model.profile import BodyRates, GCommand, Profile
from des_cli.verify.felt import SeatChain
from des_cli.verify.requested import as_requested

RNG = np.random.default_rng(6)


def case():
    t = np.linspace(0.0, 1.0, 11)
    angle, rate = RNG.normal(size=(11, 3)), RNG.normal(size=(11, 3))
    motion = Motion(t, angle, rate[:-1], rate[1:])
    command = BodyRates(*RNG.normal(size=(3, 10, 3)))
    shortfall = Shortfall(*RNG.normal(size=(3, 10, 2, 3)), RNG.normal(size=(11, 3)))
    felt = SeatChain(DES, Seat()).along(motion)
    return felt, Profile("p", t, command, DES), shortfall


def test_recorded_rates_are_the_profiles_own():
    felt, profile, shortfall = case()
    requested = as_requested(felt, profile.command, shortfall)
    command = profile.command
    assert isinstance(command, BodyRates)
    np.testing.assert_array_equal(requested.rate[:, :10].T, command.start)
    np.testing.assert_array_equal(requested.rate[:, 10:].T, command.end)


def test_a_requested_g_is_the_profiles_own():
    felt, _, shortfall = case()
    command = GCommand(*RNG.normal(size=(2, 10, 3)))
    requested = as_requested(felt, command, shortfall)
    np.testing.assert_array_equal(requested.g[:, :10].T, command.start)
    np.testing.assert_array_equal(requested.g[:, 10:].T, command.end)
    missing = requested.rate - felt.rate
    np.testing.assert_allclose(missing[:, :10].T, shortfall.seat_rate[:, 0], atol=1e-12)


def test_the_rest_is_what_is_made_and_what_is_missing():
    felt, profile, shortfall = case()
    requested = as_requested(felt, profile.command, shortfall)
    for field, sides in (
        ("g", shortfall.seat_g),
        ("turning", shortfall.seat_angular_acceleration),
    ):
        added = getattr(requested, field) - getattr(felt, field)
        np.testing.assert_allclose(added[:, :10].T, sides[:, 0], atol=1e-12)
        np.testing.assert_allclose(added[:, 10:].T, sides[:, 1], atol=1e-12)
    np.testing.assert_array_equal(requested.cross, felt.cross)
    made = Rotation.from_matrix(np.moveaxis(felt.rotation, 2, 0))
    turn = np.concatenate([shortfall.attitude[:-1], shortfall.attitude[1:]])
    expected = (made * Rotation.from_rotvec(turn)).as_matrix()
    np.testing.assert_allclose(np.moveaxis(requested.rotation, 2, 0), expected, atol=1e-12)


def test_nothing_missing_is_the_motion_itself():
    felt, profile, _ = case()
    assert as_requested(felt, profile.command, None) is felt
