"""A point of the trade-off: what may be used of it, and which question it answers."""

import pickle
from dataclasses import replace

import pytest

from des_cli.model.metric import ANGULAR_ACCELERATION_PEAK_RATIO, JOINT_DEVIATION, SEAT_G_ERROR
from des_cli.model.tradeoff import TradePoint

POINT = TradePoint("optimum", "free", SEAT_G_ERROR, 0.05, "converged", seat_g_rms_error_g=0.04)


def test_a_metric_is_known_where_its_column_is() -> None:
    assert POINT.fidelity(SEAT_G_ERROR) == 0.04
    assert POINT.fidelity(JOINT_DEVIATION) is None
    assert POINT.fidelity(ANGULAR_ACCELERATION_PEAK_RATIO) is None  # no column


@pytest.mark.parametrize(
    ("status", "solved", "answered"),
    [
        ("converged", True, True),
        ("acceptable", True, True),
        ("infeasible", False, True),
        ("iteration-limit", False, False),
        ("unverified", False, False),
        ("failed", False, False),
    ],
)
def test_an_answer_is_a_solution_or_that_there_is_none(
    status: str, solved: bool, answered: bool
) -> None:
    point = replace(POINT, status=status)
    assert (point.solved, point.answered) == (solved, answered)


def test_a_baseline_is_no_optimum() -> None:
    assert not replace(POINT, algorithm="report-sweep").solved
    assert not replace(POINT, algorithm="constant-p", status="baseline").answered


def test_a_point_crosses_process_boundaries() -> None:
    assert pickle.loads(pickle.dumps(POINT)) == POINT
