"""From quantities at points of a spline's intervals to its control points and back.

A quantity at a point depends on a few local variables (an angle, a rate, an
acceleration of a joint), and these on the twelve control-point coordinates of the
point's interval, its window. Gradients and Hessians by the local variables become
gradients and a band by the control points through constant matrices.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.solver.band import SymmetricBand
from des_cli.solver.spline import GAUSS, ORDER, SplineGrid

JOINTS = 3
WINDOW = ORDER * JOINTS
POINTS = len(GAUSS)
"""Points per interval: with Gauss's rule they integrate the seat's motion to the fourth
order in the step."""

CHUNK = 512
"""Intervals evaluated at a time, so that temporaries stay in a core's cache."""


class Windows:
    """The map between local variables at the points of a grid and control points.

    Parameters
    ----------
    grid : SplineGrid
    variables : sequence of (int, int)
        Order of the derivative and joint of each local variable, v of them.
    """

    def __init__(self, grid: SplineGrid, variables: Sequence[tuple[int, int]]) -> None:
        self.grid, self.count = grid, len(variables)
        weights = [grid.basis(np.array(GAUSS), order) for order in range(3)]
        # (variable, point, control point of the window, joint)
        local = np.zeros((self.count, POINTS, ORDER, JOINTS))
        for k, (order, joint) in enumerate(variables):
            local[k, :, :, joint] = weights[order]
        self._local = local.reshape(self.count * POINTS, WINDOW)
        self.pairs = [(k, n) for k in range(self.count) for n in range(k, self.count)]

    @cached_property
    def _to_band(self) -> Floats:
        """What each pair of variables adds to the band, (pairs * points, 4 * 36)."""
        local = self._local.reshape(self.count, POINTS, WINDOW)
        matrix = np.zeros((len(self.pairs), POINTS, ORDER, JOINTS, WINDOW))
        for index, (k, n) in enumerate(self.pairs):
            for point in range(POINTS):
                outer = np.outer(local[k, point], local[n, point])
                if k != n:
                    outer = outer + outer.T
                for a in range(ORDER):
                    for j in range(JOINTS):
                        q = JOINTS * a + j
                        matrix[index, point, a, j, : WINDOW - q] = outer[q:, q]
        return np.ascontiguousarray(matrix.reshape(len(self.pairs) * POINTS, ORDER * 3 * WINDOW))

    def times(self) -> Floats:
        """Return the times of all points, (points * K,) [s], in the order of `gather`."""
        u = np.array(GAUSS)[:, None]
        start, step = self.grid.start, self.grid.step
        return np.concatenate(
            [(start + step * (np.arange(*span) + u)).reshape(-1) for span in self.chunks()]
        )

    def chunks(self) -> list[tuple[int, int]]:
        """Return spans of intervals that are evaluated together."""
        k = self.grid.intervals
        return [(first, min(first + CHUNK, k)) for first in range(0, k, CHUNK)]

    def gather(self, control: Floats, first: int, last: int) -> Floats:
        """Return the local variables on intervals first to last, (v, points * count).

        Parameters
        ----------
        control : (n, 3) array
        first, last : int
        """
        window = np.concatenate([control[first + a : last + a].T for a in range(ORDER)])
        return np.asarray((self._local @ window).reshape(self.count, POINTS * (last - first)))

    def scatter(self, gradient: Floats, first: int, total: Floats) -> None:
        """Add a gradient by local variables, (v, points * count), to one by control points."""
        count = gradient.shape[1] // POINTS
        by_window = self._local.T @ gradient.reshape(self.count * POINTS, count)
        for a in range(ORDER):
            total[first + a : first + a + count] += by_window[JOINTS * a : JOINTS * (a + 1)].T

    def scatter_hessian(self, hessian: Floats, first: int, band: SymmetricBand) -> None:
        """Add a Hessian by local variables, its upper triangle (pairs, points * count)."""
        count = hessian.shape[1] // POINTS
        parts = hessian.reshape(len(self.pairs) * POINTS, count).T @ self._to_band
        flat = band.data.reshape(len(band.data), JOINTS * WINDOW)
        for a in range(ORDER):
            flat[first + a : first + a + count] += parts[:, 36 * a : 36 * (a + 1)]

    def to_window(self, slope: Floats) -> Floats:
        """Return derivatives by the window, summed over its points, (12, ...).

        Parameters
        ----------
        slope : (v, ..., points * count) array
            By the local variables of the points.
        """
        count = slope.shape[-1] // POINTS
        parts = slope.reshape(self.count, -1, POINTS, count).transpose(0, 2, 1, 3)
        flat = self._local.T @ parts.reshape(self.count * POINTS, -1)
        return np.asarray(flat.reshape(WINDOW, *slope.shape[1:-1], count))

    def scatter_squares(self, slope: Floats, first: int, band: SymmetricBand) -> None:
        """Add the sum of squares of derivatives by the window, (12, r, count)."""
        count = slope.shape[-1]
        flat = band.data.reshape(len(band.data), JOINTS * WINDOW)
        for q in range(WINDOW):
            a, joint = divmod(q, JOINTS)
            products = np.einsum("rm,prm->mp", slope[q], slope[q:])
            at = joint * WINDOW
            flat[first + a : first + a + count, at : at + WINDOW - q] += products
