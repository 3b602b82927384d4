"""Coming to rest from any state: against a linear program, closed forms and plain mechanics."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linprog

from des_cli.model.machine import JointLimits
from des_cli.verify.stopping import State, best_reach, excess, reach_of_stop

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
    for _ in range(200):
        state = State(*(rng.uniform(-1, 1, 3) * [2.0, 3.0, 1.2]))
        reach, other = best_reach(state, LIMIT), best_reach(state.mirrored, LIMIT)
        assert (reach.least, reach.most, reach.rate) == (-other.most, -other.least, other.rate)
        assert state.reversed.reversed == state
        # Passing a state on the way to rest is possible from any state before it.
        later = state.after(0.01, 0.0)
        if abs(later.rate) <= 3.0 and abs(later.angle) <= 2.0 and excess(later, LIMIT) < 0.0:
            wide = replace(LIMIT, jerk=LIMIT.jerk * 1.5)
            assert excess(state, wide) < 0.05
