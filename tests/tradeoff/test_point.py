"""The optima of a curve, against numbers found elsewhere."""

import numpy as np
import pytest

from des_cli.tradeoff.baselines import CONSTANT_FACTORS
from tests.support.points import Rows, column, curve, rows_of


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


@pytest.fixture(scope="module")
def by_budget() -> Rows:
    from click.testing import CliRunner

    from des_cli.cli.main import program

    args = ["sweep", "cobra", "--axes", "seat", "--r1", "2,2,2", "--set", "time.step_s=0.1"]
    result = CliRunner().invoke(program, [*args, "--budgets", "0.02,0.05"])
    assert result.exit_code == 0, result.stderr
    return rows_of(result.stdout)


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


def test_the_optimum_beats_a_constant_factor_of_the_same_deviation(by_budget: Rows) -> None:
    constant = curve(by_budget, "constant-p")
    slow = np.interp(
        0.05, column(constant, "joint_deviation_relative"), column(constant, "objective_reduction")
    )
    assert float(curve(by_budget, "optimum")[1]["objective_reduction"]) > slow + 0.1
