"""Bounds on what is felt all along a free motion: rows that are at most one.

Budgets are integrals; these hold at every point, or at both ends of every interval. Each
kind gives its rows' values and their derivatives by the local variables of the points, and
what its multipliers make of the Lagrangian's curvature.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from des_cli.kinematics.trig_polynomial import TrigPolynomial
from des_cli.kinematics.twist import VARIABLES, SeatMotion
from des_cli.model.arrays import Floats
from des_cli.reduction.free.terms import Quantity, slope_of, value_of
from des_cli.solver.spline import GAUSS

TO_ENDS = 0.5 * np.array([[1.0 + np.sqrt(3.0), 1.0 - np.sqrt(3.0)]] * 2)
TO_ENDS[1] = TO_ENDS[1, ::-1]
"""What of its values at the two points of an interval a straight line has at either end."""


class LocalBound(Protocol):
    """A bound with some rows at each point, or on each interval."""

    @property
    def rows(self) -> int:
        """Rows at each point, or on each interval."""

    @property
    def per_interval(self) -> bool:
        """Whether a row belongs to both points of an interval, and not to one."""

    def value(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the values, (rows, m or count), of points with joint angles (3, m)."""

    def slope(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the derivatives by the variables of each point, (v, rows, m)."""


@dataclass(frozen=True, eq=False)
class ComponentBound:
    """Bounds on components of the specific force: ``1 + (direction . f - bound) / scale``.

    Parameters
    ----------
    direction : (rows, 3) array
        Along seat axes [s^2/m].
    bound : (rows,) array
        Largest value of each [1].
    scale : (rows,) array
        Distance from the bound that counts as one.
    """

    direction: Floats
    bound: Floats
    scale: Floats
    per_interval: bool = False

    @property
    def rows(self) -> int:
        """Rows at each point."""
        return len(self.bound)

    def value(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the values, (rows, m)."""
        off = self.direction @ seat.force - self.bound[:, None]
        return np.asarray(1.0 + off / self.scale[:, None])

    def slope(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the derivatives by the variables, (8, rows, m)."""
        return np.asarray((self.direction / self.scale[:, None]) @ seat.force_slope)

    def force_multiplier(self, multiplier: Floats) -> Floats:
        """Return the force's multipliers, (3, m), of the rows', (rows, m)."""
        return np.asarray((self.direction / self.scale[:, None]).T @ multiplier)

    def along(self, change: Floats) -> Floats:
        """Return what a change of the force, (3, m), changes of the rows, (rows, m)."""
        return np.asarray((self.direction / self.scale[:, None]) @ change)


@dataclass(frozen=True, eq=False)
class NormBound:
    """A bound on the length of a quantity at both ends of each interval: ``|value|^2 / bound^2``.

    A joint's acceleration is linear over an interval and has its corners at the knots, so that
    what it makes is largest there. The value at an end is that of the straight line through
    those at the interval's two points, which for the total angular acceleration is off by a
    twelfth of the squared step times its second derivative.

    Parameters
    ----------
    quantity : str
    bound : float
        In the quantity's unit.
    """

    quantity: Quantity
    bound: float
    rows: int = len(GAUSS)
    per_interval: bool = True

    def value(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the values, (2, count)."""
        ends = at_ends(value_of(seat, self.quantity))
        return np.asarray(np.sum(ends**2, axis=1) / self.bound**2)

    def slope(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the derivatives by the variables of both points, (8, 2, 2 count)."""
        by = slope_of(seat, self.quantity)
        ends = at_ends(value_of(seat, self.quantity))
        slope = np.zeros((VARIABLES, self.rows, by.shape[-1]))
        for end, row in enumerate(TO_ENDS):
            value = np.concatenate([share * ends[end] for share in row], axis=1)
            np.einsum("kcm,cm->km", by, value, out=slope[: len(by), end])
        slope *= 2.0 / self.bound**2
        return slope

    def multiplier(self, seat: SeatMotion, multiplier: Floats) -> Floats:
        """Return the quantity's multipliers, (3, 2 count), of the rows', (2, count)."""
        ends = at_ends(value_of(seat, self.quantity)) * self.weight(multiplier)[:, None]
        return np.concatenate([np.tensordot(share, ends, 1) for share in TO_ENDS.T], axis=1)

    def weight(self, multiplier: Floats) -> Floats:
        """Return the weights of the squared values in the second derivatives, (2, count)."""
        return np.asarray(2.0 * multiplier / self.bound**2)

    def parts(self, seat: SeatMotion) -> Floats:
        """Return the derivatives of the values at the ends, (v, 6, 2 count): end after end."""
        by = slope_of(seat, self.quantity)
        count = by.shape[-1] // 2
        shares = np.repeat(TO_ENDS, count, axis=1)  # (2, 2 count)
        return np.concatenate([share * by for share in shares], axis=1)

    def along(self, change: Floats) -> Floats:
        """Return what a change of the quantity, (3, 2 count), is at the ends, (6, count)."""
        ends = at_ends(change)
        return ends.reshape(-1, ends.shape[-1])

    def turned(self, seat: SeatMotion, change: Floats) -> Floats:
        """Return what a change of the quantity, (3, 2 count), changes of the rows, (2, count)."""
        along = np.sum(at_ends(change) * at_ends(value_of(seat, self.quantity)), axis=1)
        return np.asarray(2.0 / self.bound**2 * along)


@dataclass(frozen=True, eq=False)
class AttitudeBound:
    """A bound on the angle between the seat's attitude and the reference's.

    The squared chord ``|R - R_ref|^2 = 8 sin^2(angle / 2)`` over that of the bound; its
    variables are the three joint angles.

    Parameters
    ----------
    rotation : TrigPolynomial
        R_0^17, value (9,).
    reference : (9, p) array
        At all points.
    bound : float
        [rad]
    """

    rotation: TrigPolynomial
    reference: Floats
    bound: float
    rows: int = 1
    per_interval: bool = False

    @property
    def _per_chord(self) -> float:
        return float(1.0 / (8.0 * np.sin(0.5 * self.bound) ** 2))

    def value(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the values, (1, m)."""
        off = self.rotation(angles.T).T - self.reference[:, at]
        return np.asarray(np.sum(off**2, axis=0)[None] * self._per_chord)

    def slope(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the derivatives by the joint angles, (3, 1, m)."""
        turned = self.rotation.gradient()(angles.T)  # (m, 3, 9)
        along = np.einsum("mac,cm->am", turned, self.reference[:, at])
        return np.asarray(-2.0 * self._per_chord * along[:, None])

    def curvature(self, seat: SeatMotion, angles: Floats, at: slice, multiplier: Floats) -> Floats:
        """Return the second derivatives times multipliers, (6, m)."""
        second = self.rotation.gradient().gradient()(angles.T)  # (m, 3, 3, 9)
        along = np.einsum("mabc,cm->abm", second, self.reference[:, at])
        upper = along[np.triu_indices(3)]
        return np.asarray(-2.0 * self._per_chord * multiplier[0] * upper)


@dataclass(frozen=True, eq=False)
class OnsetBound:
    """A bound on the rate of change of the specific force between an interval's two points.

    Parameters
    ----------
    direction : (rows, 3) array
        Along seat axes, over the bound and the time between the points [s^2/m].
    """

    direction: Floats
    per_interval: bool = True

    @property
    def rows(self) -> int:
        """Rows on each interval."""
        return len(self.direction)

    def value(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the values, (rows, count)."""
        first, second = np.split(seat.force, 2, axis=1)
        return np.asarray(self.direction @ (second - first))

    def slope(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the derivatives by the variables of both points, (8, rows, 2 count)."""
        slope = self.direction @ seat.force_slope
        slope[..., : slope.shape[-1] // 2] *= -1.0
        return np.asarray(slope)

    def force_multiplier(self, multiplier: Floats) -> Floats:
        """Return the force's multipliers, (3, 2 count), of the rows', (rows, count)."""
        second = self.direction.T @ multiplier  # of the second point; the first has its negative
        return np.concatenate([-second, second], axis=1)

    def along(self, change: Floats) -> Floats:
        """Return what a change of the force, (3, 2 count), changes of the rows."""
        first, second = np.split(change, 2, axis=1)
        return np.asarray(self.direction @ (second - first))


def at_ends(values: Floats) -> Floats:
    """Return values at both ends of intervals, (2, c, count), of those at points, (c, 2 count)."""
    points = values.reshape(len(values), len(GAUSS), -1)
    return np.asarray(np.einsum("ep,cpm->ecm", TO_ENDS, points))
