"""Times, ends, held joints and integrals: what must be the same, each broken by itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.model.machine import JOINTS
from des_cli.model.motion import Motion
from des_cli.verify.ends import (
    check_ends,
    check_factors,
    check_hold,
    check_integral,
    check_times,
)
from des_cli.verify.verify import verify
from tests.reduction.conftest import make_cobra, make_problem, make_wave
from tests.support.claims import claim_of, failing, values_of
from tests.support.free_case import SPENT, Case, with_rates

WAVE = make_wave([[0.6, 0.1], [0.1, 0.3], [0.1, -0.2]])
LESS, MORE = 5e-10, 2e-9
"""On either side of what rounding alone may change, in rad and rad/s."""

ENDS: dict[str, set[str]] = {
    "free": {"start.angle"},
    "match-start": {"start.angle", "start.rate"},
    "match-rates": {"start.angle", "start.rate", "ends.rate"},
    "match-both": {"start.angle", "start.rate", "ends.rate", "ends.angle"},
}
PLACES: dict[str, tuple[str, int]] = {
    "start.angle": ("angle", 0),
    "start.rate": ("rate_start", 0),
    "ends.rate": ("rate_end", -1),
    "ends.angle": ("angle", -1),
}


def shifted(motion: Motion, name: str, index: Any, by: float) -> Motion:
    """A motion with some of its numbers moved."""
    values = getattr(motion, name).copy()
    values[index] += by
    return replace(motion, **{name: values})


def even(rate: float = 0.5) -> Motion:
    """A motion at constant rates, whose steps make no error."""
    return with_rates(np.linspace(0.0, 1.0, 5), np.zeros(3), np.full((5, 3), rate))


def test_sample_times_are_the_same_to_the_last_bit() -> None:
    times = WAVE.t.copy()
    times[7] = np.nextafter(times[7], np.inf)
    assert check_times(claim_of(WAVE)).ok
    for other in (times, WAVE.t + 1e-12, WAVE.t * (1.0 - 1e-12)):
        assert not check_times(claim_of(replace(WAVE, t=other), requested=WAVE)).ok
    late = check_times(claim_of(replace(WAVE, t=WAVE.t + 0.25), requested=WAVE))
    assert late.value == pytest.approx(0.25)


@pytest.mark.parametrize("cut", [slice(None, -1), slice(1, None)])
def test_other_numbers_of_samples_are_refused(cut: slice) -> None:
    fewer = Motion(WAVE.t[cut], WAVE.angle[cut], WAVE.rate_start[cut], WAVE.rate_end[cut])
    for modified, requested in ((fewer, WAVE), (WAVE, fewer)):
        check = check_times(claim_of(modified, requested=requested))
        assert check.value == np.inf
        assert not check.ok


def test_nothing_else_is_measured_at_other_times(case: Case) -> None:
    motion = case.solution.modified
    slower = Motion(2.0 * motion.t, motion.angle, motion.rate_start, motion.rate_end)
    assert case.failed(replace(case.solution, modified=slower)) == {"samples.times"}
    fewer = Motion(motion.t[:-1], motion.angle[:-1], motion.rate_start[:-1], motion.rate_end[:-1])
    none = np.zeros((len(fewer.t), 0))
    short = replace(case.solution, modified=fewer, control=none, adjoint=none)
    assert case.failed(short) == {"samples.times"}


@pytest.mark.parametrize("ends", ENDS)
@pytest.mark.parametrize("joint", [0, 1, 2])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_ends_that_must_match_do_so_up_to_rounding(ends: str, joint: int, sign: float) -> None:
    # at constant accelerations, so that the steps make no error
    rate = np.outer(np.linspace(0.5, 1.5, 5), [1.0, -0.5, 0.25])
    motion = with_rates(np.linspace(0.0, 1.0, 5), np.zeros(3), rate)
    for key, (name, at) in PLACES.items():
        for by, broken in ((LESS, False), (MORE, True)):
            modified = shifted(motion, name, (at, joint), sign * by)
            checks = check_ends(claim_of(modified, requested=motion, ends=ends))
            assert {check.key for check in checks} == ENDS[ends]
            assert failing(checks) == ({key} & ENDS[ends] if broken else set())


def test_inside_the_motion_nothing_must_match() -> None:
    modified = shifted(even(), "angle", slice(1, -1), 1.0)
    modified = shifted(modified, "rate_start", slice(1, None), 1.0)
    modified = shifted(modified, "rate_end", slice(None, -1), 1.0)
    assert failing(check_ends(claim_of(modified, requested=even(), ends="match-both"))) == set()


@pytest.mark.parametrize("joint", [1, 2])
def test_a_start_that_is_optimised_is_free_and_no_other(joint: int) -> None:
    options = {"optimise": (f"{JOINTS[joint]}_start",)}
    for moved in range(3):
        modified = shifted(even(), "angle", (slice(None), moved), 0.1)
        failed = failing(check_ends(claim_of(modified, requested=even(), **options)))
        assert failed == (set() if moved == joint else {"start.angle"})


def test_ends_match_the_motion_that_conditioning_made() -> None:
    target = replace(even(), angle=even().angle + 0.1, rate_start=even().rate_start + 0.2)
    for modified, failed in (
        (target, set()),
        (even(), {"start.angle", "start.rate", "ends.angle"}),
    ):
        claim = claim_of(modified, requested=even(), ends="match-both", further={"target": target})
        assert failing(check_ends(claim)) == failed


def test_factors_match_the_rates_of_the_desired_motion() -> None:
    desired = replace(even(), rate_start=even().rate_start + 0.1, rate_end=even().rate_end + 0.1)
    posed = {"posed": make_problem(desired)}
    for modified, failed in ((desired, set()), (even(), {"start.rate", "ends.rate"})):
        claim = claim_of(
            modified, requested=even(), desired=desired, ends="match-both", further=posed
        )
        assert failing(check_ends(claim)) == failed


def test_the_studys_sweep_matches_the_first_angles_alone() -> None:
    other = replace(even(0.7), angle=even(0.7).angle)
    claim = claim_of(other, requested=even(), ends="match-both", algorithm="report-sweep")
    assert [check.key for check in check_ends(claim)] == ["start.angle"]
    moved = claim_of(shifted(other, "angle", 0, MORE), requested=even(), algorithm="report-sweep")
    assert failing(check_ends(moved)) == {"start.angle"}


def test_a_table_may_end_off_by_the_error_of_its_steps() -> None:
    # accelerations from 1 to 4 rad/s^2 over steps of 0.5 and 0.25 s: 0.5^2 / 6 times 3
    t = np.array([0.0, 0.5, 0.75])
    rate = np.outer([0.0, 0.5, 1.5], [0.0, 1.0, 0.5])
    motion = with_rates(t, np.zeros(3), rate)
    for share, broken in ((0.99, False), (1.01, True)):
        modified = shifted(motion, "angle", (-1, 0), -share * 0.125)
        checks = check_ends(claim_of(modified, requested=motion, ends="match-both"))
        assert failing(checks) == ({"ends.angle"} if broken else set())


def test_the_end_of_a_finer_table_is_held_to_more() -> None:
    tolerance = {}
    for intervals in (100, 400):
        case = Case(ends="match-both", requested=make_cobra(intervals))
        (check,) = [c for c in case.checks() if c.key == "ends.angle"]
        assert check.ok
        tolerance[intervals] = check.tolerance
    assert tolerance[400] < tolerance[100] / 8.0


@pytest.mark.parametrize("joint", [0, 1, 2])
@pytest.mark.parametrize(
    ("name", "index", "key"),
    [
        ("angle", 0, "hold"),
        ("angle", -1, "hold"),
        ("rate_start", 0, "hold.rate"),
        ("rate_start", -1, "hold.rate"),
        ("rate_end", 0, "hold.rate"),
        ("rate_end", -1, "hold.rate"),
    ],
)
def test_a_held_joint_plays_the_desired_motion(name: str, index: int, key: str, joint: int) -> None:
    desired = even()
    for held in range(3):
        for by, broken in ((LESS, False), (-LESS, False), (MORE, True), (-MORE, True)):
            modified = shifted(desired, name, (index, joint), by)
            checks = check_hold(claim_of(modified, requested=desired, hold={JOINTS[held]}))
            assert {check.key for check in checks} == {"hold", "hold.rate"}
            assert failing(checks) == ({key} if broken and held == joint else set())


def test_a_held_joint_is_compared_with_the_desired_motion_and_not_the_requested() -> None:
    claim = claim_of(even(0.5), requested=even(0.4), desired=even(0.5), hold={"cab"})
    assert failing(check_hold(claim)) == set()
    claim = claim_of(even(0.4), requested=even(0.4), desired=even(0.5), hold={"cab"})
    assert failing(check_hold(claim)) == {"hold", "hold.rate"}


def test_without_held_joints_nothing_is_compared() -> None:
    assert check_hold(claim_of(even(), desired=even(0.7))) == []


@pytest.mark.parametrize("joint", [0, 1, 2])
@pytest.mark.parametrize("at", [0, 2, 4])
def test_factors_are_those_of_the_rates(joint: int, at: int) -> None:
    desired = even(0.5)
    for by, broken in ((2.0 * LESS, False), (2.0 * MORE, True), (-2.0 * MORE, True)):
        factors = np.full((5, 3), 0.8)
        factors[at, joint] += by
        checks = check_factors(claim_of(even(0.4), requested=desired, factors=factors))
        assert failing(checks) == ({"dynamics.rates"} if broken else set())
    assert check_factors(claim_of(even(0.4), requested=desired)) == []


def test_one_factor_for_all_joints_is_that_of_each() -> None:
    for share, broken in ((0.8, False), (0.8 + 2.0 * MORE, True)):
        claim = claim_of(even(0.4), requested=even(0.5), factors=np.full((5, 1), share))
        assert failing(check_factors(claim)) == ({"dynamics.rates"} if broken else set())


def test_a_joint_that_stands_still_has_no_factor_there() -> None:
    # relative to the joint's own largest rate: the arm's is not the fork's
    rate = np.full((5, 3), 0.5)
    rate[:, 1] = [0.0, 1e-6, 2e-6, 4.0, 4.0]
    desired = with_rates(np.linspace(0.0, 1.0, 5), np.zeros(3), rate)
    for at, broken in ((0, False), (1, False), (3, True)):
        factors = np.ones((5, 3))
        factors[at, 1] = 0.3
        checks = check_factors(claim_of(desired, factors=factors))
        assert failing(checks) == ({"dynamics.rates"} if broken else set())


def test_a_joint_that_never_moves_has_no_factors() -> None:
    rate = np.zeros((5, 3))
    desired = with_rates(np.linspace(0.0, 1.0, 5), np.zeros(3), rate)
    assert failing(check_factors(claim_of(desired, factors=np.zeros((5, 3))))) == set()


@pytest.mark.parametrize("joint", [0, 1, 2])
@pytest.mark.parametrize("first", [0.0, 100.0])
def test_angles_are_the_integrals_of_the_rates_to_a_few_roundings(joint: int, first: float) -> None:
    t = np.linspace(0.0, 1.0, 5)
    start = np.zeros(3)
    start[joint] = first
    motion = with_rates(t, start, np.full((5, 3), 0.5))
    requested = even(0.25)  # another motion: what is asked for may have angles of its own
    size = max(1.0, first)
    for by, broken in ((0.0, False), (14.0 * size, False), (19.0 * size, True)):
        for sign in (1.0, -1.0):
            angle = motion.angle.copy()
            angle[3:, joint] += sign * by * np.finfo(float).eps
            check = check_integral(claim_of(replace(motion, angle=angle), requested=requested))
            assert check.ok is not broken


def test_the_rates_that_are_integrated_are_of_both_sides() -> None:
    motion = even()
    for name in ("rate_start", "rate_end"):
        wrong = shifted(motion, name, (2, 1), 1e-9)
        check = check_integral(claim_of(wrong, requested=even(0.25)))
        assert not check.ok
        assert check.value == pytest.approx(0.5 * 0.25 * 1e-9, rel=1e-4)


def own(at: int, joint: int, base: Callable[[], Motion] = even) -> Motion:
    """A motion whose angles jump by what no rate tells."""
    return shifted(base(), "angle", (slice(at, None), joint), 1e-3)


def test_the_angles_of_a_held_joint_are_its_own() -> None:
    for joint in range(3):
        claim = claim_of(own(3, joint), requested=even(0.25), hold={"fork"})
        assert check_integral(claim).ok is (joint == 1)


def test_a_motion_that_is_passed_through_keeps_its_angles() -> None:
    passed = own(3, 2)
    assert check_integral(claim_of(passed)).ok
    assert check_integral(claim_of(replace(passed), requested=passed)).ok
    for name in ("angle", "rate_start", "rate_end"):
        other = shifted(passed, name, (1, 0), 1e-9)
        assert not check_integral(claim_of(other, requested=passed)).ok


@pytest.mark.parametrize(("at", "good"), [(2, False), (3, True), (6, True), (7, False)])
def test_in_the_leads_angles_are_integrals_whatever_the_maneuver(at: int, good: bool) -> None:
    # samples 2 to 6 are the maneuver, which is passed through and has its fork held
    def led() -> Motion:
        return with_rates(np.arange(-2.0, 7.0) / 4.0, np.zeros(3), np.full((9, 3), 0.5))

    for hold, maneuver in (({"fork"}, even(0.25)), (set(), even())):
        table = own(at, 1, led)
        claim = claim_of(even(), requested=maneuver, hold=hold, further={"commands": table})
        assert check_integral(claim).ok is good


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_an_angle_of_an_optimum_that_is_not_the_integral(case: Case, joint: int) -> None:
    angle = case.solution.modified.angle.copy()
    angle[120:, joint] += 1e-9
    broken = case.played(replace(case.solution.modified, angle=angle))
    assert case.failed(broken) - SPENT == {"dynamics.angles"}


def test_a_start_that_is_off(case: Case) -> None:
    assert case.failed(case.moved(start=(0.0, 0.0, 1e-8))) - SPENT == {"start.angle"}
    gentle = [(k, 2, -2e-9 * (1.0 - k / 50)) for k in range(50)]
    assert case.failed(case.moved(*gentle)) - SPENT == {"start.rate"}
    assert case.failed(case.moved(*gentle), ends="free") <= {"optimality", *SPENT}


def test_a_start_that_is_free_may_be_off() -> None:
    case = Case(ends="free", optimise=("cab_start",))
    start = case.solution.modified.angle[0] - case.requested.angle[0]
    assert abs(start[2]) > 0.01
    assert case.failed() == set()
    assert "start.angle" in case.failed(optimise=())
    assert "start.angle" in case.failed(case.moved(start=(0.0, 1e-8, 0.0)))


def test_an_end_that_is_off() -> None:
    case = Case(ends="match-both")
    n = len(case.requested.t)
    late = [(n - 1 - k, 1, 2e-9 * (1.0 - k / 40)) for k in range(40)]
    assert case.failed(case.moved(*late)) - SPENT == {"ends.rate"}
    bump = [(100 + k, 1, 1e-3 * np.sin(np.pi * k / 100) ** 2) for k in range(101)]
    assert "ends.angle" in case.failed(case.moved(*bump))
    assert "ends.angle" not in case.failed(case.moved(*bump), ends="match-rates")


def test_a_joint_that_is_held_but_moves() -> None:
    case = Case(hold=frozenset({"cab"}))
    bump = [(100 + k, 2, 1e-7 * np.sin(2.0 * np.pi * k / 60)) for k in range(61)]
    assert "hold" in case.failed(case.moved(*bump))
    assert "hold" not in case.failed(case.moved(*[(k, 1, change) for k, _, change in bump]))


def test_factors_that_are_not_those_of_the_motion() -> None:
    case = Case(control="per-joint", ends="free")
    control = case.solution.control.copy()
    control[60, 0] += 1e-6
    assert case.failed(replace(case.solution, control=control)) == {"dynamics.rates"}


def test_every_check_of_this_module_is_one_of_the_verifications() -> None:
    claim = claim_of(
        even(0.4),
        requested=even(0.5),
        factors=np.full((5, 3), 0.7),
        hold={"arm"},
        ends="match-both",
    )
    found = values_of(verify(claim))
    own_keys = {"samples.times", "dynamics.angles", "dynamics.rates", "hold", "hold.rate"}
    assert own_keys | ENDS["match-both"] <= set(found)
    assert found["dynamics.rates"] == pytest.approx(0.05)


@pytest.mark.parametrize(("share", "seen"), [(0.9e-6, False), (1.1e-6, True)])
def test_a_factor_means_something_from_a_millionth_of_a_joints_largest_rate(
    share: float, seen: bool
) -> None:
    """Of a rate of 1e4 rad/s; factors of two are told where it is doubled but in one place."""
    rates = np.full((5, 3), 1e4)
    rates[2, 1] = share * 1e4
    desired = with_rates(np.arange(5.0), np.zeros(3), rates)
    doubled = 2.0 * rates
    doubled[2, 1] += 1e-3
    modified = with_rates(np.arange(5.0), np.zeros(3), doubled)
    claim = claim_of(modified, requested=desired, factors=np.full((5, 3), 2.0))
    (check,) = check_factors(claim)
    assert check.value == pytest.approx(1e-3 if seen else 0.0, abs=1e-9)
