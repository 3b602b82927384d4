"""Symmetric systems over the control points of a spline, banded, in linear time.

Control points that share an interval couple, so that with d components, ordered by
control point first, the half-bandwidth is 4 d - 1. For d = 2 and n control points::

    P0 | x .                    entry (i, j, k) of the storage couples unknown 2 i + j
       | x x                    with unknown 2 i + j + k, k = 0 to 7
    P1 | x x x
       | x x x x
    P2 | x x x x x
       | x x x x x x
    P3 | x x x x x x x
       | x x x x x x x x
    P4 |     x x x x x x x      (P4 no longer meets P0)
"""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dpbtrf, dpbtrs

from des_cli.model.arrays import Floats
from des_cli.solver.spline import ORDER, STENCILS, Ends


class SymmetricBand:
    """A symmetric matrix over control points.

    Parameters
    ----------
    points, components : int
        n and d.
    """

    def __init__(self, points: int, components: int) -> None:
        self.data = np.zeros((points, components, ORDER * components))

    def copy(self) -> SymmetricBand:
        """Return a copy."""
        twin = SymmetricBand.__new__(SymmetricBand)
        twin.data = self.data.copy()
        return twin

    def add_differences(
        self, weight: Floats, order: int, step: float, components: slice = slice(None)
    ) -> None:
        """Add D' diag(weight) D, with D the differences of an order over the step.

        Parameters
        ----------
        weight : (n - order, d) array
        order : int
        step : float
            [s]
        components : slice
            Those that the columns of the weight belong to.
        """
        d = self.data.shape[1]
        stencil = STENCILS[order] / step**order
        m = len(weight)
        for b in range(order + 1):
            for a in range(b, order + 1):
                self.data[b : b + m, components, d * (a - b)] += stencil[a] * stencil[b] * weight

    def times(self, x: Floats) -> Floats:
        """Return the product with a vector (n, d)."""
        n, d, width = self.data.shape
        flat, band = x.reshape(-1), self.data.reshape(n * d, width)
        product = band[:, 0] * flat
        for k in range(1, width):
            if np.any(column := band[:-k, k]):
                product[k:] += column * flat[:-k]
                product[:-k] += column * flat[k:]
        return product.reshape(n, d)

    def reduced(self, ends: Ends) -> SymmetricBand:
        """Return the matrix over the unknowns that conditions at the ends leave.

        Idle unknowns get a one on the diagonal.
        """
        reduced = self.copy()
        n, d, width = self.data.shape
        for at, rows, blocks in ((0, slice(0, 3), ends.first), (n - 6, slice(3, 6), ends.last)):
            change = np.eye(6 * d).reshape(6, d, 6, d)
            for j in range(d):
                change[rows, j, rows, j] = blocks[j]
            matrix = change.reshape(6 * d, 6 * d)
            dense = matrix.T @ reduced._dense(at) @ matrix
            reduced._set_dense(at, dense)
        idle = ends.idle(n).reshape(-1)
        if np.any(ends.held):
            band = reduced.data.reshape(n * d, width)
            for k in range(width):
                band[: n * d - k, k][idle[: n * d - k] | idle[k:]] = 0.0
        reduced.data.reshape(n * d, width)[idle, 0] = 1.0
        return reduced

    def _dense(self, at: int) -> Floats:
        """Return the block of six control points, (6 d, 6 d)."""
        _, d, width = self.data.shape
        size = 6 * d
        rows = self.data[at : at + 6].reshape(size, width)
        dense = np.zeros((size, size))
        for q in range(size):
            m = min(width, size - q)
            dense[q : q + m, q] = dense[q, q : q + m] = rows[q, :m]
        return dense

    def _set_dense(self, at: int, dense: Floats) -> None:
        _, d, width = self.data.shape
        size = 6 * d
        rows = self.data[at : at + 6].reshape(size, width)
        for q in range(size):
            m = min(width, size - q)
            rows[q, :m] = dense[q : q + m, q]


class BandCholesky:
    """A factorised positive definite band.

    Parameters
    ----------
    factor : (4 d, n d) array
        As LAPACK keeps it.
    """

    def __init__(self, factor: Floats) -> None:
        self._factor = factor

    @classmethod
    def of(cls, band: SymmetricBand) -> BandCholesky | None:
        """Factorise, or return None where the matrix is not positive definite."""
        n, d, width = band.data.shape
        factor, info = dpbtrf(band.data.reshape(n * d, width).T, lower=1)
        return cls(factor) if info == 0 else None

    def solve(self, right: Floats) -> Floats:
        """Solve for columns, (n d, r)."""
        solution, _ = dpbtrs(self._factor, right, lower=1)
        return np.asarray(solution)
