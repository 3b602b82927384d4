"""Factors on the desired rates: dynamics, costs and zeros against the study's closed forms."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.model.profile import Reduction
from des_cli.model.solution import Solution
from des_cli.reduction.problem import Problem
from des_cli.verify.claim import Claim
from des_cli.verify.factors import (
    check_cost,
    check_dynamics,
    check_zero,
    cost_of,
    integrated,
    is_still,
)
from tests.reduction.conftest import (
    make_problem,
    make_uneven,
    make_wave,
    study_coriolis,
    study_cost,
    study_motion,
    study_rates,
)
from tests.support.claims import (
    checks_of_factors,
    claim_of,
    claim_of_factors,
    failed_of_factors,
    failing,
    remade,
    values_of,
)
from tests.support.free_case import with_rates

WEIGHTS = Reduction(limits="warn", budget=())
ENFORCE = Reduction(limits="enforce", budget=())
UNEVEN = make_uneven()


def failed(problem: Problem, solution: Solution, wanted: Reduction = WEIGHTS) -> list[str]:
    return failed_of_factors(problem, solution, wanted)


def changed(solution: Solution, name: str, index: Any, by: float) -> Solution:
    values = getattr(solution.modified, name).copy()
    values[index] += by
    return replace(solution, modified=replace(solution.modified, **{name: values}))


def test_a_true_solution_passes(solved: tuple[Problem, Solution]) -> None:
    checks = checks_of_factors(*solved, WEIGHTS)
    assert all(check.ok for check in checks)
    for names in ({check.name for check in checks}, {check.key for check in checks}):
        assert len(names) == len(checks)
    assert {"dynamics.angles", "dynamics.rates", "cost", "cost.rise", "optimality"} <= {
        check.key for check in checks
    }


def test_the_remade_solution_passes_too(solved: tuple[Problem, Solution]) -> None:
    problem, solution = solved
    assert failed(problem, remade(problem, solution, solution.control.copy())) == []


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_one_angle_off(solved: tuple[Problem, Solution], joint: int) -> None:
    problem, solution = solved
    keys = failed(problem, changed(solution, "angle", (77, joint), 1e-6))
    assert "dynamics.angles" in keys
    assert set(keys) <= {"dynamics.angles", "cost"}


@pytest.mark.parametrize("side", ["rate_start", "rate_end"])
def test_one_rate_off(solved: tuple[Problem, Solution], side: str) -> None:
    problem, solution = solved
    keys = failed(problem, changed(solution, side, (77, 1), 1e-6))
    assert "dynamics.rates" in keys
    assert set(keys) <= {"dynamics.angles", "dynamics.rates", "cost"}


def test_the_start_off(solved: tuple[Problem, Solution]) -> None:
    problem, solution = solved
    keys = failed(problem, changed(solution, "angle", (slice(None), 2), 1e-6))
    assert {"dynamics.angles", "start.angle"} <= set(keys)


def test_cost_off(solved: tuple[Problem, Solution]) -> None:
    problem, solution = solved
    assert failed(problem, replace(solution, cost=solution.cost * (1.0 + 1e-6))) == ["cost"]
    dearer = replace(solution, cost_unreduced=solution.cost_unreduced * (1.0 + 1e-6))
    assert failed(problem, dearer) == ["cost.unreduced"]


def test_a_cost_above_the_desired_motions(solved: tuple[Problem, Solution]) -> None:
    problem, solution = solved
    worse = remade(problem, solution, -np.ones_like(solution.control))
    assert worse.cost > worse.cost_unreduced
    assert "cost.rise" in failed(problem, worse)


def test_a_solution_inside_its_limits_passes(inside: tuple[Problem, Solution]) -> None:
    checks = checks_of_factors(*inside, ENFORCE)
    assert all(check.ok for check in checks)
    keys = {check.key for check in checks}
    for joint in ("arm", "fork", "cab"):
        assert {f"limits.{joint}.{quantity}" for quantity in ("acceleration", "jerk")} <= keys


CONTROLS = {"scalar": 1, "per-joint": 3}


def factors_of(count: int) -> Floats:
    """Factors on the uneven motion: of any size and sign."""
    return np.random.default_rng(2).normal(0.8, 0.5, size=(len(UNEVEN.t), count))


def moved(claim: Claim, name: str, index: Any, by: float) -> Claim:
    return replace(claim, solution=changed(claim.solution, name, index, by))


@pytest.mark.parametrize("control", CONTROLS)
def test_angles_are_integrated_as_the_study_does(control: str) -> None:
    problem, factors = make_problem(UNEVEN, control=control), factors_of(CONTROLS[control])
    wide = np.broadcast_to(factors, (len(factors), 3))
    start, end = wide[:-1] * UNEVEN.rate_start, wide[1:] * UNEVEN.rate_end
    expected = study_motion(problem, factors)[:, :3]
    found = integrated(problem, wide, start, end)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13)
    assert failing(check_dynamics(claim_of_factors(problem, factors), problem)) == set()


@pytest.mark.parametrize("joint", [0, 1, 2])
@pytest.mark.parametrize(
    ("name", "index", "key"),
    [
        ("angle", 0, "dynamics.angles"),
        ("angle", 4, "dynamics.angles"),
        ("angle", -1, "dynamics.angles"),
        ("rate_start", 0, "dynamics.rates"),
        ("rate_start", -1, "dynamics.rates"),
        ("rate_end", 0, "dynamics.rates"),
        ("rate_end", -1, "dynamics.rates"),
    ],
)
def test_dynamics_hold_to_a_hundred_millionth(name: str, index: int, key: str, joint: int) -> None:
    problem = make_problem(UNEVEN, control="per-joint")
    claim = claim_of_factors(problem, factors_of(3))
    for by, broken in ((8e-9, False), (-8e-9, False), (1.2e-8, True), (-1.2e-8, True)):
        checks = check_dynamics(moved(claim, name, (index, joint), by), problem)
        assert failing(checks) == ({key} if broken else set())


@pytest.mark.parametrize("fork", [-1.0, 0.4])
@pytest.mark.parametrize("control", CONTROLS)
def test_adapted_rates_are_those_of_the_inverse_by_hand(fork: float, control: str) -> None:
    wave = make_wave([[0.6, 0.1], [0.1, 0.05], [0.1, -0.2]])
    problem = make_problem(wave, control=control, jacobian="adapted")
    angle = wave.angle + np.array([0.7, fork - wave.angle[0, 1], -0.2])
    factors = np.random.default_rng(5).normal(0.8, 0.2, size=(len(wave.t), CONTROLS[control]))
    start, end = (
        study_rates(problem, angle[at], factors[at], at, rate)
        for at, rate in ((slice(None, -1), wave.rate_start), (slice(1, None), wave.rate_end))
    )
    motion = replace(wave, angle=angle, rate_start=start, rate_end=end)
    claim = claim_of(motion, requested=wave, factors=factors)
    assert values_of(check_dynamics(claim, problem))["dynamics.rates"] < 1e-12
    for name in ("rate_start", "rate_end"):
        for index in ((0, 0), (3, 1), (-1, 2)):
            checks = check_dynamics(moved(claim, name, index, -1.2e-8), problem)
            assert "dynamics.rates" in failing(checks)


@pytest.mark.parametrize(("cosine", "compared"), [(0.46, True), (0.44, False)])
def test_adapted_rates_are_compared_where_the_inverse_is_undamped(
    cosine: float, compared: bool
) -> None:
    # the determinant of the DES's J is the cosine of the fork's angle
    wave = make_wave([[0.6], [0.0], [0.1]])
    problem = make_problem(wave, control="per-joint", jacobian="adapted")
    for sign in (1.0, -1.0):
        angle = wave.angle.copy()
        angle[:, 1] = sign * np.arccos(cosine)
        claim = claim_of(replace(wave, angle=angle), requested=wave, factors=np.ones((25, 3)))
        assert (values_of(check_dynamics(claim, problem))["dynamics.rates"] > 0.01) is compared


@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize("axes", ["report", "seat"])
def test_costs_are_those_of_the_closed_forms(control: str, axes: str) -> None:
    r1 = np.array([[2.0, 0.3, 0.1], [0.3, 1.0, -0.2], [0.1, -0.2, 3.0]])
    for r2, tracking in ((0.0, 0.0), ((1.0, 2.0, 3.0), 0.0), (0.0, (1.0, 2.0, 3.0)), (1.0, 1.0)):
        problem = make_problem(UNEVEN, r2, control=control, axes=axes, r1=r1, tracking=tracking)
        factors = factors_of(CONTROLS[control])
        claim = claim_of_factors(problem, factors)
        expected = float(study_cost(problem, study_motion(problem, factors)))
        assert cost_of(claim, problem, factors, claim.after) == pytest.approx(expected, rel=1e-12)
        for by, failed_keys in (
            ((1.0, 1.0), set()),
            ((1.0 + 5e-10, 1.0 - 5e-10), set()),
            ((1.0 + 2e-9, 1.0), {"cost"}),
            ((1.0 - 2e-9, 1.0), {"cost"}),
            ((1.0, 1.0 + 2e-9), {"cost.unreduced"}),
            ((1.0, 1.0 - 2e-9), {"cost.unreduced"}),
        ):
            solution = claim.solution
            told = replace(
                solution,
                cost=by[0] * solution.cost,
                cost_unreduced=by[1] * solution.cost_unreduced,
            )
            checks = check_cost(replace(claim, solution=told), problem)
            assert failing(checks) - {"cost.rise"} == failed_keys


@pytest.mark.parametrize(
    ("options", "asked"),
    [
        ({}, True),
        ({"method": "zero"}, False),
        ({"algorithm": "report-sweep"}, False),
    ],
)
def test_an_optimum_costs_no_more_than_the_desired_motion(
    options: dict[str, Any], asked: bool
) -> None:
    problem = make_problem(UNEVEN, 1.0)
    claim = claim_of_factors(problem, np.ones((len(UNEVEN.t), 1)), **options)
    for rise, broken in ((-0.5, False), (5e-10, False), (2e-9, True), (0.5, True)):
        told = replace(claim.solution, cost=(1.0 + rise) * claim.solution.cost_unreduced)
        checks = check_cost(replace(claim, solution=told), problem)
        assert ("cost.rise" in failing(checks)) is (broken and asked)
        assert ("cost.rise" in values_of(checks)) is asked


def test_costs_of_nothing_are_relative_to_those_of_standing_still() -> None:
    # the arm alone has no cross-coupling; to stand still would cost 1.5 for each second, of 2
    motion = with_rates(np.linspace(0.0, 2.0, 5), np.zeros(3), np.outer(np.ones(5), [0.5, 0, 0]))
    problem = make_problem(motion, (1.0, 1.0, 1.0), control="per-joint", r1=(2, 2, 2))
    claim = claim_of_factors(problem, np.ones((5, 3)))
    least = 1e-6 * 1.0 * 2.0
    for share, broken in ((5e-10, False), (2e-9, True)):
        told = replace(claim.solution, cost=share * least, cost_unreduced=share * least)
        checks = check_cost(replace(claim, solution=told), problem)
        assert failing(checks) == ({"cost", "cost.unreduced"} if broken else set())
    told = replace(claim.solution, cost=2e-9 * least, cost_unreduced=0.0)
    values = values_of(check_cost(replace(claim, solution=told), problem))
    assert values["cost.rise"] == pytest.approx(2e-9)


@pytest.mark.parametrize("axes", ["report", "seat"])
@pytest.mark.parametrize("component", [0, 1, 2])
def test_what_is_to_vanish_is_the_largest_of_the_chosen_components(
    axes: str, component: int
) -> None:
    motion = make_wave([[0.6, 0.1], [0.1, 0.3], [0.1, -0.2]], intervals=12)
    middle = 0.5 * (motion.rate_start + motion.rate_end)
    # at the middle of an interval the parabola is above its chord by a step^2 / 8
    step = motion.step[:, None]
    between = 0.5 * (motion.angle[:-1] + motion.angle[1:]) - motion.acceleration * step**2 / 8.0
    states = (
        (motion.angle[:-1], motion.rate_start),
        (motion.angle[1:], motion.rate_end),
        (between, middle),
    )
    largest = max(
        float(np.max(np.abs(study_coriolis(angle.T, rate.T, axes)[component])))
        for angle, rate in states
    )
    r1 = np.zeros((3, 3))
    r1[component, component] = 0.5
    problem = make_problem(motion, axes=axes)
    for share, ok in ((1.0 - 1e-9, False), (1.0 + 1e-9, True)):
        claim = claim_of(motion, method="zero", r1=r1, tolerance=share * largest)
        check = check_zero(claim, problem)
        assert check.value == pytest.approx(largest, rel=1e-12)
        assert check.ok is ok


def test_what_vanishes_at_samples_alone_does_not_vanish() -> None:
    # all but the arm stand at the samples; between two of them the fork turns to and fro
    t = np.array([0.0, 1.0, 2.0])
    rate = np.outer(np.ones(3), [1.0, 0.0, 0.0])
    motion = with_rates(t, np.array([0.0, 0.3, 0.2]), rate)
    problem = make_problem(motion, axes="seat")
    assert check_zero(claim_of(motion), problem).ok
    start, end = motion.rate_start.copy(), motion.rate_end.copy()
    for values, by in ((start, 0.2), (end, 0.2)):
        values[1, 1] += by
    assert not check_zero(claim_of(replace(motion, rate_start=start, rate_end=end)), problem).ok
    # the rates cancel in the middle: at the sides they do not
    end[1, 1] = -0.2
    assert not check_zero(claim_of(replace(motion, rate_start=start, rate_end=end)), problem).ok


@pytest.mark.parametrize(("share", "still"), [(0.9, True), (1.1, False)])
@pytest.mark.parametrize("axes", ["seat", "report"])
def test_a_motion_is_still_by_the_mean_of_what_it_weighs(
    share: float, still: bool, axes: str
) -> None:
    """A billionth of a rad^2/s^4: twice the study's cost of factors of one, over the duration."""
    motion = make_wave([[0.3, 0.1], [0.1, 0.1], [0.1, -0.05]], intervals=100)
    problem = make_problem(motion, axes=axes, r1=(1.0, 2.0, 3.0))
    duration = motion.t[-1] - motion.t[0]
    assert abs(duration - 1.0) > 0.5
    ones = np.ones((101, 1))
    cost = float(study_cost(problem, study_motion(problem, ones)))
    problem = replace(problem, r1=problem.r1 * share * 1e-9 * duration / (2.0 * cost))
    assert is_still(claim_of_factors(problem, ones), problem) == still
