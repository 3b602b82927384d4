"""The Hessian of a free motion's Lagrangian, for any share of its curvature.

It is a band over the n control points, bordered by a row for each of the s free angles
of the seat. With d = 3 joints a control point meets those of the four intervals that it
shapes, so that the half-bandwidth is 4 d - 1 = 11; of the symmetric half is kept, in
blocks of (3, 3), ::

    P0    | x
    P1    | x x
    P2    | x x x              band    (n, 3, 12), see ``solver.band``
    P3    | x x x x
    P4    |   x x x x          (P4 no longer meets P0)
    P5    |     x x x x
          +------------
    angle | x x x x x x  x     border  (s, 3 n), corner (s, s)

Its convex part are squares of derivatives; its curvature, second derivatives times
multipliers, alone can be indefinite. What it is made of is kept by its parts, span by
span, so that another share of the curvature costs no evaluation of the motion. Parts are
added in one order, whatever the share: sums of rounded numbers depend on it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from des_cli.kinematics.twist import VARIABLES
from des_cli.model.arrays import Floats
from des_cli.reduction.free.terms import squares
from des_cli.reduction.free.windows import JOINTS, Windows
from des_cli.solver.band import SymmetricBand


@dataclass(frozen=True, eq=False)
class BorderedBand:
    """A symmetric matrix over control points and free angles of the seat.

    Parameters
    ----------
    band : SymmetricBand
    border : (s, 3 n) array
    corner : (s, s) array
    """

    band: SymmetricBand
    border: Floats
    corner: Floats

    @classmethod
    def zero(cls, points: int, angles: int) -> BorderedBand:
        """Return a matrix to add to."""
        return cls(
            SymmetricBand(points, JOINTS),
            np.zeros((angles, points * JOINTS)),
            np.zeros((angles, angles)),
        )


class HessianPart(Protocol):
    """Something that adds to a Hessian."""

    def add_to(self, hessian: BorderedBand, share: float) -> None:
        """Add the convex part, and a share of the curvature, 0 to 1."""


@dataclass(frozen=True, eq=False)
class ConstantBand:
    """A multiple of a constant band."""

    band: SymmetricBand
    factor: float = 1.0

    def add_to(self, hessian: BorderedBand, share: float) -> None:
        """Add it; it is convex."""
        hessian.band.data += self.factor * self.band.data


@dataclass(frozen=True, eq=False)
class SeatWeight:
    """A weight on the squares of the seat's free angles [1/rad^2]."""

    weight: float

    def add_to(self, hessian: BorderedBand, share: float) -> None:
        """Add it; it is convex."""
        hessian.corner[:] += self.weight * np.eye(len(hessian.corner))


@dataclass(frozen=True, eq=False)
class PointBlocks:
    """Second derivatives by the local variables of the m points of a span.

    Parameters
    ----------
    windows : Windows
        Of v local variables.
    first : int
        The span's first interval.
    convex, curvature : (v (v + 1) / 2, m) array
        Upper triangles.
    """

    windows: Windows
    first: int
    convex: Floats
    curvature: Floats

    def add_to(self, hessian: BorderedBand, share: float) -> None:
        """Add them by the control points."""
        blocks = self.convex + share * self.curvature if share > 0.0 else self.convex
        self.windows.scatter_hessian(blocks, self.first, hessian.band)


@dataclass(frozen=True, eq=False)
class IntervalSquares:
    """Squares of derivatives by the windows of a span's intervals.

    Parameters
    ----------
    windows : Windows
    first : int
        The span's first interval.
    slope : (12, r, count) array
        By the coordinates of each interval's window, scaled.
    across : (s, v, m) array
        Products with the derivatives by the seat's angles, by the local variables of the points.
    corner : (s, s) array
        Squares of the same by the seat's angles.
    curvature : bool
        Whether they belong to the curvature, and count by its share.
    """

    windows: Windows
    first: int
    slope: Floats
    across: Floats
    corner: Floats
    curvature: bool = False

    def add_to(self, hessian: BorderedBand, share: float) -> None:
        """Add them; they are convex."""
        counted = share if self.curvature else 1.0
        if not counted:
            return
        self.windows.scatter_squares(np.sqrt(counted) * self.slope, self.first, hessian.band)
        hessian.corner[:] += counted * self.corner
        for s, each in enumerate(self.across):
            self.windows.scatter(counted * each, self.first, hessian.border[s].reshape(-1, JOINTS))


@dataclass(frozen=True, eq=False)
class ScaledSlope:
    """Derivatives of r residuals whose squares belong to the Hessian, scaled.

    Parameters
    ----------
    slope : (v, r, m) array
        By the first v local variables of m points.
    by_seat : (s, r, m) array
        By the seat's free angles.
    """

    slope: Floats
    by_seat: Floats


@dataclass(frozen=True, eq=False)
class SeatCurvature:
    """Second derivatives by the seat's angles times multipliers, on a span.

    Parameters
    ----------
    across : sequence of (int, (v, m) array)
        A free angle, and the derivatives by it and the first v local variables.
    corner : sequence of (int, int, float)
        Two free angles, and the derivative by both.
    """

    across: Sequence[tuple[int, Floats]] = ()
    corner: Sequence[tuple[int, int, float]] = ()


class SeatBlocks:
    """Second derivatives by what the seat's motion depends on, on a span of m points.

    Parameters
    ----------
    windows : Windows
    first : int
        The span's first interval.
    slopes : sequence of ScaledSlope
        What the convex part is made of.
    curvature : (36, m) array
        Upper triangle.
    by_seat : SeatCurvature
    """

    def __init__(
        self,
        windows: Windows,
        first: int,
        slopes: Sequence[ScaledSlope],
        curvature: Floats,
        by_seat: SeatCurvature,
    ) -> None:
        self._windows, self._first = windows, first
        self._curvature, self._by_seat = curvature, by_seat
        alone = [each.slope for each in slopes]
        self._convex = squares(alone) if alone else np.zeros_like(curvature)
        # of what the seat's angles have no part in nothing more is made
        self._slopes = [each for each in slopes if len(each.by_seat)]

    def add_to(self, hessian: BorderedBand, share: float) -> None:
        """Add them by the control points and the seat's angles."""
        blocks = self._convex
        if share > 0.0:
            blocks = blocks + share * self._curvature
        self._windows.scatter_hessian(blocks, self._first, hessian.band)
        if len(hessian.corner):
            self._add_border(hessian, share)

    def _add_border(self, hessian: BorderedBand, share: float) -> None:
        across = np.zeros((len(hessian.corner), VARIABLES, self._curvature.shape[1]))
        for each in self._slopes:
            across[:, : len(each.slope)] += np.einsum("krm,srm->skm", each.slope, each.by_seat)
            hessian.corner[:] += np.einsum("srm,trm->st", each.by_seat, each.by_seat)
        if share > 0.0:
            for s, by_angle in self._by_seat.across:
                across[s, : len(by_angle)] += share * by_angle
            for s, t, amount in self._by_seat.corner:
                hessian.corner[s, t] += share * amount
                if s != t:
                    hessian.corner[t, s] += share * amount
        for s, each_angle in enumerate(across):
            column = hessian.border[s].reshape(-1, JOINTS)
            self._windows.scatter(each_angle, self._first, column)
