"""Factors on the desired rates: optima pass, and what is not optimal does not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.model.machine import JointLimits, Machine
from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion
from des_cli.model.profile import Reduction
from des_cli.model.solution import Solution
from des_cli.reduction.problem import Problem
from des_cli.reduction.solve import solve
from des_cli.reduction.study_law import sweep
from des_cli.verify.budgets import measure
from des_cli.verify.factors_optimality import _now_or_later, check_optimality
from tests.reduction.conftest import make_problem, make_wave
from tests.support.claims import claim_of_factors, failed_of_factors, remade
from tests.support.free_case import with_rates

Make: TypeAlias = Callable[..., Motion]
Pose: TypeAlias = Callable[..., Problem]
Solve: TypeAlias = Callable[..., Solution]

WEIGHTS = Reduction(limits="warn", budget=())
ENFORCE = Reduction(limits="enforce", budget=())
WAVE = make_wave([[0.6, 0.1], [0.1, 0.3], [0.1, -0.2]])
NONE = JointLimits(np.inf, np.inf, np.inf, np.inf)


def failed(problem: Problem, solution: Solution, wanted: Reduction = WEIGHTS) -> list[str]:
    return failed_of_factors(problem, solution, wanted)


def slope_of(problem: Problem, control: Floats, budget: tuple[Budget, ...] = ()) -> float:
    """The slope that is left at factors, relative."""
    claim = claim_of_factors(problem, control, budget=budget)
    return check_optimality(claim, problem).value


def test_optima_in_report_axes_and_with_small_weights_pass(
    cobra: Make, pose: Pose, solve_problem: Solve
) -> None:
    for problem in (
        pose(cobra(250), 0.2),
        pose(cobra(250, table3=True), 1.0, control="per-joint"),
        pose(cobra(250), (0.3, 1.0, 2.0), control="per-joint", axes="seat", r1=(1, 2, 3)),
    ):
        assert failed(problem, solve_problem(problem)) == []


def test_factors_that_are_not_optimal(solved: tuple[Problem, Solution]) -> None:
    problem, solution = solved
    t = problem.desired.t[:, None]
    waved = solution.control + 1e-2 * np.cos(0.7 * t + np.arange(solution.control.shape[1]))
    assert failed(problem, remade(problem, solution, waved)) == ["optimality"]


def test_optimality_is_asked_of_those_who_claim_it(cobra: Make, pose: Pose) -> None:
    problem = pose(cobra(250), 1.0)
    solution = sweep(problem)
    law = Reduction(algorithm="report-sweep", limits="warn", budget=())
    assert failed(problem, solution, law) == []
    assert "optimality" in failed(problem, solution)


def test_factors_that_are_not_optimal_inside_the_limits(inside: tuple[Problem, Solution]) -> None:
    problem, solution = inside
    # Half-way back to the desired motion: inside the limits, which are convex.
    assert failed(problem, remade(problem, solution, 0.5 * (1.0 + solution.control)), ENFORCE) == [
        "optimality"
    ]


@pytest.mark.parametrize("control", ["scalar", "per-joint"])
@pytest.mark.parametrize("ends", ["match-start", "match-both"])
def test_optimality_between_fixed_ends(
    cobra: Make, pose: Pose, solve_problem: Solve, control: str, ends: str
) -> None:
    problem = pose(cobra(250), 1.0, control=control, axes="seat", ends=ends)
    solution = solve_problem(problem)
    assert failed(problem, solution) == []
    # Half-way back: it keeps the ends, as the desired motion does.
    half = remade(problem, solution, 0.5 * (1.0 + solution.control))
    assert failed(problem, half) == ["optimality"]


def test_a_joint_that_is_held_is_asked_for_nothing(
    cobra: Make, pose: Pose, solve_problem: Solve
) -> None:
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
def test_optimality_within_a_budget(cobra: Make, pose: Pose, metric: str, budget: float) -> None:
    wanted = replace(WEIGHTS, control="scalar", budget=(Budget(metric, budget),))
    posed, solution = solve(pose(cobra(250), 1.0, axes="seat", r1=(2, 2, 2)), wanted)
    assert solution.converged
    assert failed(posed, solution, wanted) == []
    # Nearer to the desired motion: inside the budget, and not the best that it buys.
    for share in (0.99, 0.5):
        nearer = remade(posed, solution, 1.0 + share * (solution.control - 1.0))
        assert failed(posed, nearer, wanted) == ["optimality"]


@pytest.mark.parametrize(("left", "broken"), [(5e-6, False), (2e-5, True)])
def test_a_slope_of_a_hundred_thousandth_is_left(
    solved: tuple[Problem, Solution], left: float, broken: bool
) -> None:
    problem, solution = solved
    t = problem.desired.t[:, None]
    wave = np.cos(0.7 * t + np.arange(solution.control.shape[1]))
    size = 1e-3
    size *= left / slope_of(problem, solution.control + size * wave)
    control = solution.control + size * wave
    assert slope_of(problem, control) == pytest.approx(left, rel=0.1)
    found = failed(problem, remade(problem, solution, control))
    assert found == (["optimality"] if broken else [])


@pytest.fixture(scope="module")
def optimum(cobra: Make, pose: Pose, solve_problem: Solve) -> tuple[Problem, Solution]:
    """Factors for each joint."""
    problem = pose(cobra(250), 1.0, control="per-joint", axes="seat", r1=(2, 2, 2))
    return problem, solve_problem(problem)


@pytest.mark.parametrize("at", [0.0, 0.2, 0.5, 0.9, 1.0])
@pytest.mark.parametrize("joint", [0, 1, 2])
def test_a_change_of_one_joint_somewhere_is_seen(
    optimum: tuple[Problem, Solution], at: float, joint: int
) -> None:
    problem, solution = optimum
    x = np.linspace(0.0, 1.0, len(solution.control))
    control = solution.control.copy()
    control[:, joint] += 1e-2 * np.exp(-(((x - at) / 0.03) ** 2))
    assert slope_of(problem, control) > 1e-4


METRICS = (
    "joint_deviation_relative",
    "mean_square_one_minus_p",
    "seat_rate_deviation_relative",
    "seat_g_rms_error_g",
    "seat_angular_acceleration_rms_error_rad_s2",
)


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5])
@pytest.mark.parametrize("control", [1, 3])
def test_budgets_that_are_all_spent_make_no_optimum_of_any_motion(count: int, control: int) -> None:
    problem = make_problem(
        WAVE, 1e-3, control="scalar" if control == 1 else "per-joint", axes="seat", r1=(2, 2, 2)
    )
    t = WAVE.t[:, None]
    factors = 0.9 + 0.05 * np.cos(1.3 * t + np.arange(control))
    claim = claim_of_factors(problem, factors)
    budget = tuple(
        Budget(metric, measure(claim, metric, claim.after))  # type: ignore[arg-type]
        for metric in METRICS[:count]
    )
    assert slope_of(problem, factors, budget) > 1e-3


def test_a_budget_that_is_better_spent_less_makes_no_optimum() -> None:
    # without a weight on the cross-coupling the cost and the budget are the same
    problem = make_problem(WAVE, 1.0, axes="seat", r1=(0, 0, 0))
    factors = 0.9 + 0.05 * np.cos(WAVE.t[:, None])
    spent = claim_of_factors(problem, factors)
    most = measure(spent, "mean_square_one_minus_p", spent.after)
    assert slope_of(problem, factors, (Budget("mean_square_one_minus_p", most),)) > 0.1


def straight(rate: float, acceleration: float = 0.0, jerk: float = 0.0) -> Motion:
    """A motion of all joints by powers of the time, over two seconds."""
    t = np.linspace(0.0, 2.0, 41)
    values = rate + acceleration * t + 0.5 * jerk * t**2
    return with_rates(t, np.zeros(3), np.tile(values[:, None], (1, 3)))


def bounded(**bounds: float) -> Machine:
    """A machine whose joints have the same limits."""
    limit = replace(NONE, **bounds)
    return replace(DES, limits=(limit, limit, limit))


@pytest.mark.parametrize("control", ["scalar", "per-joint"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(
    ("motion", "quantity", "peak"),
    [
        (straight(0.5), "rate", 0.5),
        (straight(0.2, 0.3), "acceleration", 0.3),
        (straight(0.2, 0.0, 0.4), "jerk", 0.4),
        (straight(0.5), "angle", 1.0),  # at the end, on which every factor before acts
    ],
    ids=["rate", "acceleration", "jerk", "angle"],
)
def test_factors_that_a_limit_holds_are_not_moved(
    motion: Motion, quantity: str, peak: float, sign: float, control: str
) -> None:
    motion = replace(
        motion,
        angle=sign * motion.angle,
        rate_start=sign * motion.rate_start,
        rate_end=sign * motion.rate_end,
    )
    for share, held in ((1.0 - 5e-4, True), (1.0 - 2e-3, False)):
        machine = bounded(**{quantity: peak / share})
        problem = make_problem(
            motion, 1e-2, control=control, axes="seat", r1=(2, 2, 2), machine=machine
        )
        slope = slope_of(problem, np.ones((41, 1 if control == "scalar" else 3)))
        assert (slope == 0.0) if held else (slope > 0.1)


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_a_limit_of_one_joint_holds_its_factor_alone(joint: int) -> None:
    # all weight is on the factors; of one joint it is off, and only there a limit may hold it
    motion = straight(0.5)
    factors = np.ones((41, 3))
    factors[:, joint] = 0.8
    for tight in range(3):
        limits = [NONE, NONE, NONE]
        limits[tight] = replace(NONE, rate=0.4 if tight == joint else 0.5)
        machine = replace(DES, limits=(limits[0], limits[1], limits[2]))
        problem = make_problem(
            motion, 1.0, control="per-joint", axes="seat", r1=(0, 0, 0), machine=machine
        )
        slope = slope_of(problem, factors)
        assert (slope == 0.0) if tight == joint else (slope > 1.0)
        # a scalar is held by the limits of any joint
        scalar = make_problem(motion, 1.0, axes="seat", r1=(0, 0, 0), machine=machine)
        assert (slope_of(scalar, np.full((41, 1), 0.8)) == 0.0) is (tight == joint)


@pytest.mark.parametrize(("first", "held"), [(0.0, True), (-1.0, False)])
def test_an_angle_at_its_limit_holds_what_comes_before_it(first: float, held: bool) -> None:
    # from 0 to 1, or from -1 to 0
    motion = straight(0.5)
    motion = replace(motion, angle=motion.angle + first)
    machine = bounded(angle=1.0 + 1e-4)
    problem = make_problem(motion, 1e-2, axes="seat", r1=(2, 2, 2), machine=machine)
    assert (slope_of(problem, np.ones((41, 1))) == 0.0) is held


def test_what_comes_before_is_each_sample_up_to_the_last_that_is_tight() -> None:
    tight = np.array([[0, 1, 0, 0, 0], [0, 0, 0, 0, 0], [1, 0, 0, 1, 0]], dtype=bool).T
    before = np.array([[1, 1, 0, 0, 0], [0, 0, 0, 0, 0], [1, 1, 1, 1, 0]], dtype=bool).T
    np.testing.assert_array_equal(_now_or_later(tight), before)


@pytest.mark.parametrize(("share", "held"), [(1.0 - 5e-4, True), (1.0 - 2e-3, False)])
def test_an_attitude_at_its_bound_holds_what_comes_before_it(share: float, held: bool) -> None:
    motion = straight(0.5)
    problem = make_problem(motion, 1e-2, axes="seat", r1=(2, 2, 2))
    factors = np.full((41, 1), 0.9)
    claim = claim_of_factors(problem, factors)
    off = measure(claim, "attitude_error_max_deg", claim.after)
    budget = (Budget("attitude_error_max_deg", off / share),)
    assert (slope_of(problem, factors, budget) == 0.0) is held


@pytest.mark.parametrize(
    ("ends", "first", "last"),
    [("free", True, True), ("match-start", False, True), ("match-both", False, False)],
)
def test_factors_at_the_ends_move_where_these_are_free(ends: str, first: bool, last: bool) -> None:
    # all weight is on the factors: the slope is that of the one which is off
    for at, seen in ((0, first), (-1, last), (20, True)):
        problem = make_problem(
            straight(0.5), 1.0, control="per-joint", axes="seat", r1=(0, 0, 0), ends=ends
        )
        factors = np.ones((41, 3))
        factors[at] = 0.5
        assert (slope_of(problem, factors) > 1e-3) is seen


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_the_factor_of_a_held_joint_is_not_moved(joint: int) -> None:
    held = np.arange(3) == joint
    problem = make_problem(
        straight(0.5), 1.0, control="per-joint", axes="seat", r1=(0, 0, 0), held=held
    )
    for off in range(3):
        factors = np.ones((41, 3))
        factors[:, off] = 0.8
        assert (slope_of(problem, factors) == 0.0) is (off == joint)


@pytest.mark.slow
def test_a_long_table_has_fewer_directions_and_enough_of_them() -> None:
    long = make_wave([[0.6, 0.1], [0.1, 0.3], [0.1, -0.2]], intervals=10_001)
    problem = make_problem(long, 1e-3, axes="seat", r1=(2, 2, 2))
    factors = 0.9 + 0.05 * np.cos(1.3 * long.t[:, None])
    claim = claim_of_factors(problem, factors)
    metric = "mean_square_one_minus_p"
    budget = (Budget(metric, measure(claim, metric, claim.after)),)
    assert slope_of(problem, factors, budget) > 1e-3


def test_a_joint_that_stands_still_between_fixed_ends_moves_no_other() -> None:
    """No factor of its own moves it, so that there is nothing to take back."""
    motion = straight(0.5)
    rate = motion.rate_start * [1.0, 1.0, 0.0]
    still = replace(motion, angle=motion.angle * [1.0, 1.0, 0.0], rate_start=rate, rate_end=rate)
    problem = make_problem(
        still, 1.0, control="per-joint", axes="seat", r1=(2, 2, 2), ends="match-both"
    )
    assert np.isfinite(slope_of(problem, np.ones((41, 3))))
