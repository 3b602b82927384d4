"""What is said and handed over where a search for a free motion ended."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.model.arrays import Floats
from des_cli.model.machine import OccupantBounds, Seat
from des_cli.model.machines import DES
from des_cli.model.metric import (
    ATTITUDE_ERROR,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
    MetricKey,
)
from des_cli.model.motion import Motion
from des_cli.model.solution import Iteration
from des_cli.reduction.executable import sample_spline
from des_cli.reduction.fidelity import Deviation
from des_cli.reduction.free.answers import Answers, StepLog
from des_cli.reduction.free.task import FreeTask
from des_cli.solver.barrier import BoundaryStatus, Outcome, Step
from des_cli.solver.feasible_program import Values
from tests.support.free_motions import fit, program_of, smooth, task_of

DESIRED = smooth(40)
MODIFIED = smooth(40, amplitude=((0.6, 0.0, 0.12), (0.1, 0.2, 0.0), (-0.2, 0.1, 0.2)))
BUDGETS = {SEAT_G_ERROR: 0.1, SEAT_RATE_DEVIATION: 0.2}


def outcome_of(status: BoundaryStatus, gap: float, optimality: float) -> Outcome:
    values = Values(0.0, np.zeros(0), np.zeros(0))
    return Outcome(status, np.zeros(0), values, np.zeros(0), gap, optimality, (), np.zeros(0))


def answers_of(task: FreeTask, steps: int = 0, limit: int = 50) -> Answers:
    """The answers of a task after so many steps."""
    log = StepLog(limit, None)
    for number in range(steps):
        log(Step(number, 1.0, 0.1, 0.01, 1.0))
    return Answers(task, log)


def test_a_log_numbers_the_steps_of_all_searches_on_and_tells_them() -> None:
    told: list[Iteration] = []
    log = StepLog(3, told.append)
    for number, cost in ((0, 5.0), (1, 4.0), (0, 3.0), (1, 2.0)):
        log(Step(number, cost, 0.3, 0.2, 0.5))
    assert log.lines == told
    assert told[2] == Iteration(2, 3.0, 0.0, 0.2, 0.5)
    assert [line.number for line in told] == [0, 1, 2, 3]
    assert log.left == 0
    assert StepLog(3, None).left == 3


@pytest.mark.parametrize(
    ("outcome", "status", "words"),
    [
        (outcome_of("converged", 1e-9, 2e-7), "converged", "first-order optimal to 2.0e-07"),
        (outcome_of("iteration-limit", 1e-4, 2e-3), "acceptable", "not quite optimal"),
        (outcome_of("stalled", 9e-5, 2e-3), "acceptable", "off by 2.0e-03, the gap is 9.0e-05"),
        (outcome_of("iteration-limit", 2e-4, 2e-3), "iteration-limit", "raise max_iterations (50)"),
        (outcome_of("stalled", 2e-4, 2e-3), "diverged", "no step makes it better"),
    ],
)
def test_where_a_search_ended_is_told(outcome: Outcome, status: str, words: str) -> None:
    answers = answers_of(task_of(DESIRED, BUDGETS), steps=7)
    found = answers.found(outcome, MODIFIED, DESIRED, Seat(0.3, 0.1))
    assert found.solution.status == status
    assert words in found.solution.message
    assert "7 steps" in found.solution.message
    assert found.solution.optimality == outcome.optimality
    assert found.solution.iterations == len(found.solution.log) == 7
    assert (found.desired, found.solution.modified) == (DESIRED, MODIFIED)
    assert found.seat == Seat(0.3, 0.1)
    assert [budget.metric for budget in found.budgets] == list(BUDGETS)


@pytest.mark.parametrize(
    ("axes", "r1"),
    [("seat", 2.0 * np.eye(3)), ("seat", np.diag([0.0, 2.0, 0.5])), ("report", np.diag([0, 2, 0]))],
    ids=["all", "some of the seat's", "one of the study's"],
)
def test_costs_are_those_of_the_tables(
    axes: Any, r1: Floats, closed_coriolis: Callable[..., list[Any]]
) -> None:
    """1/2 int c' R1 c dt of the motion, and of the record instead of the reference."""
    record = smooth(40, amplitude=((0.5, 0.1), (0.1, 0.2), (0.1, 0.1)))
    task = task_of(record, BUDGETS, axes=axes, r1=r1).around(DESIRED)
    found = answers_of(task).found(outcome_of("converged", 0.0, 0.0), MODIFIED, DESIRED, Seat())

    def cost(motion: Motion) -> float:
        c = np.array(closed_coriolis(motion.angle.T, motion.rate.T, axes))
        return 0.5 * float(np.trapezoid(np.einsum("it,ij,jt->t", c, r1, c), motion.t))

    assert found.solution.cost == pytest.approx(cost(MODIFIED), rel=1e-9)
    assert found.solution.cost_unreduced == pytest.approx(cost(record), rel=1e-9)
    assert found.held.motion is DESIRED


def test_a_motion_per_joint_has_factors_and_a_free_one_none() -> None:
    factor = np.stack([np.linspace(a, 1.0, 41) for a in (0.5, 2.0, -1.0)], axis=1)
    rate = DESIRED.rate.copy()
    rate[10:20, 1] = 0.0
    desired = Motion(DESIRED.t, DESIRED.angle, rate[:-1], rate[1:])
    made = factor * rate
    modified = Motion(DESIRED.t, DESIRED.angle, made[:-1], made[1:])
    end = outcome_of("converged", 0.0, 0.0)
    free = answers_of(task_of(DESIRED, BUDGETS)).found(end, modified, desired, Seat())
    assert free.solution.control.shape == free.solution.adjoint.shape == (41, 0)
    tied = answers_of(task_of(DESIRED, BUDGETS, control="per-joint"))
    found = tied.found(end, modified, desired, Seat()).solution.control
    factor[10:20, 1] = 1.0  # nothing is multiplied there
    np.testing.assert_allclose(found, factor, rtol=1e-12)


def test_a_motion_without_cross_coupling_is_passed_through() -> None:
    answers = answers_of(task_of(DESIRED, BUDGETS, control="per-joint", seat=Seat(0.2, 0.1)))
    found = answers.passed_through(DESIRED)
    assert found.solution.converged
    assert found.solution.modified is found.desired is DESIRED
    assert found.seat == Seat(0.2, 0.1)
    assert (found.solution.optimality, found.solution.iterations) == (0.0, 0)
    assert found.solution.cost == found.solution.cost_unreduced
    np.testing.assert_allclose(found.solution.control, 1.0, rtol=1e-14)


@pytest.mark.parametrize(("control", "columns"), [("free", 0), ("per-joint", 3)])
def test_a_refusal_says_why_and_keeps_what_was_tried(control: str, columns: int) -> None:
    task = task_of(DESIRED, BUDGETS, control=control)
    found = answers_of(task, steps=2).refused(MODIFIED, "it cannot be")
    solution = found.solution
    assert (solution.status, solution.message) == ("infeasible", "it cannot be")
    assert found.desired is solution.modified is MODIFIED
    np.testing.assert_array_equal(solution.control, np.ones((41, columns)))
    assert solution.adjoint.shape == (41, 0)
    assert np.isnan([solution.cost, solution.cost_unreduced, solution.optimality]).all()
    assert len(solution.log) == 2
    assert answers_of(task).refused(MODIFIED, "", "changed").solution.status == "changed"


@pytest.mark.parametrize(
    ("spent", "beyond", "words"),
    [
        ({SEAT_G_ERROR: 1.03, SEAT_RATE_DEVIATION: 1.0}, 0.0, "exceeds G error by 3 %;"),
        (
            {SEAT_G_ERROR: 1.03, SEAT_RATE_DEVIATION: 1.5},
            0.0,
            "exceeds G error by 3 % and seat rate by 50 %;",
        ),
        ({SEAT_G_ERROR: 0.9}, 0.02, "exceeds a bound on what the occupant gets by 2 %;"),
        ({SEAT_G_ERROR: 0.9}, 0.0, "exceeds them barely;"),
    ],
)
def test_what_a_table_does_not_keep_is_named(
    spent: Mapping[MetricKey, float], beyond: float, words: str
) -> None:
    told = answers_of(task_of(DESIRED, BUDGETS)).unkept(spent, beyond)
    assert told.startswith("no table with a step of 0.1 s was found within the budgets")
    assert words in told
    assert told.endswith("sample the profile finer, or allow more")


def unreachable(task: FreeTask) -> str:
    return answers_of(task).unreachable(program_of(task), fit(task, 20))


@pytest.mark.parametrize("limits", ["enforce", "warn"])
def test_budgets_that_the_start_exceeds_are_named_with_what_can_be_done(limits: str) -> None:
    """The spline's own miss is beyond the second of the budgets' integrals."""
    budget = {ATTITUDE_ERROR: 10.0, SEAT_G_ERROR: 0.5, SEAT_RATE_DEVIATION: 1e-9}
    desired = smooth(400)
    task = task_of(desired, budget, limits=limits)
    told = unreachable(task)
    named = re.search(r"seat rate (\S+) instead of 1e-09", told)
    assert named
    chains = 2 * (chain_of(DES, Seat()),)
    table = sample_spline(fit(task, 20), desired.t)
    missed = Deviation.between(desired, table, chains, DES.gravity).value(SEAT_RATE_DEVIATION)
    assert 0.5 < float(named[1]) / missed < 2.0  # it sways between the points that tell it
    assert "G error" not in told
    assert "attitude" not in told
    if limits == "enforce":
        assert told.startswith("conditioning and the machine's limits alone cost more")
        assert "--allow-change 0.01 " in told  # in whole percents
    else:
        assert told.startswith("no smooth motion comes nearer")


def test_bounds_that_no_motion_within_the_budgets_keeps_are_named() -> None:
    machine = replace(DES, occupant=OccupantBounds(gz=(-np.inf, 0.5)))
    told = unreachable(task_of(DESIRED, BUDGETS, machine))
    assert told.startswith("desired seat Gz ")
    assert "exceeds the bound 0.5 g" in told
    assert told.endswith("no motion within the budgets was found that keeps it")
    told = unreachable(task_of(DESIRED, BUDGETS))  # nothing that the table would tell
    assert told.startswith("a budget is exceeded: no motion")
