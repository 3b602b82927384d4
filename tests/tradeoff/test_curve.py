"""Points beside each other: which of them cannot be the best there is."""

from __future__ import annotations

from dataclasses import replace

import pytest

from des_cli.model.tradeoff import TradePoint
from des_cli.tradeoff.curve import doubts

POINT = TradePoint(
    "optimum",
    "scalar",
    "joint_deviation_relative",
    0.05,
    "converged",
    objective_reduction=0.5,
    cost=0.1,
)
LOOSER = replace(POINT, value=0.1, objective_reduction=0.45)
JOINT = replace(POINT, control="per-joint", objective_reduction=0.4)


@pytest.mark.parametrize("reverse", [False, True])
def test_a_budget_that_buys_less_than_a_smaller_one_is_named_in_any_order(reverse: bool) -> None:
    points = [replace(LOOSER, value=0.2, objective_reduction=0.6), LOOSER, POINT]
    (found,) = doubts(points[::-1] if reverse else points)
    assert found == (
        "scalar at joint_deviation_relative = 0.1 takes off less than "
        "scalar at joint_deviation_relative = 0.05: a local minimum, not the best there is"
    )
    assert doubts([POINT, replace(LOOSER, objective_reduction=0.6)]) == []


def test_more_factors_that_buy_less_than_one_are_named() -> None:
    (found,) = doubts([POINT, JOINT])
    assert found == (
        "per-joint at joint_deviation_relative = 0.05 is worse than "
        "scalar at joint_deviation_relative = 0.05: a local minimum"
    )
    assert doubts([POINT, replace(JOINT, objective_reduction=0.6)]) == []
    assert doubts([POINT, replace(JOINT, value=0.01)]) == []  # there is no such scalar
    assert doubts([JOINT]) == []


def test_weights_are_compared_by_their_cost_and_not_with_each_other() -> None:
    scalar, joint = (replace(point, swept="r2", value=1.0) for point in (POINT, JOINT))
    assert doubts([scalar, joint]) == []
    (found,) = doubts([scalar, replace(joint, cost=0.11)])
    assert found.startswith("per-joint at r2 = 1 is worse than scalar at r2 = 1")
    assert doubts([scalar, replace(scalar, value=2.0, objective_reduction=0.1)]) == []


def test_a_little_less_than_the_solver_can_tell_is_no_doubt() -> None:
    assert doubts([POINT, replace(LOOSER, objective_reduction=0.4991)]) == []
    assert len(doubts([POINT, replace(LOOSER, objective_reduction=0.4989)])) == 1
    assert doubts([POINT, replace(JOINT, objective_reduction=0.4991)]) == []


@pytest.mark.parametrize(
    "unusable",
    [
        replace(LOOSER, status="unverified"),
        replace(LOOSER, objective_reduction=None),
        replace(LOOSER, algorithm="constant-p"),
        replace(JOINT, status="iteration-limit"),
    ],
)
def test_points_without_a_solution_are_not_compared(unusable: TradePoint) -> None:
    assert doubts([POINT, unusable]) == []


def test_budgets_on_different_metrics_are_not_compared() -> None:
    other = replace(POINT, swept="seat_g_rms_error_g", value=0.1, objective_reduction=0.2)
    assert doubts([POINT, other]) == []
