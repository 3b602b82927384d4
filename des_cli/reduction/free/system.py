"""The linear system of a Newton step of a free motion: a bordered band, factorised.

With B the band over the control points, b the border and c the corner, see ``hessian``::

    [ B  b' ]     [ L         . ] [ L'  L^-1 b' ]
    [       ]  =  [             ] [             ]        S = c - b B^-1 b'
    [ b  c  ]     [ b L'^-1   1 ] [ .      S    ]

L is banded as B is, and S, the Schur complement, has one row for each free angle.
"""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.reduction.free.hessian import BorderedBand
from des_cli.reduction.free.limit_rows import LimitRows
from des_cli.reduction.free.windows import JOINTS
from des_cli.solver.band import BandCholesky
from des_cli.solver.spline import Ends


class MotionSystem:
    """The factorised bordered Hessian over the unknowns that the ends leave free.

    Parameters
    ----------
    factor : BandCholesky
    ends : Ends
    points : int
    border : (s, 3 n) array
        Reduced to the free unknowns.
    corner : (s, s) array
    """

    def __init__(
        self, factor: BandCholesky, ends: Ends, points: int, border: Floats, corner: Floats
    ) -> None:
        self._factor, self._ends, self._points = factor, ends, points
        self._border = border
        self._answers = factor.solve(border.T) if len(border) else border.T
        self._schur = corner - border @ self._answers

    @property
    def convex(self) -> bool:
        """Whether the border leaves the Hessian positive definite."""
        return bool(np.all(np.linalg.eigvalsh(self._schur) > 0.0))

    def solve(self, right: Floats) -> Floats:
        """Solve for columns of the full space, (3 n + s, r)."""
        size = self._points * JOINTS
        reduced = np.stack(
            [self._ends.reduce(c[:size].reshape(-1, JOINTS)).reshape(-1) for c in right.T], axis=1
        )
        motion = self._factor.solve(reduced)
        angles: Floats = np.zeros((len(self._border), right.shape[1]))
        if len(self._border):
            angles = np.asarray(np.linalg.solve(self._schur, right[size:] - self._border @ motion))
            motion = motion - self._answers @ angles
        full = [self._ends.full(c.reshape(-1, JOINTS)).reshape(-1) for c in motion.T]
        return np.concatenate([np.stack(full, axis=1), angles])


def factorise(
    hessian: BorderedBand, rows: LimitRows, ends: Ends, stiffness: Floats, shift: float
) -> MotionSystem | None:
    """Factorise a Hessian with the rows' stiffness; None where it is not convex.

    Parameters
    ----------
    hessian : BorderedBand
    rows : LimitRows
    ends : Ends
    stiffness : (m,) array
        Weights of the squared rows.
    shift : float
        That the band's diagonal grows by, relative to itself.
    """
    band = hessian.band.copy()
    rows.add_to(band, stiffness)
    if shift:
        band.data[:, :, 0] *= 1.0 + shift
    factor = BandCholesky.of(band.reduced(ends))
    if factor is None:
        return None
    points = len(band.data)
    border: Floats = np.array(
        [ends.reduce(row.reshape(-1, JOINTS)).reshape(-1) for row in hessian.border]
    ).reshape(len(hessian.border), points * JOINTS)
    system = MotionSystem(factor, ends, points, border, hessian.corner)
    return system if not len(border) or system.convex else None
