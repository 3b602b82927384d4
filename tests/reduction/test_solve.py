"""Which method answers which request, by what only that method does."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.response import respond
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.metric import FACTOR_DEVIATION, JOINT_DEVIATION, SEAT_RATE_DEVIATION, Budget
from des_cli.model.motion import DesiredMotion, Motion
from des_cli.model.profile import Reduction
from des_cli.model.solution import Iteration
from des_cli.reduction.fidelity import Deviation
from des_cli.reduction.limits import find_violations
from des_cli.reduction.problem import pose_problem
from des_cli.reduction.solve import executable_motion, find_motion, moves_freely, solve
from tests.support.claims import profile_of
from tests.support.free_motions import smooth

MOTION = smooth(40)
FACTORS = Reduction(control="per-joint", limits="warn", ends="free", budget=(), r2=np.full(3, 0.3))
BUDGETS = (Budget(JOINT_DEVIATION, 0.05),)


def desired_of(motion: Motion) -> DesiredMotion:
    n = len(motion.t)
    return DesiredMotion(motion, np.ones(n), np.zeros(n, dtype=bool), np.zeros((n, 3)))


def with_corner(motion: Motion, joint: int, rate: float) -> Motion:
    """The motion with a joint whose rate steps half-way: no machine does that."""
    n = len(motion.t) - 1
    sides = np.where(np.arange(n) < n // 2, -rate, rate)
    columns = [motion.angle.copy(), motion.rate_start.copy(), motion.rate_end.copy()]
    rise = np.append(0.0, np.cumsum(motion.step * sides))
    for column, values in zip(columns, (rise, sides, sides), strict=True):
        column[:, joint] = values
    return Motion(motion.t, *columns)


@pytest.mark.parametrize(
    ("asked", "freely"),
    [
        ({"control": "free"}, True),
        ({"control": "free", "budget": ()}, True),
        ({"control": "scalar"}, False),
        ({"control": "per-joint"}, True),
        ({"control": "per-joint", "budget": ()}, False),
        ({"control": "per-joint", "jacobian": "adapted"}, False),
        (
            {
                "control": "per-joint",
                "budget": (
                    Budget(SEAT_RATE_DEVIATION, 0.1),
                    Budget(FACTOR_DEVIATION, 0.1),
                ),
            },
            False,
        ),
    ],
)
def test_a_motion_per_joint_is_free_unless_factors_are_asked_for(
    asked: dict[str, Any], freely: bool
) -> None:
    assert moves_freely(Reduction(**asked)) is freely


@pytest.mark.parametrize("limits", ["check", "warn"])
def test_limits_that_are_not_enforced_change_no_motion(limits: str) -> None:
    broken = with_corner(MOTION, 2, 0.5)
    asked = profile_of(broken, replace(FACTORS, limits=limits))  # type: ignore[arg-type]
    assert executable_motion(asked, broken) == (broken, "")


def test_factors_act_on_a_motion_inside_the_limits_that_are_enforced() -> None:
    broken = with_corner(MOTION, 2, 0.1)
    assert find_violations(DES, broken, "desired")
    asked = profile_of(broken, replace(FACTORS, limits="enforce"))
    found, trouble = executable_motion(asked, broken)
    assert trouble == ""
    assert find_violations(DES, found, "desired") == ()


def test_weights_ask_for_the_optimum_of_the_problem_as_it_is() -> None:
    problem, told = pose_problem(profile_of(MOTION, FACTORS), MOTION), list[Iteration]()
    posed, solution = solve(problem, FACTORS, told.append)
    assert posed is problem
    assert solution.converged
    assert solution.log == tuple(told)
    assert solution.cost < solution.cost_unreduced


def test_a_sweep_is_none_of_newtons() -> None:
    problem = pose_problem(profile_of(MOTION, FACTORS), MOTION)
    asked = replace(FACTORS, algorithm="report-sweep", iterations=3)
    posed, solution = solve(problem, asked)
    assert posed is problem
    assert solution.iterations <= 3
    assert solution.cost >= solve(problem, FACTORS)[1].cost


def test_a_budget_is_spent_and_brings_weights_of_its_own() -> None:
    asked = replace(FACTORS, control="scalar", budget=BUDGETS)
    problem = pose_problem(profile_of(MOTION, asked), MOTION)
    posed, solution = solve(problem, asked)
    assert solution.usable
    np.testing.assert_array_equal(posed.tracking, 0.0)
    assert posed.r2[0] < 1e-3 * problem.r2[0]
    chains = (problem.chain, problem.chain)
    spent = Deviation.between(MOTION, solution.modified, chains, DES.gravity).value(JOINT_DEVIATION)
    assert spent == pytest.approx(0.05, rel=1e-2)


def test_the_zero_method_leaves_nothing_of_the_chosen_component() -> None:
    asked = replace(FACTORS, method="zero", r1=np.diag([0.0, 0.0, 1.0]), axes="report")
    problem = pose_problem(profile_of(MOTION, asked), MOTION)
    posed, solution = solve(problem, asked)
    assert solution.usable, solution.message
    np.testing.assert_array_equal(posed.r1, 0.0)
    before, after = (
        np.abs(respond(DES, Seat(), motion).coriolis_report[..., 2]).max()
        for motion in (MOTION, solution.modified)
    )
    assert before > 100.0 * asked.tolerance
    assert after <= asked.tolerance * (1.0 + 1e-9)


def test_the_limit_on_steps_is_that_of_the_request() -> None:
    problem = pose_problem(profile_of(MOTION, FACTORS), MOTION)
    _, solution = solve(problem, replace(FACTORS, max_iterations=1))
    assert solution.status == "iteration-limit"


def test_factors_of_a_whole_request() -> None:
    stages: list[str] = []
    asked, target = profile_of(MOTION, FACTORS), desired_of(MOTION)
    found = find_motion(asked, target, target, on_stage=stages.append)
    assert stages == ["motion inside the limits", "factors on the desired rates"]
    assert found.desired is MOTION
    assert found.posed is found.problem
    assert found.held == target.record
    assert found.solution.converged


def test_a_motion_that_the_limits_change_too_much_is_refused() -> None:
    """The cab's rate is to step by 1 rad/s, which no limit allows."""
    broken = with_corner(MOTION, 2, 0.5)
    asked = profile_of(broken, replace(FACTORS, limits="enforce"))
    target = desired_of(broken)
    refused = find_motion(asked, target, target)
    assert refused.solution.status == "changed"
    assert "--allow-change" in refused.solution.message
    np.testing.assert_array_equal(refused.solution.control, np.ones((41, 3)))
    assert refused.solution.modified is refused.desired
    # who allows it has budgets hold against what the limits made of it
    allowed = replace(asked, reduction=replace(asked.reduction, allow_change=0.9))
    found = find_motion(allowed, target, target)
    assert found.solution.usable
    assert found.held.motion is found.desired
    assert found.problem.reference is found.desired
    chain = chain_of(DES, asked.seat)
    change = Deviation.between(broken, found.desired, (chain, chain), DES.gravity)
    assert change.value(SEAT_RATE_DEVIATION) > 0.1


def test_smoothing_that_spends_the_budget_alone_is_refused() -> None:
    target = desired_of(smooth(40, amplitude=((0.6, 0.0, 0.15), (0.1, 0.3, 0.0), (-0.2, 0.1, 0.0))))
    asked = profile_of(
        MOTION, replace(FACTORS, control="scalar", budget=(Budget(SEAT_RATE_DEVIATION, 0.01),))
    )
    refused = find_motion(asked, desired_of(MOTION), target)
    assert refused.solution.status == "changed"
    assert "smoothing alone spends seat rate" in refused.solution.message
    assert refused.held == target.record
