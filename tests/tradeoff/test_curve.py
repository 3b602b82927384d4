"""Points that cannot be the best there is are named."""

from dataclasses import replace

from des_cli.tradeoff.curve import doubts
from tests.support.trade_points import POINT


def test_a_local_minimum_is_named() -> None:
    looser = replace(POINT, value=0.1, objective_reduction=0.45)
    joint = replace(POINT, control="per-joint", objective_reduction=0.4)
    assert doubts([POINT, replace(looser, objective_reduction=0.6)]) == []
    [budget] = doubts([looser, POINT])
    assert "scalar at joint_deviation_relative = 0.1 takes off less than" in budget
    [factors] = doubts([POINT, joint])
    assert factors.startswith("per-joint at joint_deviation_relative = 0.05 is worse than scalar")
    weighed = [replace(point, swept="r2", value=1.0) for point in (POINT, joint)]
    assert doubts(weighed) == []  # by the cost, which is equal
    assert len(doubts([weighed[0], replace(weighed[1], cost=0.11)])) == 1
    assert doubts([replace(POINT, status="unverified"), joint]) == []


def test_budgets_on_different_metrics_are_not_compared() -> None:
    other = replace(POINT, swept="seat_g_rms_error_g", value=0.1, objective_reduction=0.2)
    assert doubts([POINT, other]) == []
