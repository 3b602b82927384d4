"""Banded matrices as whole ones."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.solver.band import SymmetricBand


def dense(band: SymmetricBand) -> Floats:
    """Return the whole matrix, (n d, n d)."""
    n, d, width = band.data.shape
    rows = band.data.reshape(n * d, width)
    matrix = np.zeros((n * d, n * d))
    for i in range(n * d):
        for k in range(min(width, n * d - i)):
            matrix[i, i + k] = matrix[i + k, i] = rows[i, k]
    return matrix
