"""Rotations as quaternions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from des_cli.runs_out.scene import quaternion


def matrix(x: float, y: float, z: float, w: float) -> np.ndarray:
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


@given(st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4))
def test_a_rotation_is_that_of_its_quaternion(values: list[float]) -> None:
    size = np.linalg.norm(values)
    if size < 1e-3:
        return
    rotation = matrix(*(value / size for value in values))
    np.testing.assert_allclose(matrix(*quaternion(rotation)), rotation, atol=1e-9)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_half_turns(axis: int) -> None:
    rotation = -np.eye(3)
    rotation[axis, axis] = 1.0
    np.testing.assert_allclose(matrix(*quaternion(rotation)), rotation, atol=1e-15)
