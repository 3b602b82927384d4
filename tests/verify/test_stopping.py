"""Coming to rest from any state: against a linear program, closed forms and plain mechanics."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog

from des_cli.model.machine import JointLimits
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.verify.claim import Claim
from des_cli.verify.stopping import State, best_reach, check_stopping, excess, reach_of_stop
from tests.support.claims import claim_of

LIMIT = JointLimits(angle=2.0, rate=3.0, acceleration=1.2, jerk=2.4)
FREE = replace(LIMIT, angle=math.inf)


def least_margin(state: State, limit: JointLimits, steps: int = 240) -> float:
    """By how much a stop must pass +-angle, with the jerk constant on each of many steps.

    A linear program over jerks: the largest |x| is what is minimised; every path that it
    finds can be driven, so it is never below the truth, and nears it as the steps shrink.
    """
    a = limit.acceleration
    duration = 4.0 * a / limit.jerk + 2.0 * (abs(state.rate) / a + 1.0)
    h = duration / steps
    # rows (x, v, a) after each step as a + B j
    step = np.array([[1.0, h, h * h / 2], [0.0, 1.0, h], [0.0, 0.0, 1.0]])
    push = np.array([h**3 / 6, h * h / 2, h])
    x = np.array([state.angle, state.rate, state.acceleration])
    weights = np.zeros((3, steps))
    positions, speeds, thrusts = [(x[0], np.zeros(steps))], [], []
    for k in range(steps):
        x = step @ x
        weights = step @ weights
        weights[:, k] = push
        positions.append((x[0], weights[0].copy()))
        speeds.append((x[1], weights[1].copy()))
        thrusts.append((x[2], weights[2].copy()))
    rows, bounds = [], []
    for at, row in positions:  # |x| <= s
        rows += [np.append(row, -1.0), np.append(-row, -1.0)]
        bounds += [-at, at]
    for at, row in thrusts:
        rows += [np.append(row, 0.0), np.append(-row, 0.0)]
        bounds += [a - at, a + at]
    ends = [np.append(speeds[-1][1], 0.0), np.append(thrusts[-1][1], 0.0)]
    found = linprog(
        np.append(np.zeros(steps), 1.0),
        A_ub=np.array(rows),
        b_ub=np.array(bounds),
        A_eq=np.array(ends),
        b_eq=[-speeds[-1][0], -thrusts[-1][0]],
        bounds=[(-limit.jerk, limit.jerk)] * steps + [(0.0, None)],
    )
    assert found.success
    return float(found.fun)


@pytest.mark.parametrize(
    "state",
    [
        State(0.4, 0.9, 0.0),
        State(0.4, 0.9, 1.1),
        State(0.4, 0.9, -1.1),
        State(1.0, 0.1, -1.2),  # full brakes: it must come back over the way
        State(1.2, -0.3, 0.9),
        State(-0.7, -1.3, -0.2),
        State(0.3, 0.0, 1.0),
        State(0.0, 2.5, -0.6),
    ],
)
def test_no_stop_stays_nearer_to_the_middle(state: State) -> None:
    least = least_margin(state, LIMIT)
    # With room for what is possible there is a stop inside it, and with less there is none.
    # The program sees a path at the ends of its steps, and may pass by 1e-4 between them.
    roomy, tight = (replace(LIMIT, angle=least * share) for share in (1.0002, 0.985))
    assert excess(state, replace(roomy, rate=math.inf)) <= 1e-6
    assert excess(state, replace(tight, rate=math.inf)) > 1e-3


def test_the_way_to_rest_ends_at_rest() -> None:
    """A joint at half its rate, by hand: down, hold, up."""
    speed, a, j = 2.0, LIMIT.acceleration, LIMIT.jerk
    reach = reach_of_stop(State(0.0, speed, 0.0), FREE)
    # A trapezoid of the acceleration is symmetric in time: mean speed over its duration.
    assert reach.most == pytest.approx(0.5 * speed * (speed / a + a / j), rel=1e-12)
    assert (reach.least, reach.rate) == (0.0, speed)


def test_a_slow_joint_never_reaches_its_full_brakes() -> None:
    speed, j = 0.1, LIMIT.jerk
    reach = reach_of_stop(State(1.0, -speed, 0.0), FREE)
    assert reach.least == pytest.approx(1.0 - speed * math.sqrt(speed / j), rel=1e-12)
    assert reach.most == 1.0


def test_without_a_jerk_limit_it_is_v_squared_over_two_a() -> None:
    reach = reach_of_stop(State(0.5, 1.2, 9.9), replace(FREE, jerk=math.inf))
    assert reach.most == pytest.approx(0.5 + 1.2**2 / 2.4, rel=1e-12)
    endless = JointLimits(angle=1.0, rate=1.0, acceleration=math.inf)
    assert reach_of_stop(State(0.5, -1.0, 0.0), endless).least == 0.5


def test_an_acceleration_that_is_still_on_raises_the_rate() -> None:
    """It takes a / j to take it back, and the rate gains a^2 / 2 j meanwhile."""
    state = State(0.0, 2.8, 1.2)
    assert reach_of_stop(state, FREE).rate == pytest.approx(2.8 + 1.2**2 / 4.8, rel=1e-12)
    assert excess(state, FREE) == pytest.approx((2.8 + 0.3) / 3.0 - 1.0, rel=1e-9)
    assert excess(replace(state, rate=2.7), FREE) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("angle", [2.0, -2.0])
def test_at_rest_on_the_stop_is_inside(angle: float) -> None:
    assert excess(State(angle, 0.0, 0.0), LIMIT) <= 0.0


@pytest.mark.parametrize("brakes", [-1.2, -0.9])
def test_touching_the_stop_under_brakes_is_inside(brakes: float) -> None:
    """What turns back at the stop may be cut off there."""
    assert excess(State(2.0, 0.0, brakes), LIMIT) <= 1e-12
    before = State(2.0, 0.0, brakes).after(-0.1, 0.0)  # a tenth of a second earlier
    assert excess(before, LIMIT) <= 1e-9


def test_sides_and_directions_of_time_are_alike() -> None:
    rng = np.random.default_rng(3)
    for _ in range(80):
        state = State(*(rng.uniform(-1, 1, 3) * [2.0, 3.0, 1.2]))
        reach, other = best_reach(state, LIMIT), best_reach(state.mirrored, LIMIT)
        assert (reach.least, reach.most, reach.rate) == (-other.most, -other.least, other.rate)
        assert state.reversed.reversed == state
        # Passing a state on the way to rest is possible from any state before it.
        later = state.after(0.01, 0.0)
        if abs(later.rate) <= 3.0 and abs(later.angle) <= 2.0 and excess(later, LIMIT) < 0.0:
            wide = replace(LIMIT, jerk=LIMIT.jerk * 1.5)
            assert excess(state, wide) < 0.05


SOFT = replace(LIMIT, jerk=0.6)
"""With it a joint gains more by braking on: a ramp takes two seconds."""


def driven(states: np.ndarray, limit: JointLimits, brakes: np.ndarray, h: float = 1e-3):
    """Least and most angle and largest rate of states (3, m) on their way to rest, in small steps.

    By feedback: brake as hard as it can for a time, then with the sign of the rate that is left
    when the acceleration is taken back at once.
    """
    x, v, a = states
    least, most, fastest = x.copy(), x.copy(), np.abs(v)
    for k in range(int(15.0 / limit.jerk / h)):
        left = v + a * np.abs(a) / (2.0 * limit.jerk)
        to = np.where(brakes > k * h, -1.0, -np.sign(left)) * limit.acceleration
        push = np.clip((to - a) / h, -limit.jerk, limit.jerk)
        x, v, a = x + h * (v + 0.5 * h * a), v + h * (a + 0.5 * h * push), a + h * push
        least, most = np.minimum(least, x), np.maximum(most, x)
        fastest = np.maximum(fastest, np.abs(v))
    return least, most, fastest


def test_the_fastest_way_to_rest_is_that_of_a_feedback_in_small_steps() -> None:
    rng = np.random.default_rng(4)
    states = rng.uniform(-1.0, 1.0, (3, 300)) * np.array([[2.0], [2.5], [1.2]])
    states[1, :100] *= 0.1
    found = np.array(
        [
            (reach.least, reach.most, reach.rate)
            for reach in (reach_of_stop(State(*each), FREE) for each in states.T.tolist())
        ]
    ).T
    expected = driven(states, FREE, np.zeros(300))
    np.testing.assert_allclose(found, expected, rtol=0, atol=4e-3)


@pytest.mark.parametrize(
    "state",
    [State(1.0, 0.9, 0.4), State(1.2, 0.7, -0.3), State(0.3, 1.4, 0.5), State(1.7, 0.6, 0.3)],
)
def test_a_joint_that_brakes_on_just_keeps_its_stop(state: State) -> None:
    """Of all times for which it brakes on the one that takes it to the stop, and no longer."""
    times = np.linspace(0.0, 5.0, 251)
    states = np.tile([[state.angle], [state.rate], [state.acceleration]], 251)
    least, most, fastest = driven(states, SOFT, times, 5e-3)
    stop = float(0.5 * (most[0] + np.min(most)))
    assert np.min(most) < stop - 0.01
    limit = replace(SOFT, angle=stop)
    falling = np.argmin(most)
    least, fastest = (
        float(np.interp(-stop, -most[:falling], values[:falling])) for values in (least, fastest)
    )
    for reach in (best_reach(state, limit), best_reach(state.mirrored, limit)):
        far, near = max(reach.most, -reach.least), max(-reach.most, reach.least)
        assert far == pytest.approx(stop, rel=1e-12)
        assert near == pytest.approx(least, abs=0.02)
        assert reach.rate == pytest.approx(fastest, abs=0.01)
    assert excess(state, limit) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("state", "most"),
    [
        # full brakes after half a second: 0.7 rad and 1.2 rad/s are left, then v^2 / 2 a
        (State(1.9, 1.5, 0.0), 1.9 + 0.7 + 0.6),
        # it turns before its brakes are full, at v = j t^2 / 2
        (State(1.99, 0.1, 0.0), 1.99 + 2.0 / 3.0 * 0.1 * math.sqrt(0.2 / 2.4)),
        # from 0.6 rad/s^2 full brakes take 0.75 s: 0.375 rad, and 0.275 rad/s are left
        (State(1.9, 0.5, 0.6), 1.9 + 0.375 + 0.275**2 / 2.4),
        (State(2.1, 0.0, 0.0), 2.1),
        (State(3.0, -1.0, 0.0), 3.0),
        (State(2.5, -0.01, -1.2), 2.5),
    ],
)
def test_a_stop_that_must_be_passed_is_passed_with_full_brakes(state: State, most: float) -> None:
    for each in (state, state.mirrored):
        assert excess(each, replace(LIMIT, rate=math.inf)) == pytest.approx(most / 2.0 - 1.0)


def test_an_excess_is_of_the_limits_that_there_are() -> None:
    state = State(0.5, 1.5, 0.0)
    endless = replace(FREE, rate=math.inf)
    assert excess(state, endless) == -1.0
    assert excess(state, FREE) == -0.5
    assert excess(State(0.5, 0.0, 0.0), LIMIT) == -0.75
    assert excess(State(-0.5, 0.0, 0.0), LIMIT) == -0.75
    # 1.5 rad and v^2 / 2 a, where nothing is gained by braking on
    at_once = replace(LIMIT, jerk=math.inf)
    for side in (1.0, -1.0):
        assert excess(State(1.5 * side, 1.2 * side, 0.0), at_once) == pytest.approx(0.05)
    for name in ("angle", "rate", "acceleration", "jerk"):
        for wrong in (0.0, -1.0, math.nan):
            assert math.isnan(excess(state, replace(LIMIT, **{name: wrong})))


def test_a_rate_that_its_acceleration_takes_back_is_no_negative_root() -> None:
    """v = -a^2 / 2 j to rounding: what is left is nothing, of either sign."""
    rng = np.random.default_rng(6)
    for a in rng.uniform(0.0, 1.2, 300):
        reach = reach_of_stop(State(0.0, -a * abs(a) / (2.0 * LIMIT.jerk), a), FREE)
        assert reach.least == pytest.approx(-(a**3) / (6.0 * LIMIT.jerk**2), rel=1e-6)
        assert reach.most == pytest.approx(0.0, abs=1e-7)


def test_more_brakes_than_there_may_be_are_taken_back_at_once() -> None:
    # the limit of the acceleration has a check of its own
    assert math.isfinite(excess(State(0.0, 1.0, -1.5), LIMIT))


RATES = np.array([[0.4, 0.5, 0.6], [0.38, 0.47, 0.56], [0.38, 0.48, 0.56], [0.4, 0.52, 0.59]])


def ends_claim(limit: JointLimits, **options: str) -> Claim:
    """Rates that fall in the first interval of 0.1 s, and rise in the last."""
    t = np.array([0.0, 0.1, 0.2, 0.3])
    motion = Motion(t, np.zeros((4, 3)), RATES[:-1], RATES[1:])
    return claim_of(motion, machine=replace(DES, limits=(limit,) * 3), **options)


def test_the_first_row_has_been_faster_and_the_last_gets_faster() -> None:
    """v + a^2 / 2 j, from the accelerations of the first interval and of the last."""
    limit = JointLimits(angle=math.inf, rate=0.5, acceleration=1.2, jerk=2.0)
    checks = check_stopping(ends_claim(limit, limits="enforce"))
    falls, rises = (RATES[0] - RATES[1]) / 0.1, (RATES[3] - RATES[2]) / 0.1
    expected = {}
    for j, joint in enumerate(("arm", "fork", "cab")):
        expected[f"stopping.{joint}.start"] = (RATES[0, j] + falls[j] ** 2 / 4.0) / 0.5 - 1.0
        expected[f"stopping.{joint}.end"] = (RATES[3, j] + rises[j] ** 2 / 4.0) / 0.5 - 1.0
    assert {check.key: check.value for check in checks} == pytest.approx(expected)
    for check in checks:
        begins = check.key.endswith("start")
        assert ("reach the first row" if begins else "after the last row") in check.name
        assert ("begin slower" if begins else "end slower") in check.cure
    assert check_stopping(ends_claim(limit, limits="warn")) == []


@pytest.mark.parametrize(("over", "ok"), [(0.9e-6, True), (1.1e-6, False)])
def test_a_stop_may_pass_a_limit_by_a_millionth(over: float, ok: bool) -> None:
    fastest = 0.6 + 0.4**2 / 4.0
    limit = JointLimits(angle=math.inf, rate=fastest / (1.0 + over), acceleration=1.2, jerk=2.0)
    (check,) = [
        each
        for each in check_stopping(ends_claim(limit, limits="enforce"))
        if each.key == "stopping.cab.start"
    ]
    assert check.ok == ok


def test_angles_count_at_both_ends() -> None:
    """At rest in one place and then in another."""
    t = np.array([0.0, 1.0])
    still = np.zeros((1, 3))
    motion = Motion(t, np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]), still, still)
    machine = replace(DES, limits=(LIMIT,) * 3)
    checks = check_stopping(claim_of(motion, machine=machine, limits="enforce"))
    found = [2.0 * (1.0 + check.value) for check in checks]
    assert found == pytest.approx([0.1, 0.4, 0.2, 0.5, 0.3, 0.6])
