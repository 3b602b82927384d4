"""To rest from any state, inside limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from des_cli.kinematics.standstill import come_to_rest
from des_cli.model.machine import JointLimits

FREE = JointLimits(angle=math.inf, rate=3.5, acceleration=0.6, jerk=1.2)


@given(
    angle=st.floats(-1.0, 1.0),
    rate=st.floats(-3.0, 3.0),
    acceleration=st.floats(-0.6, 0.6),
    jerk=st.sampled_from([0.5, 1.2, 20.0]),
)
def test_it_ends_at_rest_and_keeps_acceleration_and_jerk(
    angle: float, rate: float, acceleration: float, jerk: float
) -> None:
    limit = JointLimits(math.inf, 10.0, 0.6, jerk)
    stop = come_to_rest(angle, rate, acceleration, limit)
    x, v, a = stop.at(np.array([0.0, stop.duration - 1e-9, stop.duration + 1.0]))
    assert (x[0], v[0], a[0]) == pytest.approx((angle, rate, acceleration), abs=1e-12)
    assert abs(v[1]) < 1e-7
    assert abs(a[1]) < 1e-6 + 2e-9 * jerk
    assert (v[2], a[2]) == (0.0, 0.0)
    assert x[2] == pytest.approx(x[1], abs=1e-8)
    assert all(time >= 0.0 and abs(each) <= jerk for time, each in stop.phases)
    course = stop.at(np.linspace(0.0, stop.duration, 500))
    assert np.max(np.abs(course[2])) <= max(0.6, abs(acceleration)) + 1e-9


def test_angle_and_rate_are_the_integrals() -> None:
    stop = come_to_rest(0.3, 2.0, -0.5, FREE)
    t = np.linspace(0.0, stop.duration, 100_001)
    angle, rate, acceleration = stop.at(t)
    step = t[1]
    mean = 0.5 * step * (acceleration[1:] + acceleration[:-1])
    np.testing.assert_allclose(rate[1:], rate[0] + np.cumsum(mean), atol=1e-6)
    mean = 0.5 * step * (rate[1:] + rate[:-1])
    np.testing.assert_allclose(angle[1:], angle[0] + np.cumsum(mean), atol=1e-6)


def test_it_is_gentle_where_there_is_room() -> None:
    _, _, acceleration = come_to_rest(0.0, 2.0, 0.0, FREE).at(np.linspace(0.0, 20.0, 2001))
    assert np.max(np.abs(acceleration)) == pytest.approx(0.25 * 0.6)


def test_it_brakes_harder_before_its_stop() -> None:
    limit = JointLimits(angle=1.0, rate=1.0, acceleration=0.6, jerk=1.2)
    stop = come_to_rest(0.6, 0.5, 0.0, limit)
    angle, _, acceleration = stop.at(np.linspace(0.0, stop.duration, 2001))
    assert np.max(angle) <= 1.0
    assert np.max(np.abs(acceleration)) > 0.25 * 0.6


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_it_comes_back_where_it_would_pass_its_stop(side: float) -> None:
    limit = JointLimits(angle=1.0, rate=1.0, acceleration=0.6, jerk=1.2)
    stop = come_to_rest(side * 0.855, side * 0.3, 0.0, limit)
    angle, rate, acceleration = stop.at(np.linspace(0.0, stop.duration, 2001))
    assert np.max(side * angle) <= 1.0
    assert np.min(side * rate) < 0.0
    assert np.max(np.abs(acceleration)) <= 0.6 + 1e-9


def test_at_rest_it_stays() -> None:
    stop = come_to_rest(0.4, 0.0, 0.0, FREE)
    assert stop.duration == 0.0
    angle, rate, _ = stop.at(np.array([0.0, 1.0]))
    assert angle.tolist() == [0.4, 0.4]
    assert rate.tolist() == [0.0, 0.0]


def test_a_joint_without_limits_of_jerk_and_acceleration_stops_too() -> None:
    stop = come_to_rest(0.0, 1.0, 0.0, JointLimits(math.inf, math.inf, math.inf, math.inf))
    assert 0.0 < stop.duration < 10.0
    assert stop.at(np.array([stop.duration]))[1][0] == 0.0


def test_what_no_way_keeps_is_the_fastest() -> None:
    stop = come_to_rest(0.99, 1.0, 0.6, JointLimits(1.0, 1.0, 0.6, 1.2))
    assert stop.duration < 5.0
