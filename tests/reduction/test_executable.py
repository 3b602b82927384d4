"""The nearest executable motion: inside every limit, and no farther than it must be."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.reduction.executable import TAU, nearest_executable
from des_cli.reduction.limits import find_violations, measure_peaks


def distance(motion, desired, joint):
    """1/2 int (theta - Theta)^2 + tau^2 (theta' - Theta')^2 of one joint."""
    off = (motion.angle - desired.angle)[:, joint]
    slip = (motion.rate - desired.rate)[:, joint]
    return 0.5 * np.trapezoid(off**2 + TAU**2 * slip**2, desired.t)


def nearest_by_ipopt(limit, desired, joint):
    """The least distance within one joint's limits, as a quadratic program."""
    n, step = len(desired.t), desired.step
    angle, rate = ca.MX.sym("angle", n), ca.MX.sym("rate", n)
    weight = np.zeros(n)
    weight[:-1] += step / 2
    weight[1:] += step / 2
    off = angle - desired.angle[:, joint]
    slip = rate - desired.rate[:, joint]
    cost = ca.dot(weight, off**2 + TAU**2 * slip**2) / 2
    moved = angle[1:] - angle[:-1] - step / 2 * (rate[1:] + rate[:-1])
    rows = ca.vertcat(moved, angle[0] - desired.angle[0, joint], (rate[1:] - rate[:-1]) / step)
    high = np.concatenate([np.zeros(n), np.full(n - 1, limit.acceleration)])
    top = np.concatenate([np.full(n, limit.angle), np.full(n, limit.rate)])
    solver = ca.nlpsol(
        "solver",
        "ipopt",
        {"x": ca.vertcat(angle, rate), "f": cost, "g": rows},
        {"print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes", "ipopt.tol": 1e-10},
    )
    start = np.concatenate([desired.angle[:, joint], desired.rate[:, joint]])
    found = solver(x0=start, lbg=-high, ubg=high, lbx=-top, ubx=top)
    assert solver.stats()["success"]
    return float(found["f"])


@pytest.mark.parametrize("intervals", [400, 1000])
def test_the_cobras_corner_is_rounded(cobra, intervals):
    desired = cobra(intervals)
    motion, outcome = nearest_executable(DES, desired)
    assert outcome.status == "converged"
    assert [v.quantity for v in find_violations(DES, desired, "desired")] == ["rate step"]
    assert find_violations(DES, motion, "desired") == ()
    np.testing.assert_array_equal(motion.rate_step, 0.0)
    changed = np.abs(motion.angle - desired.angle)
    # 0.0873 rad/s at half of 5 rad/s^2 takes 35 ms: 0.0873 * 0.035 / 8 rad in the middle.
    assert changed[:, 2].max() < 5e-4
    # Arm and fork keep their limits: their rates stay, and the fork's angle is their
    # trapezoidal rule, off by step^2 / 12 times the change of its acceleration.
    np.testing.assert_array_equal(motion.rate[:, :2], desired.rate[:, :2])
    assert changed[:, 0].max() < 1e-12
    assert changed[:, 1].max() < desired.step[0] ** 2 / 12.0 * 0.84
    far = np.abs(desired.t - 5.0) > 0.5
    assert changed[far, 2].max() < 1e-5


def test_a_motion_inside_the_limits_stays(wave):
    desired = wave([[0.3, 0.1, 0.0], [0.2, -0.1, 0.1], [0.1, 0.2, 0.1]], intervals=60)
    motion, outcome = nearest_executable(DES, desired)
    assert outcome is None
    np.testing.assert_allclose(motion.angle, desired.angle, rtol=0, atol=1e-4)
    np.testing.assert_array_equal(motion.rate_sides, desired.rate_sides)


@pytest.mark.parametrize(("joint", "size"), [(0, 1.4), (1, 3.0), (2, 3.5)])
def test_against_a_quadratic_program(wave, joint, size):
    # A rate of size cos(8 pi t / 6): acceleration and, for fork and cab, rate bind.
    amplitude = np.zeros((3, 9))
    amplitude[joint, 8] = size
    desired = wave(amplitude, intervals=120)
    limit = DES.limits[joint]
    motion, outcome = nearest_executable(DES, desired)
    assert outcome.status == "converged"
    assert find_violations(DES, desired, "desired")
    assert find_violations(DES, motion, "desired") == ()
    found = distance(motion, desired, joint)
    # It keeps a thousandth clear of the limits: between the programs at both margins.
    least = nearest_by_ipopt(limit, desired, joint)
    most = nearest_by_ipopt(
        replace(limit, rate=limit.rate * 0.998, acceleration=limit.acceleration * 0.998),
        desired,
        joint,
    )
    assert least * (1.0 - 1e-6) <= found <= most * (1.0 + 1e-6)
    others = [each for each in range(3) if each != joint]
    np.testing.assert_allclose(motion.angle[:, others], desired.angle[:, others], atol=1e-6)


@settings(max_examples=15, deadline=None, derandomize=True)
@given(
    rates=st.lists(
        st.tuples(st.floats(-8, 8), st.floats(-5, 5), st.floats(-5, 5)), min_size=8, max_size=8
    ),
    seed=st.integers(0, 1000),
)
def test_any_demand_ends_inside_every_limit(rates, seed):
    # Rates that step at every sample, on unequal steps, far beyond the machine.
    t = np.cumsum(np.random.default_rng(seed).uniform(0.05, 0.4, 41))
    demand = np.repeat(np.array(rates), 5, axis=0)
    angle = np.vstack([np.zeros(3), np.cumsum(np.diff(t)[:, None] * demand, axis=0)])
    desired = Motion(t, angle, demand, demand)
    motion, outcome = nearest_executable(DES, desired)
    assert outcome is None or outcome.status == "converged"
    assert find_violations(DES, motion, "modified") == ()
    np.testing.assert_array_equal(motion.angle[0], desired.angle[0])
    half = 0.5 * motion.step[:, None]
    moved = half * (motion.rate_start + motion.rate_end)
    np.testing.assert_allclose(np.diff(motion.angle, axis=0), moved, atol=1e-12)


def test_angles_hold_between_samples_too(wave):
    # The fork is driven beyond its 2 pi and back, on coarse samples.
    amplitude = np.zeros((3, 3))
    amplitude[1, 1] = 3.4
    desired = wave(amplitude, intervals=30, duration=8.0)
    motion, outcome = nearest_executable(DES, desired)
    assert outcome.status == "converged"
    assert measure_peaks(desired).angle[1] > 2.0 * np.pi
    # the parabola's vertex inside each interval
    a, b, h = motion.rate_start[:, 1], motion.rate_end[:, 1], motion.step
    turning = np.sign(a) != np.sign(b)
    vertex = motion.angle[:-1, 1][turning] + 0.5 * (a**2 / (a - b) * h)[turning]
    assert np.abs(vertex).max() <= 2.0 * np.pi


def test_a_start_that_cannot_be_left_in_time_is_not_called_converged():
    t = np.linspace(0.0, 1.0, 21)
    rest = np.zeros((20, 3))
    desired = Motion(t, np.tile([0.0, 7.0, 0.0], (21, 1)), rest, rest)  # beyond the fork's 2 pi
    _, outcome = nearest_executable(DES, desired)
    assert outcome.status not in ("converged", "acceptable")
