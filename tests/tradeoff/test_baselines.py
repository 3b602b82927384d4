"""What simpler means reach: known numbers, the formula, and which motion they follow."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion, integrate_sides
from des_cli.model.profile import Profile
from des_cli.pipeline import prepare_profile
from des_cli.profiles_in.load import load_profile
from des_cli.tradeoff.baselines import CONSTANT_FACTORS, baseline_points
from tests.support.points import Rows, column, curve


def test_the_study_is_there_for_each_weight(by_weight: Rows) -> None:
    # Its single sweep on this profile: 13.5, 63.9 and 11.4 %.
    study = curve(by_weight, "report-sweep")
    assert column(study, "value") == [8.0, 1.0, 0.2]
    assert column(study, "bb3_reduction") == pytest.approx([0.135, 0.639, 0.114], abs=3e-3)
    assert {row["status"] for row in study} == {"baseline"}


def bb3(motion: Motion, p: float) -> np.ndarray:
    """BB3 of (23) for angles and rates that a constant factor slows down."""
    start = motion.angle[0]
    (a1, a2, _), rates = (
        np.moveaxis(start + p * (motion.angle_sides - start), -1, 0),
        p * np.moveaxis(motion.rate_sides, -1, 0),
    )
    s1, c1, s2, c2 = np.sin(a1), np.cos(a1), np.sin(a2), np.cos(a2)
    return -c1 * rates[0] * rates[1] + (s1 * c2 * rates[0] + c1 * s2 * rates[1]) * rates[2]


def test_constant_factors_are_those_of_the_formula(by_weight: Rows) -> None:
    motion = make_desired(load_profile("cobra", settings=["time.step_s=0.05"])).motion
    before = integrate_sides(motion.step, bb3(motion, 1.0) ** 2)
    away = motion.angle_sides - motion.angle[0]
    energy = [
        integrate_sides(motion.step, np.sum(v**2, axis=-1)) for v in (away, motion.angle_sides)
    ]
    per_slowing = np.sqrt(energy[0] / energy[1])
    points = curve(by_weight, "constant-p")
    assert column(points, "value") == list(CONSTANT_FACTORS)
    for point, p in zip(points, CONSTANT_FACTORS, strict=True):
        left = integrate_sides(motion.step, bb3(motion, p) ** 2) / before
        # The solver's own motion between samples is linear in the rates, as here.
        assert float(point["bb3_reduction"]) == pytest.approx(1.0 - left, abs=2e-3)
        deviation = float(point["joint_deviation_relative"])
        assert deviation == pytest.approx((1.0 - p) * per_slowing, rel=1e-3)
        assert point["cost"] == ""


@pytest.mark.slow
def test_the_optimum_beats_a_constant_factor_of_the_same_deviation(by_budget: Rows) -> None:
    constant = curve(by_budget, "constant-p")
    slow = np.interp(
        0.05, column(constant, "joint_deviation_relative"), column(constant, "objective_reduction")
    )
    assert float(curve(by_budget, "optimum")[1]["objective_reduction"]) > slow + 0.1


def cobra(*settings: str) -> Profile:
    return load_profile("cobra", settings=["time.step_s=0.25", *settings])


def test_the_weight_of_the_profile_is_taken_where_none_is_given() -> None:
    points = baseline_points(cobra("reduction.r2=[1, 2, 6]"))
    assert [point.algorithm for point in points] == [
        "report-sweep",
        *["constant-p"] * len(CONSTANT_FACTORS),
    ]
    assert (points[0].swept, points[0].value) == ("r2", 3.0)
    assert {point.status for point in points} == {"baseline"}
    given = baseline_points(cobra("reduction.r2=[1, 2, 6]"), (3.0, 0.5))
    assert [point.value for point in given[:2]] == [3.0, 0.5]
    assert given[0] == points[0]


def test_controls_and_budgets_of_the_profile_change_nothing() -> None:
    profile = cobra()
    other = replace(
        profile.reduction,
        control="free",
        hold=frozenset({"cab"}),
        ends="match-both",
        budget=(Budget("joint_deviation_relative", 0.05),),
    )
    assert baseline_points(replace(profile, reduction=other)) == baseline_points(profile)


def test_a_motion_that_is_made_already_is_the_one_that_is_slowed() -> None:
    profile, other = cobra(), cobra("joints.arm_rpm=5")
    prepared = prepare_profile(other)
    assert baseline_points(profile, (), prepared) == baseline_points(other)
    assert baseline_points(profile) != baseline_points(other)


def test_the_sweep_that_runs_away_has_a_status_and_no_numbers() -> None:
    (ran, *_) = baseline_points(cobra(), (1e-9,))
    assert ran.status == "diverged"
    assert (ran.cost, ran.objective_reduction, ran.limits_ok) == (None, None, None)
    assert ran.message


def test_enforced_limits_are_kept_by_what_is_slowed_down() -> None:
    warned = baseline_points(cobra("reduction.limits=warn"))
    enforced = baseline_points(cobra("reduction.limits=enforce"))
    # the cab of the Cobra turns back at once, which no factor mends and no limit admits
    assert not any(point.limits_ok for point in warned[1:])
    assert all(point.limits_ok for point in enforced[1:])
    # both are measured against what was asked for
    assert enforced[1].seat_angular_acceleration_peak_before_rad_s2 == (
        warned[1].seat_angular_acceleration_peak_before_rad_s2
    )
