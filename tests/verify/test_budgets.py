"""Every metric of a budget, by what is known of it, and the budgets that it is held against."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.model.machines import DES
from des_cli.model.metric import METRICS, PEAK_METRICS, Budget
from des_cli.model.motion import Record
from des_cli.model.profile import Reduction
from des_cli.model.solution import Solution
from des_cli.reduction.baseline import joint_deviation
from des_cli.reduction.fidelity import Deviation
from des_cli.reduction.problem import Problem
from des_cli.verify.budgets import (
    INTEGRALS,
    at_states,
    check_budgets,
    keeps_budgets,
    mean_square_one_minus_p,
    measure,
    spent_budgets,
)
from des_cli.verify.claim import Claim
from des_cli.verify.felt import Felt
from tests.reduction.conftest import make_wave
from tests.support.claims import claim_of, failed_of_factors, failing, values_of
from tests.support.free_case import RATE, Case, G, with_rates

WAVE = make_wave([[0.6, 0.1], [0.1, 0.3], [0.1, -0.2]])
CLAIM = claim_of(WAVE)
RATIO = "seat_angular_acceleration_rms_ratio"
PEAK = "seat_angular_acceleration_peak_ratio"
ATTITUDE = "attitude_error_max_deg"
ALL_BUT_FACTORS = sorted(set(METRICS) - {"mean_square_one_minus_p"})


def scaled(field: str, by: float) -> Felt:
    """What is asked for, with one of its vectors longer."""
    if field == "angle":
        attitudes = CLAIM.before.attitudes
        return replace(CLAIM.before, attitudes=replace(attitudes, angle=by * attitudes.angle))
    return replace(CLAIM.before, **{field: by * getattr(CLAIM.before, field)})


def off(field: str, vector: list[float]) -> Felt:
    """What is asked for, with one of its vectors off by the same everywhere."""
    return replace(CLAIM.before, **{field: getattr(CLAIM.before, field) + np.c_[vector]})


def turned(degrees: float, sample: int | None = None) -> Felt:
    """What is asked for, with the attitude turned about some axis."""
    vector = np.radians(degrees) * np.array([2.0, -3.0, 6.0]) / 7.0
    turn = np.zeros((len(WAVE.t), 3))
    turn[slice(None) if sample is None else sample] = vector
    return replace(CLAIM.before, attitudes=replace(CLAIM.before.attitudes, turn=turn))


def arm_alone(*accelerations: float) -> Claim:
    """The arm from rest, with an acceleration for each second: the seat turns with it."""
    rate = np.zeros((len(accelerations) + 1, 3))
    rate[1:, 0] = np.cumsum(accelerations)
    return claim_of(with_rates(np.arange(len(rate), dtype=float), np.zeros(3), rate))


@pytest.mark.parametrize(
    ("metric", "felt", "value"),
    [
        ("joint_deviation_relative", scaled("angle", 1.2), 0.2),
        ("joint_deviation_relative_squared", scaled("angle", 1.2), 0.04),
        (RATE, scaled("rate", 0.7), 0.3),
        ("seat_g_deviation_relative", scaled("g", 1.05), 0.05),
        (G, off("g", [0.02, -0.03, 0.06]), 0.07),
        ("seat_angular_acceleration_deviation_relative", scaled("turning", 0.9), 0.1),
        ("seat_angular_acceleration_rms_error_rad_s2", off("turning", [0.2, 0.3, -0.6]), 0.7),
        (RATIO, scaled("turning", 1.3), 1.3),
        (PEAK, scaled("turning", 0.8), 0.8),
        (ATTITUDE, turned(3.0), 3.0),
        (ATTITUDE, turned(90.0, 0), 90.0),
        (ATTITUDE, turned(180.0, -1), 180.0),
        (ATTITUDE, turned(0.0), 0.0),
    ],
)
def test_a_metric_of_a_change_that_is_known(metric: str, felt: Felt, value: float) -> None:
    assert measure(CLAIM, metric, felt) == pytest.approx(value, rel=1e-9, abs=1e-12)
    same = 1.0 if metric in (RATIO, PEAK) else 0.0
    assert measure(CLAIM, metric, CLAIM.before) == pytest.approx(same, abs=1e-12)


def test_half_a_turn_about_any_axis_is_half_a_turn() -> None:
    axes = np.random.default_rng(8).normal(size=(len(WAVE.t), 3))
    axes *= np.pi / np.linalg.norm(axes, axis=1)[:, None]
    attitudes = replace(CLAIM.before.attitudes, turn=axes)
    found = at_states(CLAIM, ATTITUDE, replace(CLAIM.before, attitudes=attitudes))
    np.testing.assert_allclose(found, 180.0, atol=1e-5)


@pytest.mark.parametrize("metric", [G, RATIO, "joint_deviation_relative"])
def test_what_is_no_peak_has_no_values_at_states(metric: str) -> None:
    with pytest.raises(ValueError, match="no largest value"):
        at_states(CLAIM, metric, CLAIM.before)


def test_every_metric_is_known_to_the_verification() -> None:
    assert set(INTEGRALS) | PEAK_METRICS | {"mean_square_one_minus_p"} == set(METRICS)
    assert not set(INTEGRALS) & PEAK_METRICS


def test_a_change_counts_by_the_time_that_it_lasts() -> None:
    # by 0.2 g at both sides of the interval from 0.25 to 1 s, of 2 s in all
    t = np.array([0.0, 0.25, 1.0, 2.0])
    motion = with_rates(t, np.zeros(3), np.full((4, 3), 0.1))
    claim = claim_of(motion)
    g = claim.before.g.copy()
    g[2, [1, 4]] += 0.2
    felt = replace(claim.before, g=g)
    assert measure(claim, G, felt) == pytest.approx(0.2 * np.sqrt(0.75 / 2.0))


@pytest.mark.parametrize(
    ("asked", "made", "ratio"), [(0.02, 0.06, 3.0), (0.001, 0.06, 6.0), (0.0, 0.005, 0.5)]
)
def test_ratios_of_sizes_are_to_what_is_felt_at_the_least(
    asked: float, made: float, ratio: float
) -> None:
    # the threshold is 0.01 rad/s^2
    claim, felt = arm_alone(asked, asked), arm_alone(-made, -made).before
    assert measure(claim, RATIO, felt) == pytest.approx(ratio)
    assert measure(claim, PEAK, felt) == pytest.approx(ratio)


def test_a_peak_is_compared_with_the_peak_wherever_it_was() -> None:
    claim, felt = arm_alone(0.3, -0.4, 0.0), arm_alone(0.0, 0.0, 1.0).before
    assert measure(claim, PEAK, felt) == pytest.approx(2.5)
    assert measure(claim, RATIO, felt) == pytest.approx(2.0)


def test_the_mean_square_of_the_factors_by_hand() -> None:
    # one minus p is 0, 0.5, 1 and 0 over steps of 0.25, 0.75 and 1 s
    t = np.array([0.0, 0.25, 1.0, 2.0])
    motion = with_rates(t, np.zeros(3), np.full((4, 3), 0.1))
    factors = np.array([[1.0], [1.5], [0.0], [1.0]])
    mean = (0.125 * 0.25 + 0.375 * (0.25 + 1.0) + 0.5 * 1.0) / 2.0
    claim = claim_of(motion, factors=factors)
    assert measure(claim, "mean_square_one_minus_p", claim.before) == pytest.approx(mean)
    # of three joints it is their mean
    joints = np.hstack([factors, np.ones((4, 2))])
    assert mean_square_one_minus_p(claim, joints) == pytest.approx(mean / 3.0)


def budgeted(metric: str, most: float) -> Claim:
    """A motion that is other than the one asked for, within a budget."""
    other = make_wave([[0.55, 0.1], [0.1, 0.25], [0.12, -0.2]])
    factors = np.full((len(WAVE.t), 1), 0.9)
    budget = (Budget(metric, most),)  # type: ignore[arg-type]
    return claim_of(other, requested=WAVE, factors=factors, budget=budget)


def spent(metric: str) -> float:
    claim = budgeted(metric, 1.0)
    return measure(claim, metric, claim.after)


@pytest.mark.parametrize("metric", METRICS)
def test_a_budget_is_kept_up_to_rounding(metric: str) -> None:
    value = spent(metric)
    assert value > 1e-3
    for excess, broken in ((-0.1, False), (5e-10, False), (2e-9, True), (0.5, True)):
        claim = budgeted(metric, value / (1.0 + excess))
        checks = check_budgets(claim)
        assert values_of(checks) == {f"budget.{metric}": pytest.approx(excess, abs=1e-12)}
        assert failing(checks) == ({f"budget.{metric}"} if broken else set())
        assert keeps_budgets(claim, claim.after) is not broken


def test_every_budget_is_to_be_kept() -> None:
    loose, tight = Budget(G, 9.0), Budget(RATE, 1e-6)
    for budget in ((loose, tight), (tight, loose)):
        claim = claim_of(budgeted(G, 1.0).modified, requested=WAVE, budget=budget)
        assert failing(check_budgets(claim)) == {f"budget.{RATE}"}
        assert not keeps_budgets(claim, claim.after)
        assert keeps_budgets(claim, claim.before)


@pytest.mark.parametrize("metric", ALL_BUT_FACTORS)
def test_a_change_from_the_record_has_bounds_of_its_own(metric: str) -> None:
    # the record is WAVE; what was reduced lies between it and the motion
    between = make_wave([[0.58, 0.1], [0.1, 0.28], [0.11, -0.2]])
    value = spent(metric)
    ratio = metric in (RATIO, PEAK)
    for excess, broken in ((5e-10, False), (2e-9, True)):
        most = (Budget(metric, value / (1.0 + excess)),)  # type: ignore[arg-type]
        claim = replace(budgeted(metric, 9e9), held=Record(between), most=most)
        checks = check_budgets(claim)
        keys = {f"budget.{metric}"} | (set() if ratio else {f"record.{metric}"})
        assert {check.key for check in checks} == keys
        assert failing(checks) == ({f"record.{metric}"} if broken and not ratio else set())


def test_budgets_hold_against_what_was_reduced() -> None:
    # the motion is what was reduced, but its record is another
    claim = budgeted(G, 0.01)
    assert failing(check_budgets(claim)) == {f"budget.{G}"}
    held = replace(claim, held=Record(claim.modified))
    assert values_of(check_budgets(held)) == {f"budget.{G}": pytest.approx(-1.0)}
    # nothing is said of the record where it is what was reduced
    same = replace(claim, held=Record(claim.requested), most=(Budget(G, 1e-9),))
    assert {check.key for check in check_budgets(same)} == {f"budget.{G}"}


def test_budgets_that_are_spent_may_hold_the_motion() -> None:
    for metric in METRICS:
        value = spent(metric)
        for share, found in ((0.94, False), (0.96, True), (1.0, True)):
            names = [each.metric for each in spent_budgets(budgeted(metric, value / share))]
            assert names == ([metric] if found and metric not in PEAK_METRICS else [])


@pytest.mark.parametrize(("jump", "torn"), [(0.9, False), (-0.9, False), (1.1, True), (-1.1, True)])
def test_less_is_spent_of_a_table_whose_positions_jump(jump: float, torn: bool) -> None:
    # the fork's positions gain 5 % of its fastest rate over one interval, beyond its rates
    fastest = np.max(np.abs(WAVE.rate_start[:, 1]))
    angle = WAVE.angle.copy()
    angle[12:, 1] += jump * 0.05 * fastest * WAVE.step[0]
    other = budgeted(G, 1.0).modified
    requested = replace(WAVE, angle=angle)
    one = claim_of(other, requested=requested, budget=(Budget(G, 1.0),))
    value = measure(one, G, one.after)
    for share, found in ((0.59, False), (0.61, torn), (0.96, True)):
        claim = claim_of(other, requested=requested, budget=(Budget(G, value / share),))
        assert bool(spent_budgets(claim)) is found


def test_less_is_spent_of_a_rough_record() -> None:
    draw = 0.02 * np.random.default_rng(3).normal(size=(len(WAVE.t), 3))
    rate = np.vstack([WAVE.rate_start, WAVE.rate_end[-1:]]) + draw
    requested = with_rates(WAVE.t, WAVE.angle[0], rate)
    one = claim_of(WAVE, requested=requested, budget=(Budget(G, 1.0),))
    assert one.rough
    value = measure(one, G, one.after)
    for share, found in ((0.59, False), (0.61, True)):
        claim = claim_of(WAVE, requested=requested, budget=(Budget(G, value / share),))
        assert bool(spent_budgets(claim)) is found


@pytest.mark.parametrize("metric", ALL_BUT_FACTORS)
def test_a_budget_that_an_optimum_overspends_by_little(case: Case, metric: str) -> None:
    chain = chain_of(DES, case.seat)
    measured = Deviation.between(
        case.requested, case.solution.modified, (chain, chain), DES.gravity
    ).value(metric)
    for share, broken in ((1.0 + 1e-7, False), (1.0 - 1e-7, True)):
        budget = (Budget(metric, share * measured),)  # type: ignore[arg-type]
        assert (f"budget.{metric}" in case.failed(budget=budget)) is broken


def test_budgets_are_on_the_motion_that_was_asked_for(case: Case) -> None:
    # the cab's rate steps in what was asked for, and not in the executable motion
    own = case.value(f"budget.{G}")
    assert own == pytest.approx(0.0, abs=1e-3)
    assert case.value(f"budget.{G}", requested=case.desired) != pytest.approx(own, abs=1e-4)


def test_a_budget_that_factors_overspend_by_little(
    solved: tuple[Problem, Solution],
) -> None:
    problem, solution = solved
    value = joint_deviation(problem.desired, solution.modified)
    metric = "joint_deviation_relative"
    for share, broken in ((1.0 + 1e-6, False), (1.0 - 1e-6, True)):
        wanted = Reduction(limits="warn", budget=(Budget(metric, value * share),))
        assert (f"budget.{metric}" in failed_of_factors(problem, solution, wanted)) is broken
