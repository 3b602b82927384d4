"""Which checks a solution goes through, by what it claims to be."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.model.machine import OccupantBounds
from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion, Record
from des_cli.model.profile import Reduction
from des_cli.model.solution import Solution
from des_cli.reduction.problem import Problem
from des_cli.verify.claim import Claim
from des_cli.verify.verify import verify
from tests.reduction.conftest import make_problem, make_wave
from tests.support.claims import claim_of, claim_of_factors, failed_of_factors, failing, values_of
from tests.support.free_case import RATE, Case, G

WAVE = make_wave([[0.3, 0.1], [0.1, 0.1], [0.1, -0.05]], intervals=100)
OTHER = make_wave([[0.29, 0.1], [0.1, 0.09], [0.1, -0.05]], intervals=100)
LIMITS = [
    f"limits.{joint}.{quantity}"
    for joint in ("arm", "fork", "cab")
    for quantity in ("angle", "rate", "acceleration", "jerk", "rate_step")
    if (joint, quantity) != ("arm", "angle")  # it turns endlessly
]
STOPPING = [
    f"stopping.{joint}.{end}" for joint in ("arm", "fork", "cab") for end in ("start", "end")
]
BEFORE = ["finite", "samples.times"]
BUDGETS = (Budget(G, 0.2), Budget(RATE, 0.3))
BOUNDED = replace(
    DES, occupant=OccupantBounds((-9, 9), (-9, 9), (-9, 9), g_onset=9, angular_acceleration=9)
)
OCCUPANT = [f"occupant.{name}" for name in ("gx", "gy", "gz", "onset", "angular_acceleration")]


def keys_of(claim: Claim) -> list[str]:
    checks = verify(claim)
    assert len({check.key for check in checks}) == len(checks)
    assert len({check.name for check in checks}) == len(checks)
    return [check.key for check in checks]


def free(**options: Any) -> Claim:
    return claim_of(OTHER, requested=WAVE, **{"budget": BUDGETS, **options})


def test_a_free_motion_goes_through_its_checks_in_order() -> None:
    assert keys_of(free()) == [
        *BEFORE,
        "solution",
        *LIMITS,
        *STOPPING,
        "start.angle",
        "start.rate",
        "dynamics.angles",
        f"budget.{G}",
        f"budget.{RATE}",
        "cost",
        "cost.unreduced",
        "objective.rise",
        "optimality",
    ]


@pytest.mark.parametrize(
    ("options", "further"),
    [
        ({"machine": BOUNDED}, OCCUPANT),
        ({"hold": {"cab"}}, ["hold", "hold.rate"]),
        ({"ends": "match-both"}, ["ends.rate", "ends.angle"]),
        ({"factors": np.ones((101, 3))}, ["dynamics.rates"]),
        (
            {"further": {"commands": replace(OTHER)}},
            ["leads.length", "leads.rest", "leads.maneuver"],
        ),
        (
            {"further": {"held": Record(replace(WAVE)), "most": BUDGETS}},
            [f"record.{G}", f"record.{RATE}"],
        ),
    ],
    ids=["occupant", "hold", "ends", "factors", "leads", "record"],
)
def test_what_more_is_claimed_is_checked_too(options: dict[str, Any], further: list[str]) -> None:
    found, plain = keys_of(free(**options)), keys_of(free())
    assert sorted(found) == sorted([*plain, *further])


def test_without_limits_neither_joints_nor_occupant_are_bounded() -> None:
    found = keys_of(free(machine=BOUNDED, limits="warn"))
    assert found == [key for key in keys_of(free()) if key not in LIMITS + STOPPING]


DYNAMICS = ["start.angle", "start.rate", "dynamics.angles", "dynamics.rates"]
COSTS = ["cost", "cost.unreduced"]


@pytest.mark.parametrize(
    ("options", "posed", "own"),
    [
        ({}, {}, [*DYNAMICS, *COSTS, "cost.rise", f"budget.{RATE}", "optimality"]),
        (
            {},
            {"jacobian": "adapted"},
            [*DYNAMICS, *COSTS, "cost.rise", f"budget.{RATE}"],
        ),
        ({"method": "zero"}, {}, [*DYNAMICS, *COSTS, "zero"]),
        (
            {"algorithm": "report-sweep"},
            {},
            [key for key in [*DYNAMICS, *COSTS] if key != "start.rate"],
        ),
    ],
    ids=["optimum", "adapted", "zero", "sweep"],
)
def test_factors_go_through_the_checks_of_their_method(
    options: dict[str, Any], posed: dict[str, Any], own: list[str]
) -> None:
    problem = make_problem(WAVE, 1.0, **posed)
    budget = (Budget(RATE, 0.3),)
    claim = claim_of_factors(problem, np.full((101, 1), 0.99), budget=budget, **options)
    assert keys_of(claim) == [*BEFORE, "solution", *own]


def test_a_spent_budget_on_factors_is_refused() -> None:
    problem = make_problem(WAVE, 1.0)
    claim = claim_of_factors(problem, np.full((101, 1), 0.5), budget=(Budget(RATE, 0.3),))
    assert f"budget.{RATE}" in failing(verify(claim))


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize(
    "name",
    [
        "t",
        "angle",
        "rate_start",
        "rate_end",
        "control",
        "adjoint",
        "cost",
        "cost_unreduced",
        "optimality",
    ],
)
def test_one_number_that_is_none_ends_the_checks(name: str, value: float) -> None:
    claim = free(factors=np.ones((101, 3)))
    solution = replace(claim.solution, adjoint=np.ones((101, 3)))
    if name.startswith(("cost", "optimality")):
        broken = replace(solution, **{name: value})
    elif name in ("control", "adjoint"):
        values = getattr(solution, name).copy()
        values[7, 1] = value
        broken = replace(solution, **{name: values})
    else:
        values = getattr(OTHER, name).copy()
        values[7 if name == "t" else (7, 1)] = value
        broken = replace(solution, modified=replace(OTHER, **{name: values}))
    # a table of its own, so that it is counted once
    checks = verify(replace(claim, solution=broken, commands=OTHER))
    assert values_of(checks) == {"finite": 1.0}
    assert failing(checks) == {"finite"}


@pytest.mark.parametrize(
    ("change", "wrong"),
    [
        ({}, 0),
        ({"status": "acceptable"}, 0),
        ({"optimality": 1e-9}, 0),
        ({"status": "diverged"}, 1),
        ({"optimality": -1e-9}, 1),
        ({"iterations": 1}, 1),
        ({"iterations": -1, "status": "iteration-limit", "optimality": -1.0}, 3),
    ],
)
def test_how_a_method_ended_cannot_be_anything(change: dict[str, Any], wrong: int) -> None:
    claim = free()
    checks = verify(replace(claim, solution=replace(claim.solution, **change)))
    assert values_of(checks)["solution"] == wrong
    assert ("solution" in failing(checks)) == (wrong > 0)


@pytest.mark.parametrize("name", ["t", "angle", "rate_start", "rate_end"])
def test_numbers_of_the_table_are_counted_too(name: str) -> None:
    values = getattr(OTHER, name).copy()
    values[:2] = np.nan
    table = replace(OTHER, **{name: values})
    checks = verify(free(further={"commands": table}))
    assert values_of(checks) == {"finite": 2.0 if name == "t" else 6.0}
    assert failing(checks) == {"finite"}


def test_other_sample_times_end_the_checks() -> None:
    later = replace(OTHER, t=OTHER.t + 1.0)
    checks = verify(claim_of(later, requested=WAVE))
    assert [check.key for check in checks] == BEFORE
    assert failing(checks) == {"samples.times"}


def test_an_optimum_passes_every_check(case: Case) -> None:
    checks = case.checks()
    assert [check.key for check in checks] == keys_of(free())
    assert failing(checks) == set()


def test_what_was_reduced_is_what_must_be_optimal(case: Case) -> None:
    # of another record the same motion is no optimum; round what was reduced it still is
    other = Motion(
        case.requested.t,
        case.requested.angle * 0.99,
        case.requested.rate_start * 0.99,
        case.requested.rate_end * 0.99,
    )
    claim = Claim(case.profile, other, case.desired, case.seat, case.solution)
    held = replace(claim, held=Record(case.requested))
    assert "optimality" not in failing(verify(held))
    assert "optimality" in failing(verify(claim))


@pytest.mark.parametrize("value", [np.nan, np.inf])
@pytest.mark.parametrize("field", ["angle", "control"])
def test_numbers_of_factors_that_are_none(
    solved: tuple[Problem, Solution], field: str, value: float
) -> None:
    problem, solution = solved
    holder = solution if field == "control" else solution.modified
    values = getattr(holder, field).copy()
    values[12, 0] = value
    if field == "control":
        broken = replace(solution, control=values)
    else:
        broken = replace(solution, modified=replace(solution.modified, angle=values))
    assert failed_of_factors(problem, broken, Reduction(limits="warn", budget=())) == ["finite"]
