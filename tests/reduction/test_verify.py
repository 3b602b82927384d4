"""The verification passes what is right and names what is wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.reduction.report_sweep import sweep
from des_cli.reduction.verify import coriolis_by_complex_step, verify


@pytest.fixture(scope="module", params=["scalar", "per-joint"])
def solved(request, cobra, pose, solve_problem):
    problem = pose(cobra(250), 1.0, control=request.param, axes="seat", r1=(2, 2, 2), tracking=0.1)
    return problem, solve_problem(problem)


@pytest.fixture
def remade(closed_motion, closed_cost):
    """A solution of other factors, with its motion and cost made to fit."""

    def remake(problem, solution, control):
        x = closed_motion(problem, control)
        factor = np.broadcast_to(control, (len(control), 3))
        motion = replace(
            solution.modified,
            angle=x[:, :3],
            rate_start=factor[:-1] * problem.desired.rate_start,
            rate_end=factor[1:] * problem.desired.rate_end,
        )
        cost = float(closed_cost(problem, x))
        return replace(solution, control=control, modified=motion, cost=cost)

    return remake


def failed(problem, solution, **options):
    return [check.name for check in verify(problem, solution, **options) if not check.ok]


def changed(solution, name, index, by):
    values = getattr(solution.modified, name).copy()
    values[index] += by
    return replace(solution, modified=replace(solution.modified, **{name: values}))


def test_a_true_solution_passes(solved):
    checks = verify(*solved)
    assert all(check.ok for check in checks)
    assert len({check.name for check in checks}) == len(checks) >= 5
    assert any("optimum" in check.name for check in checks)


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
    names = failed(problem, changed(solution, "angle", (77, joint), 1e-6))
    assert len(names) == 1
    assert "angles" in names[0]


@pytest.mark.parametrize("side", ["rate_start", "rate_end"])
def test_one_rate_off(solved, side):
    problem, solution = solved
    names = failed(problem, changed(solution, side, (77, 1), 1e-6))
    assert len(names) == 1
    assert "rates" in names[0]


def test_the_start_off(solved):
    problem, solution = solved
    names = failed(problem, changed(solution, "angle", (slice(None), 2), 1e-6))
    assert any("angles" in name for name in names)


def test_cost_off(solved):
    problem, solution = solved
    names = failed(problem, replace(solution, cost=solution.cost * (1.0 + 1e-6)))
    assert len(names) == 1
    assert "error of the cost" in names[0]


def test_a_cost_above_the_desired_motions(solved, remade):
    problem, solution = solved
    worse = remade(problem, solution, -np.ones_like(solution.control))
    assert worse.cost > worse.cost_unreduced
    assert any("excess" in name for name in failed(problem, worse))


def test_factors_that_are_not_optimal(solved, remade):
    problem, solution = solved
    t = problem.desired.t[:, None]
    waved = solution.control + 1e-2 * np.cos(0.7 * t + np.arange(solution.control.shape[1]))
    names = failed(problem, remade(problem, solution, waved))
    assert len(names) == 1
    assert "slope" in names[0]


def test_optimality_is_asked_of_those_who_claim_it(cobra, pose):
    problem = pose(cobra(250), 1.0)
    solution = sweep(problem)
    assert failed(problem, solution, optimal=False) == []
    assert any("slope" in name for name in failed(problem, solution))


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
    names = failed(problem, broken)
    assert names
    assert "not finite" in names[0]


@pytest.mark.parametrize("axes", ["report", "seat"])
def test_coriolis_by_complex_step(uneven, pose, closed_coriolis, axes):
    rng = np.random.default_rng(21)
    angle, rate = rng.normal(size=(2, 4, 5, 3))
    found = coriolis_by_complex_step(pose(uneven, axes=axes), angle, rate)
    expected = np.stack(
        closed_coriolis(np.moveaxis(angle, -1, 0), np.moveaxis(rate, -1, 0), axes), axis=-1
    )
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-14)
