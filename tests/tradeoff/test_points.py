"""``sweep``: the points against numbers found elsewhere."""

import numpy as np
import pytest

from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.motion import Motion, integrate_sides
from des_cli.profiles_in.load import load_profile
from des_cli.tradeoff.baselines import CONSTANT_FACTORS
from tests.support.points import COARSE, STUDY, Rows, column, curve, rows_of


@pytest.fixture(scope="module")
def by_weight(tmp_path_factory: pytest.TempPathFactory) -> Rows:
    from click.testing import CliRunner

    from des_cli.cli.main import program

    args = ["sweep", "cobra", *STUDY, *COARSE, "--limits", "warn", "--r2s", "8,1,0.2", "-f", "csv"]
    result = CliRunner().invoke(program, args)
    assert result.exit_code == 0, result.stderr
    return rows_of(result.stdout)


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


def test_the_study_is_there_for_each_weight(by_weight: Rows) -> None:
    # Its single sweep on this profile: 13.5, 63.9 and 11.4 %.
    study = curve(by_weight, "report-sweep")
    assert column(study, "value") == [8.0, 1.0, 0.2]
    assert column(study, "bb3_reduction") == pytest.approx([0.135, 0.639, 0.114], abs=3e-3)
    assert {row["status"] for row in study} == {"baseline"}


def bb3(motion: Motion, p: float) -> np.ndarray:
    """BB3 of (23) for angles and rates that a constant factor slows down."""
    start = motion.angle[0]
    (a1, a2, _), rates = (
        np.moveaxis(start + p * (motion.angle_sides - start), -1, 0),
        p * np.moveaxis(motion.rate_sides, -1, 0),
    )
    s1, c1, s2, c2 = np.sin(a1), np.cos(a1), np.sin(a2), np.cos(a2)
    return -c1 * rates[0] * rates[1] + (s1 * c2 * rates[0] + c1 * s2 * rates[1]) * rates[2]


def test_constant_factors_are_those_of_the_formula(by_weight: Rows) -> None:
    motion = make_desired(load_profile("cobra", settings=["time.step_s=0.05"])).motion
    before = integrate_sides(motion.step, bb3(motion, 1.0) ** 2)
    away = motion.angle_sides - motion.angle[0]
    energy = [
        integrate_sides(motion.step, np.sum(v**2, axis=-1)) for v in (away, motion.angle_sides)
    ]
    per_slowing = np.sqrt(energy[0] / energy[1])
    points = curve(by_weight, "constant-p")
    assert column(points, "value") == list(CONSTANT_FACTORS)
    for point, p in zip(points, CONSTANT_FACTORS, strict=True):
        left = integrate_sides(motion.step, bb3(motion, p) ** 2) / before
        # The solver's own motion between samples is linear in the rates, as here.
        assert float(point["bb3_reduction"]) == pytest.approx(1.0 - left, abs=2e-3)
        deviation = float(point["joint_deviation_relative"])
        assert deviation == pytest.approx((1.0 - p) * per_slowing, rel=1e-3)
        assert point["cost"] == ""


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
