"""The nearest executable motion: inside every limit, and no farther than it must be."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from des_cli.model.machine import JointLimits
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.reduction.executable import (
    CLEAR,
    FEWEST_KNOTS,
    KNOT_STEP,
    LONGEST_KNOT_STEP,
    TAU,
    fit_executable,
    integrate_rates,
    knot_grid,
    nearest_executable,
    sample_spline,
    start_kept,
)
from des_cli.reduction.limits import find_violations, measure_peaks
from des_cli.reduction.reference import sample_motion
from des_cli.solver.spline import Ends, SplineGrid
from tests.support.free_motions import smooth

NO, YES = np.zeros(3, dtype=bool), np.ones(3, dtype=bool)
TABLE_1 = replace(DES, limits=tuple(replace(limit, jerk=np.inf) for limit in DES.limits))
ENDS = {
    "start": start_kept(rates=False),
    "start rates": start_kept(rates=True),
    "rates": Ends(YES, YES, NO, YES, NO),
    "both": Ends(YES, YES, YES, YES, NO),
}


def violations(machine, motion):
    return [v.quantity for v in find_violations(machine, motion, "modified")]


@pytest.mark.parametrize("machine", [DES, TABLE_1], ids=["jerk", "no jerk"])
@pytest.mark.parametrize("intervals", [400, 1000])
def test_the_cobras_corner_is_rounded(cobra, intervals, machine):
    desired = cobra(intervals)
    motion, trouble = nearest_executable(machine, desired)
    assert trouble == ""
    assert "rate step" in violations(machine, desired)
    assert violations(machine, motion) == []
    np.testing.assert_array_equal(motion.rate_step, 0.0)
    np.testing.assert_allclose(motion.angle[0], desired.angle[0], rtol=0, atol=1e-12)
    changed = np.abs(motion.angle - desired.angle)
    # 0.0873 rad/s at a jerk of 5 rad/s^3 takes 0.26 s; the angle is off by 2e-3 rad at most
    assert changed[:, 2].max() < 4e-3
    # the arm's acceleration turns round too, at 5 s; elsewhere nothing changes
    far = np.abs(desired.t - 5.0) > 1.5
    assert changed[far, 2].max() < 2e-4
    assert changed[:, 1].max() < 2e-4


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_a_motion_inside_the_limits_stays(joint):
    amplitude = np.zeros((3, 3))
    amplitude[joint, 1] = 0.2
    desired = smooth(400, amplitude=amplitude)
    motion, trouble = nearest_executable(DES, desired)
    assert trouble == ""
    np.testing.assert_allclose(motion.angle, desired.angle, rtol=0, atol=1e-4)
    np.testing.assert_array_equal(motion.rate_sides, desired.rate_sides)


def test_rates_that_are_not_those_of_the_angles_are_mended():
    # on few rows the trapezoids of the rates miss the angles: the spline is near both
    desired = smooth(8, amplitude=[[0.0, 0.0], [0.0, 0.5], [0.0, 0.0]])
    motion, trouble = nearest_executable(DES, desired)
    assert trouble == ""
    moved = 0.5 * motion.step[:, None] * (motion.rate_start + motion.rate_end)
    np.testing.assert_allclose(np.diff(motion.angle, axis=0), moved, atol=1e-12)


def distance_weights(grid, joint, desired):
    """The distance's quadratic form over one joint's control points, by a fine quadrature."""
    t, weight = fine_points(grid)
    angle, rate, _ = sample_motion(desired, t)
    value, slope = (
        np.stack([grid.values(e[:, None], t, order)[:, 0] for e in np.eye(grid.points)], axis=1)
        for order in (0, 1)
    )
    return value, slope, weight, angle[:, joint], rate[:, joint]


def fine_points(grid, count=6):
    nodes, weights = np.polynomial.legendre.leggauss(count)
    u = 0.5 * (nodes + 1.0)
    t = (grid.knots[:-1, None] + grid.step * u).ravel()
    return t, np.tile(0.5 * grid.step * weights, grid.intervals)


def distance(grid, control, desired, joint):
    """1/2 int (theta - Theta)^2 + tau^2 (theta' - Theta')^2 of one joint."""
    value, slope, weight, angle, rate = distance_weights(grid, joint, desired)
    off, slip = value @ control[:, joint] - angle, slope @ control[:, joint] - rate
    return 0.5 * weight @ (off**2 + TAU**2 * slip**2)


def nearest_by_ipopt(grid, limit, desired, joint):
    """The least distance of any spline on the grid within one joint's limits."""
    value, slope, weight, angle, rate = distance_weights(grid, joint, desired)
    p = ca.MX.sym("p", grid.points)
    off, slip = value @ p - angle, slope @ p - rate
    cost = 0.5 * ca.dot(weight, off**2 + TAU**2 * slip**2)
    first = grid.basis(np.zeros(1), 0)[0, :3]
    rows = [ca.dot(first, p[:3]) - angle_at_start(desired, joint)]
    bounds = [np.zeros(1)]
    for order, bound in ((1, limit.rate), (2, limit.acceleration), (3, limit.jerk)):
        d = np.diff(np.eye(grid.points), order, axis=0) / grid.step**order
        d = d[1:-1] if order == 1 else d
        rows.append(d @ p)
        bounds.append(np.full(len(d), bound))
    rows.append(0.5 * (p[-1] - p[-3]) / grid.step)  # the last rate
    rows.append(0.5 * (p[2] - p[0]) / grid.step)
    high = np.concatenate([*bounds, [limit.rate, limit.rate]])
    solver = ca.nlpsol(
        "solver",
        "ipopt",
        {"x": p, "f": cost, "g": ca.vertcat(*rows)},
        {"print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes", "ipopt.tol": 1e-10},
    )
    found = solver(x0=angle_at_start(desired, joint), lbg=-high, ubg=high)
    assert solver.stats()["success"]
    return float(found["f"])


def angle_at_start(desired, joint):
    return float(desired.angle[0, joint])


@pytest.mark.parametrize(("joint", "size"), [(0, 1.4), (1, 3.0), (2, 3.5)])
def test_no_spline_inside_the_limits_is_nearer(joint, size):
    # A rate of size cos(8 pi t / 6): jerk and acceleration and, for fork and cab, rate bind.
    amplitude = np.zeros((3, 9))
    amplitude[joint, 8] = size
    desired = smooth(240, 6.0, amplitude)
    grid, limit = SplineGrid(0.0, 0.15, 40), DES.limits[joint]
    found = fit_executable(grid, desired, DES.limits, ENDS["start"])
    assert found.trouble == ""
    assert find_violations(DES, desired, "desired")
    reached = distance(grid, found.control, desired, joint)
    # it keeps a thousandth clear: between the programs at both margins
    eased = JointLimits(
        *(np.array([limit.angle, limit.rate, limit.acceleration, limit.jerk]) * (1 - 2 * CLEAR))
    )
    least = nearest_by_ipopt(grid, limit, desired, joint)
    most = nearest_by_ipopt(grid, eased, desired, joint)
    assert least * (1.0 - 1e-6) <= reached <= most * (1.0 + 1e-5)
    others = [each for each in range(3) if each != joint]
    still = grid.values(found.control, grid.knots)[:, others]
    np.testing.assert_allclose(still, np.tile(desired.angle[0, others], (41, 1)), atol=1e-6)


@pytest.mark.parametrize("ends", ENDS.values(), ids=list(ENDS))
def test_the_ends_that_are_kept(ends):
    desired = smooth(200)
    grid = SplineGrid(0.0, 0.1, 40)
    spline = fit_executable(grid, desired, DES.limits, ends)
    assert spline.trouble == ""
    tips = grid.knots[[0, -1]]
    value, rate = (grid.values(spline.control, tips, order) for order in (0, 1))
    kept = ends.start_value[0], ends.start_rate[0], ends.end_value[0], ends.end_rate[0]
    off = (
        value[0] - desired.angle[0],
        rate[0] - desired.rate_start[0],
        value[1] - desired.angle[-1],
        rate[1] - desired.rate_end[-1],
    )
    for condition, error in zip(kept, off, strict=True):
        assert np.max(np.abs(error)) < (1e-12 if condition else 1e-3)


def test_a_smooth_motion_is_met_to_the_order_of_the_splines():
    desired, errors = smooth(3000), []
    for intervals in (10, 20):
        grid = SplineGrid(0.0, 4.0 / intervals, intervals)
        spline = fit_executable(grid, desired, DES.limits, ENDS["start"])
        t = np.linspace(0.0, 4.0, 401)
        off = grid.values(spline.control, t) - sample_motion(desired, t)[0]
        errors.append(np.abs(off).max())
    assert errors[1] < errors[0] / 8.0


@settings(max_examples=12, phases=[Phase.generate])
@given(
    rates=st.lists(
        st.tuples(*(st.integers(-9 * top, 9 * top) for top in (5, 3, 3))), min_size=8, max_size=8
    ),
    seed=st.integers(0, 1000),
)
def test_any_demand_ends_inside_every_limit(rates, seed):
    # Rates that step at every fifth sample, on unequal steps, far beyond the machine.
    t = np.cumsum(np.random.default_rng(seed).uniform(0.05, 0.4, 41))
    demand = np.repeat(np.array(rates) / 9.0, 5, axis=0)
    angle = np.vstack([np.zeros(3), np.cumsum(np.diff(t)[:, None] * demand, axis=0)])
    desired = Motion(t, angle, demand, demand)
    motion, trouble = nearest_executable(DES, desired)
    assert trouble == ""
    assert set(violations(DES, motion)) <= {"angle"}
    # rows this far apart play an angle that is the trapezoids of its rates
    assert np.all(measure_peaks(motion).angle[1:] <= 2.0 * np.pi + 0.05)
    np.testing.assert_allclose(motion.angle[0], desired.angle[0], rtol=0, atol=1e-12)
    half = 0.5 * motion.step[:, None]
    moved = half * (motion.rate_start + motion.rate_end)
    np.testing.assert_allclose(np.diff(motion.angle, axis=0), moved, atol=1e-12)


@pytest.mark.parametrize("rows", [37, 200, 1777])
def test_a_table_of_any_rate_keeps_the_splines_limits(cobra, rows):
    found = fit_executable(knot_grid(cobra(500).t), cobra(500), DES.limits, ENDS["start rates"])
    motion = sample_spline(found, np.linspace(0.0, 10.0, rows))
    assert violations(DES, motion) == []
    peaks = measure_peaks(motion)
    jerk = np.array([limit.jerk for limit in DES.limits])
    assert np.max(peaks.jerk / jerk) <= 1.0
    if rows > 500:  # and spends them, where the corner is
        assert np.max(peaks.jerk / jerk) > 0.99


def test_a_table_plays_its_rates(cobra):
    grid = knot_grid(cobra(500).t)
    found = fit_executable(grid, cobra(500), DES.limits, ENDS["start"])
    motion = sample_spline(found, cobra(500).t)
    np.testing.assert_allclose(motion.rate, grid.values(found.control, motion.t, 1), atol=1e-12)
    np.testing.assert_allclose(motion.angle, grid.values(found.control, motion.t), atol=1e-4)
    again = integrate_rates(motion.t, motion.angle[0], motion.rate)
    np.testing.assert_array_equal(again.angle, motion.angle)


@pytest.mark.parametrize(
    "intervals",
    [
        20,
        160,
    ],
)
def test_angles_hold_between_samples_too(intervals):
    # The fork is driven beyond its 2 pi and back.
    amplitude = np.zeros((3, 2))
    amplitude[1, 1] = 2.9
    desired = smooth(intervals, 8.0, amplitude)
    motion, trouble = nearest_executable(DES, desired)
    assert trouble == ""
    assert measure_peaks(desired).angle[1] > 2.0 * np.pi
    # the parabola's vertex inside each interval
    a, b, h = motion.rate_start[:, 1], motion.rate_end[:, 1], motion.step
    turning = np.sign(a) != np.sign(b)
    vertex = motion.angle[:-1, 1][turning] + 0.5 * (a**2 / (a - b) * h)[turning]
    assert np.abs(vertex).max() <= 2.0 * np.pi


@pytest.mark.parametrize(
    ("angle", "rate", "said"),
    [
        ([0.0, 7.0, 0.0], [0.0, 0.0, 0.0], "the fork is 7 rad at the start"),
        ([0.0, 0.0, 0.0], [6.5, 0.0, 0.0], "the arm turns with 6.5 rad/s at the start"),
    ],
)
def test_a_start_outside_the_limits_is_named(angle, rate, said):
    t = np.linspace(0.0, 1.0, 21)
    path = np.array(angle) + t[:, None] * np.array(rate)
    constant = np.tile(rate, (20, 1))
    desired = Motion(t, path, constant, constant)
    with np.errstate(all="ignore"):
        found = fit_executable(knot_grid(t), desired, DES.limits, ENDS["start rates"])
    assert said in found.trouble
    assert "limit of" in found.trouble


class TestKnots:
    def test_as_many_as_the_motion_needs(self):
        for rows in (1001, 100_001):
            grid = knot_grid(np.linspace(2.0, 12.0, rows))
            assert grid.intervals == round(10.0 / KNOT_STEP)
            assert (grid.start, grid.duration) == (2.0, pytest.approx(10.0))

    def test_no_more_than_rows(self):
        assert knot_grid(np.linspace(0.0, 10.0, 41)).intervals == 40
        assert knot_grid(np.linspace(0.0, 10.0, 3)).intervals == 3  # the fewest of a spline

    def test_those_of_a_long_motion_stand_farther_apart(self):
        for duration, step in ((30.0, KNOT_STEP), (60.0, 0.06), (2000.0, LONGEST_KNOT_STEP)):
            grid = knot_grid(np.linspace(0.0, duration, 100_001))
            assert grid.step == pytest.approx(step, rel=1e-9)

    def test_a_short_motion_has_some_all_the_same(self):
        assert knot_grid(np.linspace(0.0, 0.1, 1001)).intervals == FEWEST_KNOTS

    @pytest.mark.parametrize("multiple", [2, 8])
    def test_a_multiple(self, multiple):
        grid = knot_grid(np.linspace(0.0, 9.98, 1000), multiple)
        assert grid.intervals % multiple == 0
        needed = int(np.ceil(9.98 / KNOT_STEP))
        assert needed <= grid.intervals < needed + multiple
        assert grid.duration == pytest.approx(9.98)
