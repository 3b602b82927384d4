"""Recorded angles: what wraps is unwrapped, what is unclear refused, the rest followed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from des_cli.errors import ProfileError
from des_cli.model.profile import JointCommands, Profile
from des_cli.profiles_in.angles import unwrap
from des_cli.profiles_in.load import load_profile

JOINTS = "t_s,arm_rpm,fork_deg,cab_deg\n"


def load(fork: list[float], step: float = 0.1) -> Profile:
    rows = (f"{step * row:.6g},10,{angle!r},0\n" for row, angle in enumerate(fork))
    return load_profile("-", stdin=(JOINTS + "".join(rows)).encode())


@settings(max_examples=100)
@given(steps=st.lists(st.floats(-0.6, 0.6), min_size=12, max_size=60), first=st.floats(-3.0, 3.0))
def test_a_wrapped_angle_is_found_again(steps: list[float], first: float) -> None:
    angle = first + np.concatenate([[0.0], np.cumsum(steps)])
    wrapped = np.mod(angle + np.pi, 2 * np.pi) - np.pi
    found = unwrap(wrapped)
    assert not found.unclear
    np.testing.assert_allclose(found.angle - found.angle[0], angle - angle[0], atol=1e-12)
    jumps = np.flatnonzero(np.abs(np.diff(wrapped)) > np.pi)
    assert found.jumps == jumps.tolist()


def test_rows_that_flicker_about_half_a_turn_are_one_angle() -> None:
    found = unwrap(np.radians([179.0, -179.0, 178.0, -178.0, 179.0]))
    np.testing.assert_allclose(np.degrees(found.angle), [179, 181, 178, 182, 179], atol=1e-12)


def test_a_joint_that_turns_fast_from_row_to_row_is_followed() -> None:
    angle = np.radians(240.0) * np.arange(8)
    np.testing.assert_array_equal(unwrap(angle).angle, angle)
    assert not unwrap(angle).jumps


def test_a_fork_that_wraps_moves_as_the_one_that_does_not_and_is_named() -> None:
    wrapped = [170.0 + row for row in range(10)] + [-180.0 + row for row in range(11)]
    profile, plain = load(wrapped), load([170.0 + row for row in range(21)])
    assert isinstance(profile.command, JointCommands)
    assert isinstance(plain.command, JointCommands)
    np.testing.assert_allclose(profile.command.position, plain.command.position, atol=1e-12)
    np.testing.assert_allclose(profile.command.rate_start, plain.command.rate_start, atol=1e-9)
    assert profile.remarks == (
        "line 12: fork_deg jumps from 179 to -180 deg; the angle wraps there, and full turns "
        "were added so that it goes on",
    )
    assert plain.remarks == ()


@pytest.mark.parametrize("fork", [[0, 1, 2, 3, 203, 204, 205], [0, 350], [0, 1, 340]])
def test_a_jump_that_is_no_full_turn_or_may_be_one_is_refused(fork: list[float]) -> None:
    with pytest.raises(ProfileError, match=r"<stdin>:\d: fork_deg: jumps from \d+ to \d+ deg"):
        load(fork)


def test_the_arm_may_be_given_by_its_angle() -> None:
    t = np.arange(0.0, 2.0, 0.1)
    rows = "".join(f"{at:.6g},{30 + 60 * at + 5 * at**2:.9f},{at:.6g},0\n" for at in t)
    text = f"t,J1,J2,J3\n{rows}"
    columns = {"t_s": "t", "arm_deg": "J1", "fork_deg": "J2", "cab_deg": "J3"}
    profile = load_profile("-", stdin=text.encode(), columns=columns)
    assert isinstance(profile.command, JointCommands)
    np.testing.assert_allclose(np.degrees(profile.command.arm_rate), 60 + 10 * t, atol=1e-5)
    assert np.degrees(profile.initial_angle[0]) == pytest.approx(30.0)


def test_an_arm_angle_in_a_profile_is_differentiated_exactly() -> None:
    text = (
        "format: des-coriolis/1\ntime: {start_s: 0, stop_s: 2, step_s: 0.5}\n"
        "joints: {arm_deg: '10 + 90*sin(t)', fork_deg: 0, cab_deg: 0}\n"
    )
    profile = load_profile("-", stdin=text.encode())
    assert isinstance(profile.command, JointCommands)
    want = np.radians(90.0) * np.cos(profile.t)
    np.testing.assert_allclose(profile.command.arm_rate, want, rtol=0, atol=1e-14)
    assert profile.initial_angle[0] == pytest.approx(np.radians(10.0))
    with pytest.raises(ProfileError, match="arm_deg: the arm starts where its position"):
        load_profile("-", stdin=f"{text}initial: {{arm_deg: 3}}\n".encode())


def test_where_an_arm_angle_has_a_corner_the_velocity_is_the_mean_of_both_sides() -> None:
    text = (
        "format: des-coriolis/1\ntime: {start_s: 0, stop_s: 2, step_s: 0.5}\n"
        "joints:\n  arm_deg:\n    - {from_s: 0, to_s: 1, value: 10*t}\n"
        "    - {from_s: 1, to_s: 2, value: 10 + 30*(t - 1)}\n  fork_deg: 0\n  cab_deg: 0\n"
    )
    command = load_profile("-", stdin=text.encode()).command
    assert isinstance(command, JointCommands)
    np.testing.assert_allclose(np.degrees(command.arm_rate), [10, 10, 20, 30, 30])
