"""The study's sweep and constant factors, against numbers found elsewhere."""

import numpy as np
import pytest

from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.motion import Motion, integrate_sides
from des_cli.profiles_in.load import load_profile
from des_cli.tradeoff.baselines import CONSTANT_FACTORS
from tests.support.points import Rows, column, curve


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
