"""What ``reduction:`` says, and what it gets where it is silent."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.profile import Reduction
from des_cli.profiles_in.builtin import builtin_profiles
from des_cli.profiles_in.load import load_profile
from tests.support.profiles import SMALL, load


def test_a_silent_profile_gets_the_defaults_of_the_model() -> None:
    profile = load(SMALL)
    plain = Reduction()
    assert profile.machine == DES
    assert profile.seat.yaw == np.pi / 2
    assert profile.reduction.axes == plain.axes
    np.testing.assert_array_equal(profile.reduction.r1, plain.r1)
    np.testing.assert_allclose(profile.initial_angle, [0, 0, np.radians(5)])


def test_every_key_of_the_reduction_reaches_the_model() -> None:
    section = """\
reduction: {method: zero, algorithm: report-sweep, control: per-joint, axes: report,
  jacobian: adapted, r1: [[2, 1, 0], [1, 3, 0], [0, 0, 0]], r2: [1, 2, 3], tracking: 0.5,
  limits: check, iterations: 3, max_iterations: 40, hold: [fork, cab], ends: match-both}
"""
    found = load(SMALL + section).reduction
    words = (found.method, found.algorithm, found.control, found.axes, found.jacobian, found.limits)
    assert words == ("zero", "report-sweep", "per-joint", "report", "adapted", "check")
    assert (found.iterations, found.max_iterations, found.ends) == (3, 40, "match-both")
    assert found.hold == {"fork", "cab"}
    np.testing.assert_array_equal(found.r1, [[2, 1, 0], [1, 3, 0], [0, 0, 0]])
    np.testing.assert_array_equal(found.r2, [1, 2, 3])
    np.testing.assert_array_equal(found.tracking, [0.5, 0.5, 0.5])


FELT = (
    Budget("seat_g_rms_error_g", 0.05),
    Budget("seat_rate_deviation_relative", 0.1),
    Budget("seat_angular_acceleration_rms_ratio", 1.05),
    Budget("seat_angular_acceleration_peak_ratio", 1.1),
)


@pytest.mark.parametrize(
    ("section", "budget"),
    [
        ("", FELT),
        ("{axes: report}", FELT),
        ("{control: scalar}", FELT[:3]),
        ("{budget: 0.1}", (Budget("joint_deviation_relative", 0.1),)),
        ("{budget: {seat_g_rms_error_g: 0.2}}", (Budget("seat_g_rms_error_g", 0.2),)),
        (
            "{budget: {attitude_error_max_deg: 5, seat_g_rms_error_g: 0.2}}",
            (Budget("attitude_error_max_deg", 5.0), Budget("seat_g_rms_error_g", 0.2)),
        ),
        ("{budget: 0.1, algorithm: report-sweep}", (Budget("joint_deviation_relative", 0.1),)),
        ("{r2: 1}", ()),
        ("{tracking: 1}", ()),
        ("{algorithm: report-sweep}", ()),
        ("{method: zero}", ()),
    ],
)
def test_weights_and_methods_without_a_budget_have_none(section: str, budget: tuple) -> None:
    text = SMALL + (f"reduction: {section}\n" if section else "")
    assert load(text).reduction.budget == budget


def test_a_silent_profile_is_fit_to_fly() -> None:
    found = load(SMALL).reduction
    words = (found.control, found.axes, found.limits, found.ends, found.objective, found.optimise)
    assert words == ("free", "seat", "enforce", "match-start", "coriolis", ())
    np.testing.assert_array_equal(found.r1, np.diag([2, 2, 2]))
    assert (found.lead_in, found.lead_out) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("section", "control", "ends"),
    [
        ("{r2: 1}", "scalar", "free"),
        ("{tracking: 1}", "scalar", "free"),
        ("{algorithm: report-sweep}", "scalar", "free"),
        ("{method: zero}", "per-joint", "free"),
        ("{method: zero, r2: 1}", "per-joint", "free"),
        ("{r2: 1, control: per-joint, ends: match-start}", "per-joint", "match-start"),
        ("{method: zero, control: scalar}", "scalar", "free"),
        ("{budget: 0.05}", "free", "match-start"),
        ("{budget: 0.05, control: scalar}", "scalar", "match-start"),
        ("{axes: report}", "free", "match-start"),
    ],
)
def test_the_problem_of_the_study_has_its_own_defaults(
    section: str, control: str, ends: str
) -> None:
    found = load(f"{SMALL}reduction: {section}\n").reduction
    assert (found.control, found.ends) == (control, ends)


def test_what_only_free_joints_can_do_reaches_the_model() -> None:
    section = """\
reduction: {objective: blend, optimise: [cab_start, seat_yaw], ends: match-rates,
  lead_in_ms: 2500, lead_out_min: 0.05}
"""
    found = load(SMALL + section).reduction
    assert (found.objective, found.ends) == ("blend", "match-rates")
    assert found.optimise == ("cab_start", "seat_yaw")
    assert (found.lead_in, found.lead_out) == (2.5, 3.0)


@pytest.mark.parametrize("name", ["cobra", "cobra_table3"])
def test_the_cobras_stay_the_problem_of_the_study(name: str) -> None:
    found = load_profile(name).reduction
    words = (found.method, found.algorithm, found.control, found.axes, found.ends, found.limits)
    assert words == ("minimum", "optimum", "scalar", "report", "free", "warn")
    assert found.budget == ()


def test_every_other_built_in_profile_leaves_its_reduction_to_the_defaults() -> None:
    others = [p.name for p in builtin_profiles() if not p.name.startswith("cobra")]
    assert len(others) > 5
    for name in others:
        found = load_profile(name).reduction
        # these two ask for more G than the machine makes, and say so
        lacking = name in ("g_rapid_onset", "g_flight")
        default = Reduction(allow_change=0.2 if lacking else None)
        for field in fields(Reduction):
            np.testing.assert_array_equal(getattr(found, field.name), getattr(default, field.name))
