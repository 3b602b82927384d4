"""Factors on the desired rates: the verification passes what is right and names what is wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.profile import Reduction
from des_cli.reduction.solve import solve
from des_cli.reduction.study_law import sweep
from tests.support.claims import checks_of_factors, failed_of_factors

WEIGHTS = Reduction(limits="warn", budget=())


def failed(problem, solution, wanted=WEIGHTS):
    return failed_of_factors(problem, solution, wanted)


def changed(solution, name, index, by):
    values = getattr(solution.modified, name).copy()
    values[index] += by
    return replace(solution, modified=replace(solution.modified, **{name: values}))


def test_a_true_solution_passes(solved):
    checks = checks_of_factors(*solved, WEIGHTS)
    assert all(check.ok for check in checks)
    for names in ({check.name for check in checks}, {check.key for check in checks}):
        assert len(names) == len(checks)
    assert {"dynamics.angles", "dynamics.rates", "cost", "cost.rise", "optimality"} <= {
        check.key for check in checks
    }


def test_the_remade_solution_passes_too(solved, remade):
    problem, solution = solved
    assert failed(problem, remade(problem, solution, solution.control.copy())) == []


def test_report_axes_and_small_weights(cobra, pose, solve_problem):
    for problem in (
        pose(cobra(250), 0.2),
        pose(cobra(250, table3=True), 1.0, control="per-joint"),
        pose(cobra(250), (0.3, 1.0, 2.0), control="per-joint", axes="seat", r1=(1, 2, 3)),
    ):
        assert failed(problem, solve_problem(problem)) == []


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_one_angle_off(solved, joint):
    problem, solution = solved
    keys = failed(problem, changed(solution, "angle", (77, joint), 1e-6))
    assert "dynamics.angles" in keys
    assert set(keys) <= {"dynamics.angles", "cost"}


@pytest.mark.parametrize("side", ["rate_start", "rate_end"])
def test_one_rate_off(solved, side):
    problem, solution = solved
    keys = failed(problem, changed(solution, side, (77, 1), 1e-6))
    assert "dynamics.rates" in keys
    assert set(keys) <= {"dynamics.angles", "dynamics.rates", "cost"}


def test_the_start_off(solved):
    problem, solution = solved
    keys = failed(problem, changed(solution, "angle", (slice(None), 2), 1e-6))
    assert {"dynamics.angles", "start.angle"} <= set(keys)


def test_cost_off(solved):
    problem, solution = solved
    assert failed(problem, replace(solution, cost=solution.cost * (1.0 + 1e-6))) == ["cost"]
    dearer = replace(solution, cost_unreduced=solution.cost_unreduced * (1.0 + 1e-6))
    assert failed(problem, dearer) == ["cost.unreduced"]


def test_a_cost_above_the_desired_motions(solved, remade):
    problem, solution = solved
    worse = remade(problem, solution, -np.ones_like(solution.control))
    assert worse.cost > worse.cost_unreduced
    assert "cost.rise" in failed(problem, worse)


def test_factors_that_are_not_optimal(solved, remade):
    problem, solution = solved
    t = problem.desired.t[:, None]
    waved = solution.control + 1e-2 * np.cos(0.7 * t + np.arange(solution.control.shape[1]))
    assert failed(problem, remade(problem, solution, waved)) == ["optimality"]


def test_optimality_is_asked_of_those_who_claim_it(cobra, pose):
    problem = pose(cobra(250), 1.0)
    solution = sweep(problem)
    law = Reduction(algorithm="report-sweep", limits="warn", budget=())
    assert failed(problem, solution, law) == []
    assert "optimality" in failed(problem, solution)


ENFORCE = Reduction(limits="enforce", budget=())


def test_a_solution_inside_its_limits_passes(inside):
    checks = checks_of_factors(*inside, ENFORCE)
    assert all(check.ok for check in checks)
    keys = {check.key for check in checks}
    for joint in ("arm", "fork", "cab"):
        assert {f"limits.{joint}.{quantity}" for quantity in ("acceleration", "jerk")} <= keys


def test_factors_that_are_not_optimal_inside_the_limits(inside, remade):
    problem, solution = inside
    # Half-way back to the desired motion: inside the limits, which are convex.
    assert failed(problem, remade(problem, solution, 0.5 * (1.0 + solution.control)), ENFORCE) == [
        "optimality"
    ]


@pytest.mark.parametrize("control", ["scalar", "per-joint"])
@pytest.mark.parametrize("ends", ["match-start", "match-both"])
def test_optimality_between_fixed_ends(cobra, pose, solve_problem, remade, control, ends):
    problem = pose(cobra(250), 1.0, control=control, axes="seat", ends=ends)
    solution = solve_problem(problem)
    assert failed(problem, solution) == []
    # Half-way back: it keeps the ends, as the desired motion does.
    half = remade(problem, solution, 0.5 * (1.0 + solution.control))
    assert failed(problem, half) == ["optimality"]


def test_a_joint_that_is_held_is_asked_for_nothing(cobra, pose, solve_problem):
    held = np.array([True, False, False])
    problem = pose(cobra(250), 1.0, control="per-joint", axes="seat", held=held)
    assert failed(problem, solve_problem(problem)) == []


@pytest.mark.parametrize(
    ("metric", "budget"),
    [
        ("joint_deviation_relative", 0.05),
        ("mean_square_one_minus_p", 0.01),
        ("attitude_error_max_deg", 5.0),
    ],
)
def test_optimality_within_a_budget(cobra, pose, remade, metric, budget):
    wanted = replace(WEIGHTS, control="scalar", budget=(Budget(metric, budget),))
    posed, solution = solve(pose(cobra(250), 1.0, axes="seat", r1=(2, 2, 2)), wanted)
    assert solution.converged
    assert failed(posed, solution, wanted) == []
    # Nearer to the desired motion: inside the budget, and not the best that it buys.
    for share in (0.99, 0.5):
        nearer = remade(posed, solution, 1.0 + share * (solution.control - 1.0))
        assert failed(posed, nearer, wanted) == ["optimality"]


def test_a_limit_that_is_broken_by_little(inside, remade):
    problem, solution = inside
    # The solver keeps a millionth clear of the limits itself.
    gentler = DES.limits[0].acceleration * (1.0 - 1e-5)
    limits = (replace(DES.limits[0], acceleration=gentler), *DES.limits[1:])
    keys = failed(replace(problem, machine=replace(DES, limits=limits)), solution, ENFORCE)
    assert "limits.arm.acceleration" in keys
    assert set(keys) <= {"limits.arm.acceleration", "optimality"}


@pytest.mark.parametrize("value", [np.nan, np.inf])
@pytest.mark.parametrize("field", ["angle", "rate_start", "rate_end", "control"])
def test_numbers_that_are_none(solved, field, value):
    problem, solution = solved
    if field == "control":
        control = solution.control.copy()
        control[12] = value
        broken = replace(solution, control=control)
    else:
        broken = changed(solution, field, (12, 0), value)
    assert failed(problem, broken) == ["finite"]
