"""Points of a sweep against numbers found elsewhere, and what a point says of its run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.model.machine import JOINTS
from des_cli.model.metric import Budget
from des_cli.model.run import Check
from des_cli.model.tradeoff import TradePoint
from des_cli.results.reading import read_metrics
from des_cli.tradeoff.baselines import CONSTANT_FACTORS
from des_cli.tradeoff.point import COSTS, PARTS, mean_weight, trade_point
from tests.support.points import Rows, column, curve
from tests.support.runs import make_run


def test_weights_give_the_known_optima(by_weight: Rows) -> None:
    # Three independent codes on this profile: reductions 29.5, 68.9 and 84.9 %,
    # J 0.4484, 0.25906 and 0.1391; per joint J 0.2144 and 74.5 % at r2 = 1.
    scalar = curve(by_weight, "optimum")
    assert column(scalar, "value") == [8.0, 1.0, 0.2]
    assert column(scalar, "bb3_reduction") == pytest.approx([0.295, 0.689, 0.849], abs=1e-3)
    assert column(scalar, "cost") == pytest.approx([0.4484, 0.25906, 0.1391], rel=1e-3)
    assert column(scalar, "objective_reduction") == column(scalar, "bb3_reduction")
    per_joint = curve(by_weight, "optimum", "per-joint")[1]
    assert float(per_joint["cost"]) == pytest.approx(0.2144, rel=1e-3)
    assert float(per_joint["bb3_reduction"]) == pytest.approx(0.745, abs=1e-3)
    assert {row["swept"] for row in scalar} == {"r2"}
    assert {row["status"] for row in scalar} == {"converged"}


def test_every_point_has_the_felt_price(by_weight: Rows) -> None:
    # An independent study (CasADi, 4-point Gauss) has 0.462 and 0.539 before any reduction;
    # the grid of 0.05 s holds the acceleration over each interval.
    stem = "seat_angular_acceleration"
    before = {"rms": 0.462, "peak": 0.539}
    for kind, size in before.items():
        sizes = column(by_weight, f"{stem}_{kind}_before_rad_s2")
        assert sizes == pytest.approx([size] * len(by_weight), abs=3e-3)
    slowed = curve(by_weight, "constant-p")
    # Slowed by p everywhere, c falls with p squared and the rest with p: the whole lies between.
    for row, p in zip(slowed, CONSTANT_FACTORS, strict=True):
        assert p**2 < float(row[f"{stem}_rms_rad_s2"]) / 0.462 < 1.0
        off = float(row[f"{stem}_rms_error_rad_s2"])
        assert off >= 0.462 - float(row[f"{stem}_rms_rad_s2"]) - 2e-3  # the triangle's inequality
    errors = column(slowed, f"{stem}_rms_error_rad_s2")
    assert errors == sorted(errors)


def test_budgets_are_kept_and_spent_inside_the_limits(by_budget: Rows) -> None:
    for control in ("scalar", "per-joint"):
        points = curve(by_budget, "optimum", control)
        assert column(points, "value") == [0.02, 0.05]
        for point in points:
            share = float(point["joint_deviation_relative"]) / float(point["value"])
            assert 0.9 < share <= 1.0 + 1e-9
            assert point["limits_ok"] == "true"
            assert point["swept"] == "joint_deviation_relative"


def test_more_deviation_and_more_factors_buy_more(by_budget: Rows) -> None:
    scalar, joint = (
        column(curve(by_budget, "optimum", control), "objective_reduction")
        for control in ("scalar", "per-joint")
    )
    assert scalar[0] < scalar[1]
    assert joint[0] < joint[1]
    assert all(more > less for more, less in zip(joint, scalar, strict=True))


@pytest.fixture
def told(
    monkeypatch: pytest.MonkeyPatch,
) -> Callable[..., TradePoint]:
    """The point of a run of closed forms, changed as is said."""

    def of(reduction: dict[str, Any] | None = None, **changes: Any) -> TradePoint:
        run = make_run()
        solution = replace(run.solution, **changes.pop("solution", {}))
        made = replace(run, solution=solution, **changes)
        profile = replace(
            made.profile, reduction=replace(made.profile.reduction, **(reduction or {}))
        )
        monkeypatch.setattr("des_cli.tradeoff.point.reduce_profile", lambda *_, **__: made)
        return trade_point(profile)

    return of


def test_a_point_is_named_after_its_first_budget_or_its_weight(told: Any) -> None:
    budgets = (Budget("seat_g_rms_error_g", 0.1), Budget("joint_deviation_relative", 0.05))
    found = told({"budget": budgets})
    assert (found.swept, found.value) == ("seat_g_rms_error_g", 0.1)
    found = told({"budget": (), "r2": np.array([1.0, 2.0, 6.0])})
    assert (found.swept, found.value, found.control) == ("r2", 3.0, "scalar")


def test_a_point_has_the_numbers_of_the_metrics(told: Any) -> None:
    found = told()
    metrics = make_run().metrics
    for part in PARTS:
        assert getattr(found, f"{part}_reduction") == metrics["coriolis"][part]["reduction"]
    assert found.objective_reduction == metrics["coriolis"]["objective"]["reduction"]
    assert {key: found.fidelity(key) for key in COSTS} == {
        key: metrics["fidelity"][key] for key in COSTS
    }
    turning = metrics["felt"]["seat_angular_acceleration"]["magnitude"]
    stem = "seat_angular_acceleration"
    for kind in ("rms", "peak"):
        assert getattr(found, f"{stem}_{kind}_before_rad_s2") == turning[f"{kind}_before_rad_s2"]
        assert getattr(found, f"{stem}_{kind}_rad_s2") == turning[f"{kind}_after_rad_s2"]
    assert (found.status, found.cost, found.iterations) == ("converged", 0.2590558, 6)


def test_one_joint_beyond_its_limits_is_enough(told: Any) -> None:
    metrics = make_run().metrics
    for beyond in (None, *JOINTS):
        for joint, load in metrics["limits"]["modified"].items():
            load["ok"] = joint != beyond
        assert told(results=read_metrics(metrics)).limits_ok is (beyond is None)


def test_a_failed_check_makes_it_unverified_with_its_words(told: Any) -> None:
    checks = (
        Check("a", "the optimality", 0.5, 1.0),
        Check("b", "the tracking error", 0.02, 0.001),
        Check("c", "the cab's jerk", float("nan"), 1.0),
    )
    found = told(checks=checks)
    assert found.status == "unverified"
    assert found.message == (
        "verification failed: the tracking error is 0.02, tolerance 0.001; "
        "the cab's jerk is nan, tolerance 1"
    )
    assert not found.solved
    assert told(checks=checks[:1]).status == "converged"


def test_without_a_solution_there_is_a_reason_and_no_number(told: Any) -> None:
    found = told(
        solution={"status": "infeasible", "message": "No such motion."},
        checks=(Check("a", "the optimality", 2.0, 1.0),),
    )
    assert (found.status, found.message) == ("infeasible", "No such motion.")
    assert (found.objective_reduction, found.cost, found.limits_ok) == (None, None, None)
    assert found.iterations == 6


def test_a_weight_of_all_joints_is_told_without_rounding() -> None:
    assert mean_weight(np.full(3, 0.1)) == 0.1  # of which numpy's mean is another double
    assert mean_weight(np.array([1.0, 2.0, 6.0])) == 3.0
