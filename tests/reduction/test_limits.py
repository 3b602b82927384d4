"""Every broken limit is named, with its joint, its quantity and its time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.reduction.limits import acceleration_magnitude, find_violations, measure_peaks

T = np.linspace(0.0, 4.0, 41)
JOINTS = list(enumerate(["arm", "fork", "cab"]))


def from_rates(start, end=None, t=T, angle=0.0):
    """A motion of rates at both ends of every interval, its angles their integral."""
    end = start[1:] if end is None else end
    start = start[:-1] if len(start) == len(t) else start
    moved = np.cumsum(0.5 * np.diff(t)[:, None] * (start + end), axis=0)
    return Motion(t, angle + np.vstack([np.zeros(3), moved]), start, end)


def quiet():
    return from_rates(np.stack([0.3 + 0.1 * np.sin(T), 0.2 * np.cos(T), 0.1 * T], axis=1))


def test_nothing_to_say_of_a_motion_inside_its_limits():
    assert find_violations(DES, quiet(), "desired") == ()


def test_a_limit_itself_is_allowed():
    limits = DES.limits
    rate = np.array([limit.rate for limit in limits])
    assert (
        find_violations(DES, from_rates(np.tile(rate, (41, 1))[:, [0, 1, 2]] * 0.5), "desired")
        == ()
    )
    at_limit = np.zeros((41, 3))
    at_limit[:, 0] = limits[0].acceleration * (T - 2.0)
    assert find_violations(DES, from_rates(at_limit), "desired") == ()


@pytest.mark.parametrize(("joint", "name"), JOINTS)
def test_rate(joint, name):
    rate = np.zeros((41, 3))
    limit = DES.limits[joint]
    rate[:, joint] = -(limit.rate + 0.05) * np.exp(-(((T - 2.0) / 4.0) ** 2))
    machine = replace(DES, limits=tuple(replace(each, angle=np.inf) for each in DES.limits))
    found = [
        v for v in find_violations(machine, from_rates(rate), "modified") if v.quantity == "rate"
    ]
    assert len(found) == 1
    over = T[np.abs(rate[:, joint]) > limit.rate]
    assert (found[0].motion, found[0].joint) == ("modified", name)
    assert found[0].peak == pytest.approx(limit.rate + 0.05)
    assert found[0].limit == limit.rate
    assert (found[0].from_s, found[0].to_s) == (over[0], over[-1])


@pytest.mark.parametrize(("joint", "name"), JOINTS)
def test_acceleration(joint, name):
    limit = DES.limits[joint].acceleration
    rate = np.zeros((41, 3))
    rate[11:14, joint] = np.array([0.05, 0.1, 0.15]) * 2.0 * limit  # 0.1 s steps
    rate[14:17, joint] = rate[13, joint]
    rate[17:, joint] = 0.0
    found = find_violations(DES, from_rates(rate), "desired")
    assert [(v.joint, v.quantity) for v in found] == [(name, "acceleration")]
    assert found[0].peak == pytest.approx(3.0 * limit)
    assert found[0].from_s == pytest.approx(1.6)
    assert found[0].to_s == pytest.approx(1.7)
    text = str(found[0])
    for word in ("desired", name, "acceleration", "rad/s^2", "1.6", "1.7"):
        assert word in text


def test_angle():
    rate = np.zeros((41, 3))
    rate[:, 1:] = 2.0
    found = find_violations(DES, from_rates(rate, angle=np.array([50.0, 0.0, -8.5])), "desired")
    assert [(v.joint, v.quantity) for v in found] == [("fork", "angle"), ("cab", "angle")]
    fork, cab = found  # 2 rad/s from 0 passes 2 pi at 3.14 s; from -8.5 it comes back at 1.11 s
    assert (fork.from_s, fork.to_s) == (pytest.approx(3.2), 4.0)
    assert fork.peak == pytest.approx(8.0)
    assert (cab.from_s, cab.to_s) == (0.0, pytest.approx(1.1))
    assert cab.peak == pytest.approx(8.5)
    assert "rad from" not in str(fork).split("limit")[0]


def test_the_arm_turns_endlessly():
    rate = np.zeros((41, 3))
    rate[:, 0] = 3.0
    assert find_violations(DES, from_rates(rate, angle=100.0 * np.eye(3)[0]), "desired") == ()


def test_a_rate_step_is_a_step_and_not_an_acceleration():
    rate = np.zeros((41, 3))
    rate[:, 2] = -0.05
    start, end = rate[:-1].copy(), rate[1:].copy()
    start[20:, 2] = end[20:, 2] = 0.04
    motion = from_rates(start, end)
    found = find_violations(DES, motion, "desired")
    assert [(v.joint, v.quantity) for v in found] == [("cab", "rate step")]
    assert found[0].peak == pytest.approx(0.09)
    assert found[0].from_s == found[0].to_s == T[20]
    assert f"at t = {T[20]:g} s" in str(found[0])
    peaks = measure_peaks(motion)
    np.testing.assert_allclose(peaks.rate_step, [0.0, 0.0, 0.09], atol=1e-15)
    # A difference across the step would be 0.9 rad/s^2, and grow with a finer grid.
    assert peaks.acceleration[2] < 1e-12


@pytest.mark.parametrize("joint", [1, 2])
def test_a_corner_of_sampled_positions_is_an_acceleration(joint):
    # What a table of positions gives: rates estimated by differences, so that no
    # rate steps, and a corner that only the second difference of the angle shows.
    angle = np.zeros((41, 3))
    angle[:, joint] = 0.5 * np.abs(T - 2.0)
    rate = np.gradient(angle, T, axis=0)
    motion = Motion(T, angle, rate[:-1], rate[1:])
    magnitude = acceleration_magnitude(motion)[:, joint]
    assert np.argmax(magnitude) == 20
    assert magnitude[20] == pytest.approx(2 * 0.5 / 0.1)
    found = find_violations(DES, motion, "desired")
    assert [v.quantity for v in found] == ["acceleration"]
    assert found[0].peak == pytest.approx(10.0)


def test_rounding_of_a_rate_does_not_hide_a_sampled_corner():
    angle = np.zeros((41, 3))
    angle[:, 1] = 0.5 * np.abs(T - 2.0)
    rate = np.gradient(angle, T, axis=0)
    start = rate[:-1].copy()
    start[20, 1] += 1e-16
    found = find_violations(DES, Motion(T, angle, start, rate[1:]), "desired")
    assert found[0].quantity == "acceleration"
    assert found[0].peak == pytest.approx(10.0)


def test_the_arms_angle_is_not_asked_for_its_acceleration():
    angle = np.zeros((41, 3))
    angle[:, 0] = 0.5 * np.abs(T - 2.0)
    still = np.zeros((40, 3))
    assert find_violations(DES, Motion(T, angle, still, still), "desired") == ()


def test_second_differences_on_unequal_steps():
    rng = np.random.default_rng(4)
    t = np.cumsum(rng.uniform(0.05, 0.2, 30))
    angle = np.stack([0 * t, 0.4 * t**2, -0.7 * t**2], axis=1)
    still = np.zeros((29, 3))
    magnitude = acceleration_magnitude(Motion(t, angle, still, still))
    np.testing.assert_allclose(magnitude[1:-1], np.tile([0.0, 0.8, 1.4], (28, 1)), rtol=1e-9)


def test_several_are_all_named():
    rate = np.zeros((41, 3))
    rate[:, 0], rate[:, 1] = 6.0, 3.5
    found = find_violations(DES, from_rates(rate), "modified")
    assert [(v.joint, v.quantity) for v in found] == [
        ("arm", "rate"),
        ("fork", "angle"),
        ("fork", "rate"),
    ]
    assert [str(v).startswith("modified") for v in found] == [True] * 3


def test_two_samples_are_enough():
    motion = Motion(np.array([0.0, 0.1]), np.zeros((2, 3)), np.zeros((1, 3)), np.full((1, 3), 0.1))
    assert [v.joint for v in find_violations(DES, motion, "desired")] == ["arm"]
    assert measure_peaks(motion).rate_step.tolist() == [0.0] * 3
