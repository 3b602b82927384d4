"""Every broken limit is named, with its joint, its quantity and its time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of, seat_rotation
from des_cli.kinematics.response import respond
from des_cli.model.machine import OccupantBounds, Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.model.response import SeatResponse
from des_cli.reduction.limits import (
    acceleration_magnitude,
    angular_acceleration_magnitude,
    find_occupant_violations,
    find_violations,
    jerk_magnitude,
    largest_angle,
    measure_peaks,
    steps_too_short,
)

T = np.linspace(0.0, 4.0, 41)
SMOOTHNESS_ASIDE = replace(DES, limits=tuple(replace(each, jerk=np.inf) for each in DES.limits))
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
    found = find_violations(SMOOTHNESS_ASIDE, from_rates(rate), "desired")
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
    found = find_violations(SMOOTHNESS_ASIDE, motion, "desired")
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


@pytest.mark.parametrize(("joint", "name"), JOINTS)
def test_jerk(joint, name):
    limit = DES.limits[joint]
    rate = np.zeros((41, 3))
    # the acceleration climbs by 1.5 times what the jerk limit admits, from 1.0 to 1.2 s
    slope = 1.5 * limit.jerk
    rate[:, joint] = 0.5 * slope * np.clip(T - 1.0, 0.0, 0.2) ** 2
    rate[:, joint] += 0.2 * slope * np.clip(T - 1.2, 0.0, None)
    machine = replace(
        DES,
        limits=tuple(
            replace(each, acceleration=9.0, rate=99.0, angle=np.inf) for each in DES.limits
        ),
    )
    motion = from_rates(rate)
    (found,) = find_violations(machine, motion, "modified")
    assert (found.joint, found.quantity, found.limit) == (name, "jerk", limit.jerk)
    # intervals see the mean of a ramp: the first and the last difference is half of it
    assert found.peak == pytest.approx(slope)
    assert (found.from_s, found.to_s) == (pytest.approx(1.1), pytest.approx(1.1))
    assert measure_peaks(motion).jerk[joint] == pytest.approx(slope)
    assert f"modified {name} jerk" in str(found)
    assert "rad/s^3 at t = 1.1 s" in str(found)


def test_jerk_on_unequal_steps_is_the_third_derivative():
    rng = np.random.default_rng(8)
    t = np.cumsum(rng.uniform(0.05, 0.2, 30))
    rate = np.stack([0.5 * t**2, -0.1 * t**2, 0.3 * t], axis=1)
    jerk = jerk_magnitude(from_rates(rate, t=t))
    np.testing.assert_allclose(jerk[1:-1], np.tile([1.0, 0.2, 0.0], (28, 1)), rtol=0, atol=1e-9)
    assert not jerk[[0, -1]].any()


def test_a_rate_step_is_no_jerk_but_a_step_of_the_acceleration_is():
    rate = np.zeros((41, 3))
    rate[:, 2] = -0.05
    start, end = rate[:-1].copy(), rate[1:].copy()
    start[20:, 2] = end[20:, 2] = 0.04
    assert measure_peaks(from_rates(start, end)).jerk[2] < 1e-9
    rate[:, 2] = np.abs(T - 2.0)  # 2 rad/s^2 from one interval to the next
    assert measure_peaks(from_rates(rate)).jerk[2] == pytest.approx(2.0 / 0.1)


@pytest.mark.parametrize("which", ["desired", "modified"])
def test_rounding_of_doubles_at_a_fine_step_breaks_no_jerk_limit(which):
    # At the limit for 1 s at 20 kHz: rounding of the rates is divided by 2.5e-9 s^2.
    t = np.linspace(0.0, 1.0, 20001)
    limits = np.array([limit.jerk for limit in DES.limits])
    rate = 0.5 * limits * (t[:, None] - 0.5) ** 2
    machine = replace(DES, limits=tuple(replace(each, acceleration=9.0) for each in DES.limits))
    motion = from_rates(rate, t=t)
    assert np.any(jerk_magnitude(motion) > limits * (1.0 + 1e-9))
    assert find_violations(machine, motion, which) == ()
    over = find_violations(machine, from_rates(1.001 * rate, t=t), which)
    assert [(v.joint, v.quantity) for v in over] == [
        ("arm", "jerk"),
        ("fork", "jerk"),
        ("cab", "jerk"),
    ]


def table_of_positions(digits):
    """What reading a table of the fork's positions makes of a gentle swing."""
    t = np.linspace(0.0, 4.0, 401)
    angle = np.zeros((401, 3))
    angle[:, 1] = np.round(0.1 * np.sin(t), digits)
    rate = np.gradient(angle, t, axis=0)
    return Motion(t, angle, rate[:-1], rate[1:])


def test_a_table_of_few_digits_does_command_the_jerk_of_its_stairs():
    assert find_violations(DES, table_of_positions(12), "desired") == ()
    found = find_violations(DES, table_of_positions(4), "desired")
    assert ("fork", "jerk") in [(v.joint, v.quantity) for v in found]


def response_of(seat_g):
    """A response that has a G-vector and nothing else."""
    nothing = np.zeros_like(seat_g)
    return SeatResponse(nothing, nothing, nothing, seat_g)


def still(t=T):
    return Motion(t, np.zeros((len(t), 3)), *[np.zeros((len(t) - 1, 3))] * 2)


def occupant(**bounds):
    return replace(DES, occupant=OccupantBounds(**bounds))


def g_of(component):
    """A G-vector whose one component is linear between the samples of T."""
    index, values = component
    sides = np.zeros((40, 2, 3))
    sides[..., 2] = 1.0
    sides[..., index] = np.stack([values[:-1], values[1:]], axis=1)
    return response_of(sides)


@pytest.mark.parametrize(("index", "name"), list(enumerate(["gx", "gy", "gz"])))
def test_both_ends_of_each_component_of_g(index, name):
    values = 2.0 * np.sin(np.pi * T / 2.0)  # 2 g at 1 s, -2 g at 3 s
    machine = occupant(**{name: (-1.5, 1.0)})
    high, low = find_occupant_violations(
        machine, Seat(), g_of((index, values)), still(), "modified"
    )
    label = name.capitalize()
    assert (high.joint, high.quantity, high.limit) == ("seat", label, 1.0)
    assert high.peak == pytest.approx(2.0)
    above, below = T[values > 1.0 + 1e-9], T[values < -1.5]
    assert (high.from_s, high.to_s) == (above[0], above[-1])
    assert (low.quantity, low.limit, low.peak) == (label, -1.5, pytest.approx(-2.0))
    assert (low.from_s, low.to_s) == (below[0], below[-1])
    assert str(high) == (
        f"modified seat {label} 2 g exceeds the bound 1 g from t = {above[0]:g} to {above[-1]:g} s"
    )
    assert str(low).startswith(f"modified seat {label} -2 g is below the bound -1.5 g from t = ")


def test_an_open_end_bounds_nothing_and_a_bound_itself_is_allowed():
    values = 2.0 * np.sin(np.pi * T / 2.0)
    response = g_of((1, values))
    for machine in (DES, occupant(gy=(-np.inf, 2.0)), occupant(gy=(-2.0, np.inf))):
        assert find_occupant_violations(machine, Seat(), response, still(), "desired") == ()


@pytest.mark.parametrize("intervals", [40, 400])
def test_onset_is_the_change_over_a_tenth_of_a_second_jumps_included(intervals):
    t = np.linspace(0.0, 4.0, intervals + 1)
    sides = np.zeros((intervals, 2, 3))
    sides[t[:-1] > 2.0 - 1e-9, :, 1] = 0.3  # a jump at 2 s
    (onset,) = find_occupant_violations(
        occupant(g_onset=2.0), Seat(), response_of(sides), still(t), "modified"
    )
    assert (onset.quantity, onset.peak) == ("Gy onset", pytest.approx(3.0))
    # named by the first times of the windows that see it
    assert (onset.from_s, onset.to_s) == pytest.approx((1.9, 2.0), abs=1e-6)
    assert "seat Gy onset 3 g/s exceeds the bound 2 g/s" in str(onset)
    assert not find_occupant_violations(
        occupant(g_onset=3.1), Seat(), response_of(sides), still(t), "modified"
    )


def test_a_spike_shorter_than_the_window_has_the_onset_of_its_height():
    # From sample to sample it rises by 10 g/s; over a tenth of a second by 2 g/s.
    t = np.linspace(0.0, 4.0, 401)
    values = np.where(np.abs(t - 2.0) < 0.011, 0.2 - 10.0 * np.abs(t - 2.0), 0.0)
    sides = np.zeros((400, 2, 3))
    sides[..., 0] = np.stack([values[:-1], values[1:]], axis=1)
    found = find_occupant_violations(
        occupant(g_onset=1.5), Seat(), response_of(sides), still(t), "desired"
    )
    assert [(v.quantity, v.peak) for v in found] == [("Gx onset", pytest.approx(2.0))]


def test_angular_acceleration_is_that_of_the_turning_seat():
    # Finite differences of the seat's rotation: W from R'R^T, dW/dt by a second one.
    h = 1e-3
    t = np.arange(0.0, 2.0, h)
    angle = np.stack([0.4 * np.sin(t), 0.5 * np.cos(1.3 * t), 0.7 * np.sin(0.8 * t + 0.3)], axis=1)
    rate = np.stack(
        [0.4 * np.cos(t), -0.65 * np.sin(1.3 * t), 0.56 * np.cos(0.8 * t + 0.3)], axis=1
    )
    motion = Motion(t, angle, rate[:-1], rate[1:])
    turned = seat_rotation(chain_of(DES, Seat()), angle)
    spin = (turned[2:] - turned[:-2]) / (2 * h) @ np.swapaxes(turned[1:-1], -1, -2)
    ground_rate = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)
    expected = np.linalg.norm((ground_rate[2:] - ground_rate[:-2]) / (2 * h), axis=1)
    found = angular_acceleration_magnitude(DES, Seat(), motion)
    at_samples = 0.5 * (found[1:, 0] + found[:-1, 1])
    np.testing.assert_allclose(at_samples[1:-1], expected, rtol=0, atol=1e-5)


def test_a_bound_on_the_angular_acceleration():
    rate = np.zeros((41, 3))
    rate[:, 0] = 0.5 * np.sin(T)  # the arm alone: |dW/dt| is its acceleration
    motion = from_rates(rate)
    machine = occupant(angular_acceleration=0.4)
    response = respond(machine, Seat(), motion)
    (found,) = find_occupant_violations(machine, Seat(), response, motion, "desired")
    acceleration = np.abs(np.diff(rate[:, 0]) / 0.1)
    assert (found.quantity, found.peak) == (
        "angular acceleration",
        pytest.approx(max(acceleration)),
    )
    assert found.from_s == 0.0
    assert "desired seat angular acceleration" in str(found)
    roomy = occupant(angular_acceleration=0.51)
    assert find_occupant_violations(roomy, Seat(), response, motion, "desired") == ()


@pytest.mark.parametrize("length", [1, 7, 40])
def test_a_long_motion_is_measured_in_pieces(length, monkeypatch):
    """However long they are: a limit is broken, and a peak reached, where it is in the whole."""
    rate = 4.0 * np.stack([np.sin(9.0 * T), np.cos(5.0 * T), np.sign(np.sin(3.0 * T))], axis=1)
    whole, again = from_rates(rate), from_rates(rate)
    expected, peaks = find_violations(DES, whole, "desired"), measure_peaks(whole)
    assert len({(v.joint, v.quantity) for v in expected}) > 6
    monkeypatch.setattr("des_cli.model.motion.PIECE", length)
    assert find_violations(DES, again, "desired") == expected
    found = measure_peaks(again)
    for name in ("angle", "rate", "acceleration", "jerk", "rate_step"):
        np.testing.assert_array_equal(getattr(found, name), getattr(peaks, name))
    np.testing.assert_array_equal(largest_angle(again), peaks.angle)
    fast = replace(DES, limits=tuple(replace(each, jerk=1e-12) for each in DES.limits))
    assert steps_too_short(fast, again, 1e-9) == steps_too_short(fast, whole, 1e-9) != ""
