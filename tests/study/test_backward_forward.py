"""The study's law on motions whose adjoint is known by other means."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.coriolis import coriolis
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.study.backward_forward import adjoint_along, factors_of

CHAIN = chain_of(DES, Seat())
R1 = np.diag([1.0, 2.0, 0.5])


@pytest.fixture
def motion(rng) -> Motion:
    t = np.cumsum(rng.uniform(0.05, 0.3, 12))
    return Motion(t, rng.normal(size=(12, 3)), *rng.normal(size=(2, 11, 3)))


@pytest.mark.parametrize("axes", ["report", "seat"])
def test_the_adjoint_is_what_turning_the_rest_of_the_motion_takes_off_the_cost(motion, axes):
    # L(t) = -dJ/dtheta of all later angles moved alike; (42) with (45), by complex steps
    def running(shift, first):
        angle = motion.angle_sides[first:] + shift
        c = coriolis(CHAIN, angle, motion.rate_sides[first:], axes)
        return 0.5 * motion.step[first:] @ (0.5 * np.sum((c @ R1) * c, axis=-1)).sum(axis=1)

    found = adjoint_along(motion, CHAIN, axes, R1)
    np.testing.assert_array_equal(found[-1], 0.0)
    for first in (0, 4, 10):
        for joint, unit in enumerate(np.eye(3)):
            slope = running(1e-30j * unit, first).imag / 1e-30
            assert found[first, joint] == pytest.approx(slope, rel=1e-10, abs=1e-12)


def test_a_factor_falls_by_the_power_of_the_adjoint_over_its_weight(motion, rng):
    adjoint = rng.normal(size=(12, 3))
    scalar, joints = (factors_of(motion, adjoint, r2) for r2 in (np.array([2.0]), np.ones(3)))
    at_five = 0.5 * adjoint[5] * (motion.rate_end[4] + motion.rate_start[5])
    np.testing.assert_allclose(1.0 - joints[5], at_five, rtol=1e-12)
    np.testing.assert_allclose(1.0 - scalar[5], at_five.sum() / 2.0, rtol=1e-12)
    np.testing.assert_allclose(1.0 - joints[0], adjoint[0] * motion.rate_start[0], rtol=1e-12)
