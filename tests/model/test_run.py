"""A run is released or refused with a sentence for each thing that stands against it."""

from __future__ import annotations

from dataclasses import replace
from typing import get_args

import pytest

from des_cli.errors import NotReleasedError
from des_cli.model.profile import LimitsPolicy
from des_cli.model.run import JointQuantity, Run, SeatQuantity, Violation
from tests.support.runs import make_run

FELT = Violation("modified", "seat", "Gy", 2.1, 1.0, 3.0, 4.5)
JERK = Violation("modified", "cab", "jerk", 12.0, 10.0, 5.0, 5.0)


def run_with(limits: LimitsPolicy, *violations: Violation) -> Run:
    run = make_run(3)
    reduction = replace(run.profile.reduction, limits=limits)
    return replace(run, profile=replace(run.profile, reduction=reduction), violations=violations)


def test_a_sentence_names_value_bound_and_time() -> None:
    assert str(FELT) == "modified seat Gy 2.1 g exceeds the bound 1 g from t = 3 to 4.5 s"
    assert str(JERK) == "modified cab jerk 12 rad/s^3 exceeds the limit 10 rad/s^3 at t = 5 s"
    low = Violation("desired", "seat", "Gz", -1.25, -1.0, 0.0, 0.5)
    assert str(low) == "desired seat Gz -1.25 g is below the bound -1 g from t = 0 to 0.5 s"


def test_every_quantity_has_a_unit() -> None:
    for quantity in (*get_args(JointQuantity), *get_args(SeatQuantity)):
        assert " 2 " in str(Violation("modified", "arm", quantity, 2.0, 1.0, 0.0, 0.0))


@pytest.mark.parametrize("limits", ["check", "enforce"])
def test_bounds_for_the_occupant_and_jerk_refuse_like_any_limit(limits: LimitsPolicy) -> None:
    with pytest.raises(NotReleasedError) as caught:
        run_with(limits, FELT, JERK).require_release()
    assert [problem.what for problem in caught.value.complaints] == [str(FELT), str(JERK)]


def test_a_warning_and_the_desired_motion_refuse_nothing() -> None:
    run_with("warn", FELT, JERK).require_release()
    run_with("enforce", Violation("desired", "seat", "Gy", 2.1, 1.0, 3.0, 4.5)).require_release()
