"""What is evaluated along a motion, in blocks, against the same state by state."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.coriolis import coriolis, coriolis_derivatives
from des_cli.kinematics.coriolis_along import BLOCK, coriolis_along, coriolis_blocks, coriolis_slope
from des_cli.model.motion import Motion


@pytest.fixture
def motion(rng):
    """A motion of random states, whose rates step at every sample, longer than a block."""
    count = BLOCK + 3
    angle = rng.uniform(-7.0, 7.0, (count, 3))
    return Motion(np.arange(count) * 0.1, angle, *rng.normal(size=(2, count - 1, 3)))


@pytest.mark.parametrize("axes", ["report", "seat"])
def test_the_vector_of_every_state(case, motion, axes):
    expected = coriolis(case.chain, motion.angle_sides, motion.rate_sides, axes)
    found = coriolis_along(case.chain, motion, axes)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13)
    blocks = list(coriolis_blocks(case.chain, motion, axes))
    assert [part for part, _ in blocks] == [slice(0, BLOCK), slice(BLOCK, BLOCK + 2)]
    np.testing.assert_array_equal(blocks[1][1][1].T, found[BLOCK:, 1])


@pytest.mark.parametrize("axes", ["report", "seat"])
def test_the_slope_of_the_weighted_square(case, motion, axes):
    r1 = np.array([[2.0, 0.3, 0.0], [0.3, 1.0, -0.1], [0.0, -0.1, 0.5]])
    states = (motion.angle_sides, motion.rate_sides)
    c, dc_dangle, _ = coriolis_derivatives(case.chain, *states, axes)
    expected = np.einsum("nsi,ij,nsja->na", c, r1, dc_dangle)
    found = coriolis_slope(case.chain, motion, axes, r1)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)
