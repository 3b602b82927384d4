"""Free motions from a task to a result, on small maneuvers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.response import respond, respond_on
from des_cli.model.machine import DHRow, OccupantBounds, Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.reduction.fidelity import Deviation
from des_cli.reduction.free.method import LEFT, find_free_motion
from des_cli.reduction.limits import find_occupant_violations, find_violations
from tests.benchmarks.random_profiles import random_task
from tests.support.free_motions import ATTITUDE, JOINTS, RATE, TURNING, G, smooth, task_of

DESIRED = smooth(200)
FELT = {G: 0.02, RATE: 0.1}
TURNING_BACK = ((0.6, 0.0, 0.15), (0.05, 0.5, 0.0), (-0.1, 0.1, 0.4))


def solved(task, status="converged"):
    result = find_free_motion(task)
    assert result.solution.status == status, result.solution.message
    return result


def spent(task, result):
    """Each budget's share, on the table."""
    chains = task.chain, chain_of(task.machine, result.seat)
    deviation = Deviation.between(
        task.reference, result.solution.modified, chains, task.machine.gravity
    )
    return {b.metric: deviation.value(b.metric) / b.most for b in task.reduction.budget}


def energy(machine, seat, motion):
    c = respond_on(chain_of(machine, seat), machine.gravity, motion).coriolis_seat
    return float(np.sum(0.5 * motion.step[:, None] * np.sum(c**2, axis=-1)))


@pytest.mark.parametrize(
    "budget",
    [
        FELT,
        {TURNING: 0.05},
        {G: 0.02},
        {JOINTS: 0.03},
        {ATTITUDE: 2.0},
        {RATE: 0.1, ATTITUDE: 2.0},
        {"seat_angular_acceleration_rms_ratio": 0.9},
        {"seat_angular_acceleration_peak_ratio": 0.95, RATE: 0.2},
    ],
    ids=lambda budget: "-".join(budget),
)
def test_budgets_are_spent_and_not_overspent(budget):
    task = task_of(DESIRED, budget)
    result = solved(task)
    shares = spent(task, result).values()
    assert LEFT <= max(shares) <= 1.0
    assert find_violations(DES, result.solution.modified, "modified") == ()
    before, after = (energy(DES, Seat(), m) for m in (DESIRED, result.solution.modified))
    assert after < 0.97 * before
    # J with R1 = 2 I
    assert result.solution.cost == pytest.approx(after, rel=1e-9)
    assert result.solution.cost_unreduced == pytest.approx(before, rel=1e-9)


def test_the_result_of_a_motion_that_can_be_flown():
    told = []
    result = find_free_motion(task_of(DESIRED, FELT), told.append)
    solution = result.solution
    assert result.desired is DESIRED
    assert result.seat == Seat()
    assert solution.control.shape == solution.adjoint.shape == (201, 0)
    assert solution.log == tuple(told)
    assert solution.iterations == len(told)
    assert [line.number for line in told] == list(range(len(told)))
    assert solution.optimality <= 1e-6
    np.testing.assert_array_equal(solution.modified.t, DESIRED.t)
    np.testing.assert_array_equal(solution.modified.rate_step, 0.0)


@pytest.mark.parametrize("name", ["free", "match-start", "match-rates", "match-both"])
def test_ends(name):
    result = solved(task_of(DESIRED, FELT, ends=name))
    modified = result.solution.modified
    start, end = (np.abs(modified.angle - DESIRED.angle)[k].max() for k in (0, -1))
    start_rate = np.abs(modified.rate_start[0] - DESIRED.rate_start[0]).max()
    end_rate = np.abs(modified.rate_end[-1] - DESIRED.rate_end[-1]).max()
    assert start < 1e-12
    assert (start_rate < 1e-9) == (name != "free")
    assert (end_rate < 1e-6) == (name in ("match-rates", "match-both"))
    # the table's trapezoids are not quite the spline
    assert (end < 1e-4) == (name == "match-both")


def test_more_freedom_is_never_worse():
    costs = [
        solved(task_of(DESIRED, FELT, ends=name)).solution.cost
        for name in ("free", "match-start", "match-rates", "match-both")
    ]
    assert costs == sorted(costs)


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_a_joint_that_is_held_stays(joint):
    names = ("arm", "fork", "cab")
    result = solved(task_of(DESIRED, FELT, hold=frozenset({names[joint]})))
    changed = np.abs(result.solution.modified.angle - DESIRED.angle).max(axis=0)
    assert changed[joint] < 2e-5
    others = [each for each in range(3) if each != joint]
    assert np.all(changed[others] > 1e-4)


def test_starts_are_found_too():
    plain = solved(task_of(DESIRED, FELT))
    freed = solved(task_of(DESIRED, FELT, optimise=("fork_start", "cab_start")))
    off = np.abs(freed.solution.modified.angle[0] - DESIRED.angle[0])
    assert off[0] < 1e-12
    assert np.all(off[1:] > 1e-3)
    assert freed.solution.cost < plain.solution.cost
    assert freed.seat == Seat()


@pytest.mark.parametrize("names", [("seat_yaw",), ("seat_pitch",), ("seat_yaw", "seat_pitch")])
def test_the_seat_is_found_too(names):
    plain, task = solved(task_of(DESIRED, FELT)), task_of(DESIRED, FELT, optimise=names)
    result = solved(task)
    assert (result.seat.yaw != Seat().yaw) == ("seat_yaw" in names)
    assert (result.seat.pitch != Seat().pitch) == ("seat_pitch" in names)
    assert result.solution.cost < plain.solution.cost
    assert max(spent(task, result).values()) <= 1.0
    left = energy(DES, result.seat, result.solution.modified)
    assert result.solution.cost == pytest.approx(left, rel=1e-9)


def test_a_motion_per_joint_stands_still_where_the_desired_one_does():
    desired = smooth(200, amplitude=TURNING_BACK)
    result = solved(task_of(desired, FELT, control="per-joint"))
    free = solved(task_of(desired, FELT))

    def while_still(motion):
        """Rates where the desired ones change sign, linear between samples."""
        found = []
        for joint in range(3):
            rate = desired.rate[:, joint]
            for k in np.flatnonzero(rate[:-1] * rate[1:] < 0.0):
                u = rate[k] / (rate[k] - rate[k + 1])
                found.append((1.0 - u) * motion.rate[k, joint] + u * motion.rate[k + 1, joint])
        return np.abs(found)

    tied, untied = while_still(result.solution.modified), while_still(free.solution.modified)
    assert len(tied) == 3
    assert np.all(tied < 5e-4)  # the spline's reversal is not quite the table's
    assert np.max(untied) > 20.0 * np.max(tied)
    assert free.solution.cost < result.solution.cost
    # factors that turn the desired rates into the modified ones
    factor = result.solution.control
    assert factor.shape == (201, 3)
    assert np.max(np.abs(factor)) < 50.0
    np.testing.assert_allclose(
        factor * desired.rate, result.solution.modified.rate, rtol=0, atol=1e-5
    )


def test_no_cross_coupling_is_passed_through():
    still_cab_and_fork = smooth(100, amplitude=((0.5, 0.1), (0.0, 0.0), (0.0, 0.0)))
    result = solved(task_of(still_cab_and_fork, FELT))
    assert result.solution.iterations == 0
    assert result.solution.modified is still_cab_and_fork
    assert "passed through" in result.solution.message
    assert result.solution.cost < 1e-20
    per_joint = solved(task_of(still_cab_and_fork, FELT, control="per-joint"))
    np.testing.assert_allclose(per_joint.solution.control, 1.0, rtol=0, atol=1e-12)


def test_budgets_that_the_limits_exceed_are_named():
    # a cab's rate that steps by 1 rad/s
    t = np.linspace(0.0, 4.0, 201)
    side = np.where(t[:-1] < 2.0 - 1e-9, -0.45, 0.45)
    rate = np.stack([np.full(200, 0.6), np.full(200, 0.2), side], axis=1)
    angle = np.vstack([np.zeros(3), np.cumsum(0.02 * rate, axis=0)])
    desired = Motion(t, angle, rate, rate)
    result = solved(task_of(desired, {G: 0.5, RATE: 0.08}), "infeasible")
    assert "machine's limits alone" in result.solution.message
    assert "seat rate" in result.solution.message
    assert "instead of 0.08" in result.solution.message
    assert "G error" not in result.solution.message  # that budget could be kept
    assert np.isnan(result.solution.cost)
    allowed = solved(task_of(desired, {G: 0.5, RATE: 0.4}))
    assert find_violations(DES, allowed.desired, "desired") == ()
    assert allowed.desired is not desired
    # without limits the spline alone rounds the corner
    unlimited = solved(task_of(desired, {G: 0.5, RATE: 0.08}, limits="warn"))
    assert unlimited.desired is desired


def test_a_start_that_cannot_be_left_is_named():
    # the fork at its limit, and turning on at a rate that no brake stops in time
    desired = smooth(100, amplitude=((0.1, 0.1), (9.0, 0.0), (0.1, 0.0)))
    with np.errstate(all="ignore"):
        result = find_free_motion(task_of(desired, FELT))
    assert result.solution.status == "infeasible"
    assert "fork turns with 9 rad/s at the start" in result.solution.message


def extremes(motion):
    """What the occupant gets at most."""
    felt = respond_on(chain_of(DES, Seat()), DES.gravity, motion)
    g = felt.seat_g.mean(axis=1)
    return {
        "angular_acceleration": np.linalg.norm(felt.seat_angular_acceleration, axis=-1).max(),
        "gx": felt.seat_g[..., 0].max(),
        "gy": felt.seat_g[..., 1].max(),
        "gz": felt.seat_g[..., 2].max(),
        "g_onset": np.abs(np.diff(g, axis=0) / motion.step[1:, None]).max(),
    }


def occupant_of(name, bound):
    return OccupantBounds(**{name: (-np.inf, bound) if len(name) == 2 else bound})


WIDE = {G: 0.3, RATE: 0.5}


@pytest.mark.parametrize("name", ["angular_acceleration", "gy", "gz", "g_onset"])
def test_bounds_on_what_the_occupant_gets_are_kept(name):
    unbounded = solved(task_of(DESIRED, WIDE)).solution
    desired, most = extremes(DESIRED)[name], extremes(unbounded.modified)[name]
    assert most > 1.02 * desired  # the reduction alone would go beyond
    bound = desired + 0.3 * (most - desired)
    machine = replace(DES, occupant=occupant_of(name, bound))
    solution = solved(task_of(DESIRED, WIDE, machine)).solution
    # between the points that are bounded the table may be a little higher
    assert 0.97 * bound <= extremes(solution.modified)[name] <= 1.01 * bound
    assert solution.cost > unbounded.cost
    unchecked = solved(task_of(DESIRED, WIDE, machine, limits="warn")).solution
    felt = respond_on(chain_of(DES, Seat()), DES.gravity, unchecked.modified)
    assert find_occupant_violations(machine, Seat(), felt, unchecked.modified, "modified")


def test_a_bound_that_the_desired_motion_exceeds_and_the_optimum_does_not():
    unbounded = solved(task_of(DESIRED, WIDE)).solution
    bound = 0.28
    assert extremes(unbounded.modified)["gx"] < bound < extremes(DESIRED)["gx"]
    machine = replace(DES, occupant=occupant_of("gx", bound))
    solution = solved(task_of(DESIRED, WIDE, machine)).solution
    assert solution.cost == pytest.approx(unbounded.cost, rel=1e-3)


def test_a_step_too_coarse_for_the_budgets_is_refused():
    """The spline keeps this budget and its table, of 123 rows in 10 s, cannot."""
    result = find_free_motion(random_task(794))
    assert result.solution.status == "infeasible"
    assert "step of 0.0854 s" in result.solution.message
    assert "sample the profile finer" in result.solution.message


def test_a_bound_at_points_and_a_budget_that_are_both_exceeded_at_the_start():
    """The executable motion exceeds both, the budget by more."""
    task = random_task(328)
    solution = find_free_motion(task).solution
    assert solution.status == "converged"
    chain = chain_of(DES, Seat())
    spent = Deviation.between(task.reference, solution.modified, (chain, chain), DES.gravity)
    for budget in task.reduction.budget:
        assert spent.value(budget.metric) <= budget.most


def test_the_limit_on_steps():
    result = solved(task_of(DESIRED, FELT, max_iterations=3), "iteration-limit")
    assert "raise max_iterations (3)" in result.solution.message
    assert not result.solution.usable


def test_another_maneuver_further_away_in_time_and_azimuth_has_the_same_answer():
    """Nothing depends on when it begins, nor on where the arm stands."""
    later = Motion(
        DESIRED.t + 100.0,
        DESIRED.angle + np.array([2.0, 0.0, 0.0]),
        DESIRED.rate_start,
        DESIRED.rate_end,
    )
    budget = {G: 0.02, RATE: 0.1}
    one, other = (solved(task_of(motion, budget)).solution for motion in (DESIRED, later))
    assert other.cost == pytest.approx(one.cost, rel=1e-6)
    np.testing.assert_allclose(other.modified.rate, one.modified.rate, rtol=0, atol=1e-5)


@pytest.mark.parametrize("axes", ["report", "seat"])
def test_one_component_may_be_weighed(axes):
    r1 = np.diag([0.0, 2.0, 0.0])
    result = solved(task_of(DESIRED, FELT, axes=axes, r1=r1))
    before, after = (respond(DES, Seat(), motion) for motion in (DESIRED, result.solution.modified))
    name = "coriolis_report" if axes == "report" else "coriolis_seat"
    one, other = (
        np.sum(0.5 * DESIRED.step[:, None] * getattr(felt, name)[..., 1] ** 2)
        for felt in (before, after)
    )
    assert other < 0.95 * one
    assert result.solution.cost == pytest.approx(other, rel=1e-9)


def test_felt_errors_are_smaller_where_they_are_weighed():
    def turning_error(objective):
        result = solved(task_of(DESIRED, {G: 0.1, RATE: 0.3}, objective=objective))
        before, after = (
            respond_on(chain_of(DES, Seat()), DES.gravity, motion)
            for motion in (DESIRED, result.solution.modified)
        )
        target = before.seat_angular_acceleration - before.coriolis_seat
        return np.mean(np.sum((after.seat_angular_acceleration - target) ** 2, axis=-1))

    felt, blend, coriolis = (turning_error(name) for name in ("felt", "blend", "coriolis"))
    assert felt < blend < coriolis


def test_an_arm_that_is_not_vertical_is_refused():
    leaning = replace(DES, rows=(DHRow(alpha=0.5), *DES.rows))
    result = find_free_motion(task_of(DESIRED, FELT, leaning))
    assert result.solution.status == "infeasible"
    assert "vertical" in result.solution.message
