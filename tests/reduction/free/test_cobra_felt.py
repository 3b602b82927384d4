"""Free motions of the Cobra and a few others, re-evaluated by code that is not the tool's.

Every bound is that of an independent study (CasADi/IPOPT, several starts and meshes), less
a tenth of a percent. A solution goes through its command table: the rows are read again as
a motion and compared with the maneuver's formulas between them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from des_cli import load_profile
from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion
from des_cli.model.profile import Profile, Reduction
from des_cli.reduction.free.method import FreeResult, find_free_motion
from des_cli.reduction.free.task import FreeTask
from des_cli.reduction.limits import find_violations
from tests.support.cobra import States
from tests.support.felt_reference import Evaluation, Path3, Table, by_parabolas, evaluate
from tests.support.free_motions import ATTITUDE, JOINTS, RATE, TURNING, G
from tests.support.seat_forms import Floats

pytestmark = pytest.mark.slow

NO_JERK = np.inf
ALL_FOUR = ("seat_yaw", "seat_pitch", "fork_start", "cab_start")
MEASURED = {
    G: lambda felt: felt.seat_g_rms_error_g,
    RATE: lambda felt: felt.seat_rate_deviation_relative,
    JOINTS: lambda felt: felt.joint_deviation_relative,
    TURNING: lambda felt: felt.turning_rms_error,
    ATTITUDE: lambda felt: felt.attitude_error_max_deg,
}


@dataclass(frozen=True)
class Case:
    """What is asked for: budgets, jerk limits over acceleration limits [1/s], the rest."""

    budget: tuple[tuple[str, float], ...]
    jerk: float = 2.0
    ends: str = "free"
    control: str = "free"
    optimise: tuple[str, ...] = ()
    max_iterations: int = 3000

    def of(self, profile: Profile) -> Profile:
        limits = tuple(
            replace(limit, jerk=self.jerk * limit.acceleration) for limit in profile.machine.limits
        )
        reduction = Reduction(
            control=self.control,  # type: ignore[arg-type]
            ends=self.ends,  # type: ignore[arg-type]
            optimise=self.optimise,  # type: ignore[arg-type]
            max_iterations=self.max_iterations,
            budget=tuple(Budget(*each) for each in self.budget),  # type: ignore[arg-type]
        )
        machine = replace(profile.machine, limits=limits)
        return replace(profile, machine=machine, reduction=reduction)


@dataclass(frozen=True)
class Found:
    """A solution, and what a pilot would feel of it."""

    profile: Profile
    result: FreeResult
    felt: Evaluation

    @property
    def modified(self) -> Motion:
        return self.result.solution.modified


def case(jerk: float = 2.0, /, *, ends: str = "free", control: str = "free", optimise=(), **budget):
    names = {"g": G, "rate": RATE, "joints": JOINTS, "turning": TURNING, "attitude": ATTITUDE}
    return Case(
        tuple((names[key], most) for key, most in budget.items()), jerk, ends, control, optimise
    )


def path_of(motion: Motion) -> Path3:
    """The motion that has linear rates between its samples."""

    def at(t: Floats) -> States:
        k = np.clip(np.searchsorted(motion.t, t, side="right") - 1, 0, len(motion.t) - 2)
        s, step = (t - motion.t[k])[:, None], np.diff(motion.t)[k][:, None]
        growth = (motion.rate_end[k] - motion.rate_start[k]) / step
        start = motion.rate_start[k]
        return motion.angle[k] + s * start + s**2 / 2 * growth, start + s * growth, growth

    return at


@cache
def solve(name: str, asked: Case) -> Found:
    """Solve on the profile's own grid and evaluate the command table."""
    profile = asked.of(load_profile(name))
    desired = make_desired(profile).motion
    result = find_free_motion(FreeTask.of(profile, desired))
    assert result.solution.status == "converged", result.solution.message
    modified = result.solution.modified
    table = Table(modified.t, modified.rate[:, 0], modified.angle[:, 1:])
    seats: dict[str, Any] = {
        "seat": (profile.seat.yaw, profile.seat.pitch),
        "modified_seat": (result.seat.yaw, result.seat.pitch),
    }
    if name != "cobra":
        seats |= {"desired": path_of(desired), "kinks": ()}
    return Found(profile, result, evaluate(by_parabolas(table), table.t, **seats))


def kept(found: Found, asked: Case) -> None:
    """Budgets, limits and ends hold on the table."""
    felt = found.felt
    for metric, most in asked.budget:
        assert MEASURED[metric](felt) <= most * (1.0 + 2e-3), metric
    assert find_violations(found.profile.machine, found.modified, "modified") == ()
    limits = found.profile.machine.limits
    for name, peak in (
        ("rate", felt.rate_peak),
        ("acceleration", felt.acceleration_peak),
        ("jerk", felt.jerk_peak),
    ):
        bound = np.array([getattr(limit, name) for limit in limits])
        assert np.all(peak <= bound * (1.0 + 1e-3)), name
    freed = [f"{joint}_start" in asked.optimise for joint in ("arm", "fork", "cab")]
    np.testing.assert_allclose(felt.start_angle[~np.array(freed)], 0.0, atol=1e-6)
    if asked.ends != "free":
        np.testing.assert_allclose(felt.start_rate, 0.0, atol=1e-4)
    if asked.ends in ("match-rates", "match-both"):
        np.testing.assert_allclose(felt.end_rate, 0.0, atol=1e-4)
    if asked.ends == "match-both":
        np.testing.assert_allclose(felt.end_angle, 0.0, atol=1e-3)


def reaches(name: str, asked: Case, least: float) -> Found:
    found = solve(name, asked)
    kept(found, asked)
    assert 100.0 * found.felt.reduction >= least
    return found


FELT = [
    (case(g=0.05, rate=0.1), 33.2),
    (case(g=0.05, rate=0.1, control="per-joint"), 32.9),
    (case(g=0.05, rate=0.1, optimise=ALL_FOUR), 37.9),
    (case(g=0.05, rate=0.1, ends="match-start"), 33.1),
    (case(1.0, g=0.05, rate=0.1, turning=0.15, ends="match-rates"), 31.1),
    (case(1.0, g=0.05, rate=0.1, turning=0.15, ends="match-both"), 24.0),
    (case(1.0, g=0.1, rate=0.1), 45.1),
    (case(1.0, g=0.1, rate=0.1, optimise=ALL_FOUR), 49.4),
    (case(g=0.1, rate=0.2), 59.7),
    (case(g=0.2, rate=0.2), 74.7),
]
ALONE = [
    (case(5.0, joints=0.05), 82.4),
    (case(2.0, joints=0.05), 77.6),
    (case(1.0, joints=0.05), 72.9),
    (case(NO_JERK, joints=0.05), 83.5),
    (case(NO_JERK, g=0.1, control="per-joint"), 98.8),
    (case(NO_JERK, attitude=5.0, control="per-joint"), 59.7),
    (case(NO_JERK, attitude=10.0, control="per-joint"), 82.1),
]


def spoken(value: Any) -> str | None:
    if not isinstance(value, Case):
        return None
    words = [f"{metric.split('_error')[0]}={most}" for metric, most in value.budget]
    return "-".join([*words, f"jerk={value.jerk:g}", value.ends, value.control, *value.optimise])


@pytest.mark.parametrize(("asked", "least"), FELT, ids=spoken)
def test_budgets_on_what_is_felt(asked: Case, least: float) -> None:
    found = reaches("cobra", asked, least)
    # somewhere a budget binds: nothing was left on the table
    spent = [MEASURED[metric](found.felt) / most for metric, most in asked.budget]
    assert max(spent) > 0.99


@pytest.mark.parametrize(("asked", "least"), ALONE, ids=spoken)
def test_budgets_that_leave_fast_motions_free(asked: Case, least: float) -> None:
    reaches("cobra", asked, least)


def test_a_budget_on_the_angular_acceleration_tames_that_on_the_joints() -> None:
    found = reaches("cobra", case(joints=0.05, turning=0.15), 59.5)
    assert found.felt.turning_peak_after <= 0.56


@pytest.mark.parametrize(
    ("name", "least"),
    [("post_stall_reversal", 32.0), ("rolling_spin", 15.3), ("rapid_onset", 24.4)],
)
def test_other_maneuvers(name: str, least: float) -> None:
    # the study left the rates at the start free
    reaches(name, case(g=0.05, rate=0.1), least)


SHIPPED = (
    "barrel_roll",
    "cobra",
    "cobra_table3",
    "flight_log",
    "gradual_onset",
    "post_stall_reversal",
    "rapid_onset",
    "rolling_spin",
)


@pytest.mark.parametrize("name", SHIPPED)
def test_the_defaults_leave_a_ride_no_rougher_than_the_record(name: str) -> None:
    profile = replace(load_profile(name), reduction=Reduction())
    assert profile.machine.name == "des"  # what the evaluation knows
    desired = make_desired(profile).motion
    solution = find_free_motion(FreeTask.of(profile, desired)).solution
    assert solution.status == "converged", solution.message
    modified, seat = solution.modified, (profile.seat.yaw, profile.seat.pitch)
    table = Table(modified.t, modified.rate[:, 0], modified.angle[:, 1:])
    felt = evaluate(by_parabolas(table), table.t, desired=path_of(desired), kinks=(), seat=seat)
    assert felt.turning_rms_after <= 1.05 * felt.turning_rms_before
    assert felt.g_peak_after[1] <= felt.g_peak_before[1] + 0.1
    assert felt.reduction > -1e-9


def test_more_freedom_and_more_budget_never_cost() -> None:
    def left(asked: Case) -> float:
        return 1.0 - solve("cobra", asked).felt.reduction

    free, per_joint, optimised, matched = (asked for asked, _ in FELT[:4])
    assert left(optimised) < left(free) <= left(matched) + 1e-4
    assert left(free) <= left(per_joint) + 1e-4
    assert left(FELT[9][0]) < left(FELT[8][0]) < left(free)


@pytest.mark.parametrize("step", [0.0099, 0.0101])
def test_neighbouring_tables_have_the_same_answer(
    step: float, resampled: Callable[[float], Profile]
) -> None:
    asked = case(g=0.05, rate=0.1, ends="match-start")
    profile = asked.of(resampled(step))
    desired = make_desired(profile).motion
    solution = find_free_motion(FreeTask.of(profile, desired)).solution
    assert solution.status == "converged"
    reference = solve("cobra", asked).result.solution
    one, other = (1.0 - each.cost / each.cost_unreduced for each in (solution, reference))
    assert one == pytest.approx(other, abs=1e-3)


@pytest.fixture
def resampled() -> Callable[[float], Profile]:
    return lambda step: load_profile("cobra", settings=[f"time.step_s={step}"])
