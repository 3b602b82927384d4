"""Which trial points a filter lets pass, by hand-made points."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.solver.filter import ARMIJO, Filter, Trial

FLAT = 0.0
"""A slope of the cost that promises nothing, so that violation and cost are weighed alike."""


@pytest.mark.parametrize(
    ("trial", "accepted"),
    [
        (Trial(0.5, 4.0), True),
        (Trial(0.5, 6.0), True),  # better in one is enough
        (Trial(2.0, 4.0), True),
        (Trial(2.0, 6.0), False),
        (Trial(1.0, 5.0), False),  # no better in either
        (Trial(1.0 - 1e-6, 5.0), False),  # by less than the margin
        (Trial(1.0, 5.0 - 1e-6), False),
        (Trial(1.0 - 2e-5, 5.0), True),
        (Trial(1.0, 5.0 - 2e-5), True),
    ],
)
def test_a_trial_must_be_better_in_cost_or_violation(trial: Trial, accepted: bool) -> None:
    assert Filter(1.0, 1.0).accepts(Trial(1.0, 5.0), trial, 1.0, FLAT) is accepted


def test_where_nothing_is_violated_nothing_can_be_gained_but_in_cost() -> None:
    here = Trial(0.0, 5.0)
    assert Filter(1.0, 1.0).accepts(here, Trial(0.0, 4.9), 1.0, FLAT)
    assert not Filter(1.0, 1.0).accepts(here, Trial(0.0, 5.1), 1.0, FLAT)


def test_a_trial_must_not_be_worse_in_both_than_what_was_left_before() -> None:
    kept = Filter(1.0, 1.0)
    assert kept.accepts(Trial(1.0, 5.0), Trial(0.1, 8.0), 1.0, FLAT)
    back = Trial(1.1, 5.1)  # cheaper than the present point, and worse than the first
    assert not kept.accepts(Trial(0.1, 8.0), back, 1.0, FLAT)
    kept.clear()
    assert kept.accepts(Trial(0.1, 8.0), back, 1.0, FLAT)


def test_what_is_refused_is_not_remembered() -> None:
    kept = Filter(1.0, 1.0)
    assert not kept.accepts(Trial(1.0, 5.0), Trial(2.0, 6.0), 1.0, FLAT)
    # worse in both than the point from which the trial was refused
    assert kept.accepts(Trial(3.0, 9.0), Trial(1.5, 7.0), 1.0, FLAT)


@pytest.mark.parametrize("cost", [np.nan, np.inf, -np.inf])
def test_a_cost_that_is_no_number_is_refused(cost: float) -> None:
    assert not Filter(1.0, 1.0).accepts(Trial(1.0, 5.0), Trial(0.0, cost), 1.0, FLAT)


@pytest.mark.parametrize(("first", "worst"), [(0.0, 1e4), (0.3, 1e4), (7.0, 7e4)])
def test_no_trial_violates_ten_thousand_times_what_the_start_did(
    first: float, worst: float
) -> None:
    for share, accepted in ((0.999, True), (1.001, False)):
        trial = Trial(share * worst, 0.0)
        assert Filter(first, 1.0).accepts(Trial(1.0, 5.0), trial, 1.0, FLAT) is accepted


def test_where_all_but_nothing_is_violated_a_step_must_bring_what_its_slope_promises() -> None:
    current, slope, length = Trial(1e-6, 5.0), -2.0, 0.5
    least = ARMIJO * length * 2.0
    for share, accepted in ((1.01, True), (0.99, False)):
        trial = Trial(0.0, 5.0 - share * least)  # the fallen violation counts for nothing
        assert Filter(1.0, 1.0).accepts(current, trial, length, slope) is accepted
    # far from the constraints the same trial passes for its violation
    trial = Trial(0.0, 5.0 - 0.99 * least)
    assert Filter(1.0, 1.0).accepts(Trial(1e-2, 5.0), trial, length, slope)
    # and near them where the slope promises less than the violation is worth
    assert Filter(1.0, 1.0).accepts(current, trial, length, -1e-4)


def test_a_step_that_goes_by_its_slope_leaves_nothing_behind() -> None:
    kept, current = Filter(1.0, 1.0), Trial(1e-6, 5.0)
    assert kept.accepts(current, Trial(1e-6, 4.0), 1.0, -2.0)
    # worse in both than that point, which would stand against it
    assert kept.accepts(Trial(1.0, 8.0), Trial(1e-3, 6.0), 1.0, FLAT)


@pytest.mark.parametrize("slope", [FLAT, -1e-7])
def test_rounding_of_the_cost_decides_nothing(slope: float) -> None:
    current = Trial(1e-16, 1e6)
    for cost, accepted in ((np.nextafter(1e6, np.inf), True), (1e6 + 1e-3, False)):
        trial = Trial(1e-16, float(cost))
        assert Filter(1.0, 1.0).accepts(current, trial, 1.0, slope) is accepted


def test_the_switch_to_the_slope_does_not_depend_on_the_unit_of_the_cost() -> None:
    rng = np.random.default_rng(2)
    found = set()
    for _ in range(200):
        slope, fall = -(10.0 ** rng.uniform(-4, 1)), 10.0 ** rng.uniform(-7, -3)
        current = Trial(10.0 ** rng.uniform(-8, -4), 5.0)
        both = [
            Filter(1.0, unit).accepts(
                Trial(current.violation, unit * current.cost),
                Trial(0.0, unit * (current.cost - fall)),
                1.0,
                unit * slope,
            )
            for unit in (1.0, 1024.0)
        ]
        assert both[0] is both[1]
        found.add(both[0])
    assert found == {True, False}
