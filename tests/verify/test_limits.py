"""Each limit of each joint, measured on a table by itself."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machine import JOINTS, JointLimits, Machine
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.model.profile import Reduction
from des_cli.model.solution import Solution
from des_cli.reduction.problem import Problem
from des_cli.verify.limits import check_limits, magnitudes
from tests.support.claims import claim_of, failed_of_factors, failing, values_of
from tests.support.free_case import SPENT, Case, with_rates

NONE = JointLimits(math.inf, math.inf, math.inf, math.inf)
FINE = {f"limits.{joint}.rate_step" for joint in JOINTS}


def limited(joint: int, **bounds: float) -> Machine:
    """A machine that bounds one joint alone."""
    limits = [NONE, NONE, NONE]
    limits[joint] = replace(NONE, **bounds)
    return replace(DES, limits=(limits[0], limits[1], limits[2]))


def moving(joint: int, rate: list[float], first: float = 0.0) -> Motion:
    """A table in which one joint moves, with half a second between the samples."""
    rates = np.zeros((len(rate), 3))
    rates[:, joint] = rate
    start = np.zeros(3)
    start[joint] = first
    return with_rates(0.5 * np.arange(len(rate)), start, rates)


PEAKS = [
    # angles are the sums of a quarter of neighbouring rates; jerk is over half a second
    ("angle", [0.0, 1.0, 2.0, 1.0, 0.0], 0.0, 2.0),
    ("angle", [0.0, -1.0, -2.0, -1.0, 0.0], 1.5, 1.5),
    ("rate", [0.0, 1.0, 2.0, 1.0, 0.0], 0.0, 2.0),
    ("rate", [-2.0, 1.0, 0.5, 1.0, 0.0], 0.0, 2.0),
    ("rate", [0.0, 1.0, 0.5, 1.0, 3.0], 0.0, 3.0),
    ("acceleration", [0.0, 2.0, 2.0, 2.0, 1.0], 0.0, 4.0),
    ("acceleration", [0.0, 0.0, 0.0, -0.5, 1.0], 0.0, 3.0),
    ("acceleration", [0.0, 0.5, -1.0, -1.0, -1.0], 0.0, 3.0),
    ("jerk", [0.0, 1.0, 0.0, 0.0, 0.0], 0.0, 8.0),
    ("jerk", [0.0, 0.0, 0.0, 1.0, 4.0], 0.0, 8.0),
]


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("joint", [0, 1, 2])
@pytest.mark.parametrize(("quantity", "rate", "first", "peak"), PEAKS)
def test_a_limit_is_kept_up_to_rounding(
    quantity: str, rate: list[float], first: float, peak: float, joint: int, sign: float
) -> None:
    motion = moving(joint, [sign * each for each in rate], sign * first)
    key = f"limits.{JOINTS[joint]}.{quantity}"
    for excess, broken in ((-1e-3, False), (5e-10, False), (2e-9, True), (0.25, True)):
        machine = limited(joint, **{quantity: peak / (1.0 + excess)})
        checks = check_limits(claim_of(motion, machine=machine))
        assert {check.key for check in checks} == {key, *FINE}
        assert failing(checks) == ({key} if broken else set())
        assert values_of(checks)[key] == pytest.approx(excess, abs=1e-12)


def test_the_limits_of_a_joint_are_its_own() -> None:
    # the joints move by 1, 2 and 4 rad/s; each is bounded just below or above it
    rates = np.outer([0.0, 1.0, 0.0], [1.0, 2.0, 4.0])
    motion = with_rates(np.array([0.0, 1.0, 2.0]), np.zeros(3), rates)
    for tight in range(3):
        bounds = [(0.9 if j == tight else 1.1) * 2.0**j for j in range(3)]
        limits = [replace(NONE, rate=bound) for bound in bounds]
        machine = replace(DES, limits=(limits[0], limits[1], limits[2]))
        assert failing(check_limits(claim_of(motion, machine=machine))) == {
            f"limits.{JOINTS[tight]}.rate"
        }


@pytest.mark.parametrize("limits", ["check", "warn"])
def test_limits_are_measured_only_where_they_are_enforced(limits: str) -> None:
    motion = moving(1, [0.0, 9.0, 0.0])
    assert failing(check_limits(claim_of(motion))) >= {"limits.fork.rate", "limits.fork.jerk"}
    assert check_limits(claim_of(motion, limits=limits)) == []


def test_the_table_with_its_leads_is_measured() -> None:
    maneuver, table = moving(1, [0.0, 0.1, 0.0]), moving(1, [0.0, 9.0, 0.0])
    checks = check_limits(claim_of(maneuver, further={"commands": table}))
    assert values_of(checks)["limits.fork.rate"] == pytest.approx(9.0 / 3.14 - 1.0)


@pytest.mark.parametrize("joint", [0, 1, 2])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("at", [0, 2])
def test_a_rate_steps_by_no_more_than_rounding(joint: int, sign: float, at: int) -> None:
    for size, broken in ((5e-10, False), (2e-9, True)):
        motion = moving(joint, [0.0] * 5)
        start = motion.rate_start.copy()
        start[at + 1, joint] += sign * size
        checks = check_limits(claim_of(replace(motion, rate_start=start)))
        key = f"limits.{JOINTS[joint]}.rate_step"
        assert failing(checks) == ({key} if broken else set())
        assert values_of(checks)[key] == pytest.approx(size)


def test_both_sides_of_a_step_are_rates() -> None:
    for side, values in (("rate_start", [0.0, 0.0, 3.0, 0.0]), ("rate_end", [0.0, 3.0, 0.0, 0.0])):
        column = np.zeros((4, 3))
        column[:, 1] = values
        motion = replace(moving(1, [0.0] * 5), **{side: column})
        checks = check_limits(claim_of(motion, machine=limited(1, rate=2.0)))
        assert values_of(checks)["limits.fork.rate"] == pytest.approx(0.5)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_an_angle_counts_between_samples_where_the_rate_turns_and_only_there(sign: float) -> None:
    # from 1 with the rate 2 to -2 in 1 s: back at 1, the top of the parabola is at half a second
    turning = with_rates(
        np.array([0.0, 1.0]), np.full(3, sign), sign * np.array([[2.0] * 3, [-2.0] * 3])
    )
    np.testing.assert_allclose(magnitudes(turning)["angle"], [[1.5] * 3, [1.0] * 3], atol=1e-15)
    # slowing without turning, its vertex is beyond the interval: the end is the largest
    slowing = with_rates(np.array([0.0, 1.0]), np.zeros(3), sign * np.array([[2.0] * 3, [1.0] * 3]))
    np.testing.assert_allclose(magnitudes(slowing)["angle"], [[0.0] * 3, [1.5] * 3])


def test_magnitudes_stand_beside_the_samples_where_they_are() -> None:
    motion = moving(2, [0.0, 1.0, -0.5, -0.5])
    found = {name: values[:, 2] for name, values in magnitudes(motion).items()}
    assert list(found) == ["angle", "rate", "acceleration", "jerk"]
    # by hand: from 1 to -0.5 in half a second it turns after a third, at 0.25 + 1 / 6
    for name, expected in (
        ("angle", [0.0, 0.25 + 1.0 / 6.0, 0.375, 0.125]),
        ("rate", [0.0, 1.0, 0.5, 0.5]),
        ("acceleration", [2.0, 3.0, 3.0, 0.0]),
        ("jerk", [0.0, 10.0, 6.0, 0.0]),
    ):
        np.testing.assert_allclose(found[name], expected, atol=1e-15)


def test_a_table_of_one_interval_has_no_jerk() -> None:
    checks = check_limits(claim_of(moving(0, [0.1, 0.2])))
    assert failing(checks) == set()
    assert values_of(checks)["limits.arm.jerk"] == -1.0


@pytest.mark.parametrize("at", [1, 5])
@pytest.mark.parametrize(("units", "broken"), [(4, False), (12, True)])
def test_a_jerk_that_rounding_makes_is_none(at: int, units: int, broken: bool) -> None:
    # a rate of 1 rad/s, whose last place is 2.2e-16: 16 of these, over the step squared
    t = 1e-3 * np.arange(7)
    rate = np.ones((7, 3))
    rate[at, 1] += units * np.finfo(float).eps
    checks = check_limits(claim_of(with_rates(t, np.zeros(3), rate), machine=limited(1, jerk=1e-9)))
    assert failing(checks) == ({"limits.fork.jerk"} if broken else set())
    if broken:
        allowed, made = 16.0 * np.finfo(float).eps / 1e-6, 24.0 * np.finfo(float).eps / 1e-6
        left = (values_of(checks)["limits.fork.jerk"] + 1.0) * 1e-9
        assert left == pytest.approx(made - allowed, rel=1e-2)


@pytest.mark.parametrize(("first", "second"), [(2.0, 1.0), (1.0, 2.0)])
@pytest.mark.parametrize(("units", "broken"), [(24, False), (40, True)])
def test_what_rounding_makes_is_by_the_faster_side_and_the_shorter_step(
    first: float, second: float, units: int, broken: bool
) -> None:
    # 16 last places of the faster rate, 2 rad/s, over the square of the shorter step, 1 ms
    t = np.array([0.0, 1e-3, 3e-3]) if first == 2.0 else np.array([0.0, 2e-3, 3e-3])
    rate = np.zeros((2, 3))
    rate[:, 2] = first, second
    end = rate.copy()
    made = units * np.finfo(float).eps * 1.5e-3 * np.diff(t)[1] / 1e-6
    end[1, 2] += made
    motion = Motion(t, np.zeros((3, 3)), rate, end)
    checks = check_limits(claim_of(motion, machine=limited(2, jerk=1e-15)))
    key = "limits.cab.jerk"
    assert (key in failing(checks)) is broken


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_a_spike_of_jerk_at_one_sample_of_an_optimum(case: Case, joint: int) -> None:
    limit = DES.limits[joint].jerk
    spike = 0.6 * limit * case.requested.step[0] ** 2  # its second difference is 1.2 times it
    at = np.argmin(np.abs(case.solution.modified.jerk[:, joint])) + 1
    failed = case.failed(case.moved((at, joint, spike)))
    key = f"limits.{JOINTS[joint]}.jerk"
    assert key in failed
    assert failed <= {key, "optimality", *SPENT}


@pytest.mark.parametrize(
    ("quantity", "share"), [("acceleration", 0.9), ("jerk", 0.999), ("rate", 0.9), ("angle", 0.9)]
)
def test_limits_that_are_smaller_than_an_optimum_takes(
    case: Case, quantity: str, share: float
) -> None:
    motion = case.solution.modified
    peak = float(np.max(np.abs(getattr(motion, quantity)[:, 1])))
    for factor, broken in ((1.0 + 1e-5, False), (share, True), (1.0 - 1e-5, True)):
        fork = replace(DES.limits[1], **{quantity: factor * peak})
        machine = replace(DES, limits=(DES.limits[0], fork, DES.limits[2]))
        assert case.failed(machine=machine) == ({f"limits.fork.{quantity}"} if broken else set())


def test_a_step_of_a_rate_in_an_optimum(case: Case) -> None:
    motion = case.solution.modified
    start = motion.rate_start.copy()
    start[100:, 2] += 1e-8
    end = motion.rate_end.copy()
    end[100:, 2] += 1e-8
    rise = np.cumsum(0.5 * motion.step[:, None] * (start + end), axis=0)
    angle = motion.angle[0] + np.vstack([np.zeros(3), rise])
    stepped = case.played(Motion(motion.t, angle, start, end))
    assert case.failed(stepped) - SPENT == {"limits.cab.rate_step"}
    assert case.failed(stepped, limits="check") <= SPENT


def test_a_limit_that_factors_break_by_little(
    inside: tuple[Problem, Solution],
) -> None:
    problem, solution = inside
    # The solver keeps a millionth clear of the limits itself.
    gentler = DES.limits[0].acceleration * (1.0 - 1e-5)
    limits = (replace(DES.limits[0], acceleration=gentler), *DES.limits[1:])
    keys = failed_of_factors(
        replace(problem, machine=replace(DES, limits=limits)), solution, Reduction(budget=())
    )
    assert "limits.arm.acceleration" in keys
    assert set(keys) <= {"limits.arm.acceleration", "optimality"}


@pytest.mark.parametrize("length", [1, 4, 39])
def test_a_long_table_is_measured_in_pieces(length: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every excess is what it is in the whole, also where pieces join."""
    draw = np.random.default_rng(4)
    t = np.cumsum(draw.uniform(0.1, 0.3, 40))
    start, end = draw.normal(size=(2, 39, 3))
    claim = claim_of(Motion(t, draw.normal(size=(40, 3)), start, end))
    whole = values_of(check_limits(claim))
    monkeypatch.setattr("des_cli.model.motion.PIECE", length)
    assert values_of(check_limits(claim)) == whole
    assert len(whole) > 9
