"""The desired motion of each kind of profile."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.response import respond
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.profile import BodyRates, GCommand, Profile, Reduction
from des_cli.reduction.desired import find_desired
from des_cli.reduction.limits import find_violations
from tests.support.claims import profile_of
from tests.support.free_motions import smooth

T = np.linspace(0.0, 2.0, 41)
HELD_G = np.tile([0.0, 0.0, 2.0], (40, 1))


@pytest.mark.parametrize("limits", ["enforce", "warn"])
def test_joint_commands_say_what_the_joints_do_beyond_their_limits_too(limits: str) -> None:
    wanted = smooth(40, amplitude=((0.6, 0.0), (4.0, 0.0), (0.0, 0.2)))  # the fork turns too fast
    asked = profile_of(wanted, Reduction(limits=limits))  # type: ignore[arg-type]
    motion = find_desired(asked).motion
    assert find_violations(DES, motion, "desired")
    np.testing.assert_array_equal(motion.angle[:, 1:], wanted.angle[:, 1:])
    np.testing.assert_allclose(motion.rate_start, wanted.rate_start, rtol=0, atol=1e-15)


def test_body_rates_are_those_of_the_seat_and_may_need_more_rows() -> None:
    """A roll from 0 to 2 rad/s and back that 5 rows say roughly."""
    t = np.linspace(0.0, 2.0, 5)
    roll = np.stack([1.0 - np.cos(np.pi * t), 0.0 * t, 0.0 * t], axis=1)
    middle = np.stack([1.0 - np.cos(np.pi * (t[:-1] + 0.25)), *np.zeros((2, 4))], axis=1)
    rates = BodyRates(roll[:-1], middle, roll[1:])
    profile = Profile("roll", t, rates, DES, initial_angle=np.array([0.0, 0.3, 0.2]))
    plain, divided = find_desired(profile, divide=False), find_desired(profile)
    np.testing.assert_array_equal(plain.motion.t, t)
    assert len(divided.motion.t) > len(t)
    felt = respond(DES, Seat(), divided.motion).seat_rate
    at = np.searchsorted(divided.motion.t, 1.0)
    np.testing.assert_allclose(felt[at, 0], [2.0, 0.0, 0.0], rtol=0, atol=1e-9)


def test_an_asked_g_is_followed_inside_the_limits_whatever_is_asked_of_them() -> None:
    profile = Profile("g", T, GCommand(HELD_G, HELD_G), DES, reduction=Reduction(limits="warn"))
    found = find_desired(profile)
    assert find_violations(DES, found.motion, "desired") == ()
    assert found.g_offset is not None
    made = respond(DES, profile.seat, found.motion).seat_g
    off = np.linalg.norm(made - [0.0, 0.0, 2.0], axis=-1)
    assert found.g_offset.largest == pytest.approx(off.max(), rel=1e-9)
    assert off.max() < 0.01
