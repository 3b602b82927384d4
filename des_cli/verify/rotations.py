"""Rotations as matrices, from rotation vectors and from quaternions."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats


def exponential(vector: Floats) -> Floats:
    """Return the rotations of rotation vectors (m, 3), (3, 3, m), by quaternions."""
    half = 0.5 * np.linalg.norm(vector, axis=1)
    return matrices(np.column_stack([np.cos(half), 0.5 * np.sinc(half / np.pi)[:, None] * vector]))


def matrices(quaternion: Floats) -> Floats:
    """Return the rotations of unit quaternions w, x, y, z (m, 4), (3, 3, m)."""
    w, x, y, z = quaternion.T
    return np.array(
        [
            [w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    )
