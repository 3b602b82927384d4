"""Bounds on what is felt at each point of a free motion: one row a point, at most one.

Budgets are integrals; these hold at every point. Each kind gives its rows' values and
their derivatives by the local variables of the points, and the Lagrangian's curvature.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from des_cli.kinematics.trig_polynomial import TrigPolynomial
from des_cli.kinematics.twist import VARIABLES, SeatMotion
from des_cli.model.arrays import Floats
from des_cli.reduction.free.terms import Quantity, curvature_of, slope_of, value_of


class LocalBound(Protocol):
    """A bound with some rows at each point."""

    @property
    def rows(self) -> int:
        """Rows at each point."""

    def value(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the values, (rows, m), of points with joint angles (3, m)."""

    def slope(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the derivatives by the variables, (v, rows, m)."""

    def curvature(self, seat: SeatMotion, angles: Floats, at: slice, multiplier: Floats) -> Floats:
        """Return the second derivatives times multipliers (rows, m), (v (v + 1) / 2, m)."""


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

    def curvature(self, seat: SeatMotion, angles: Floats, at: slice, multiplier: Floats) -> Floats:
        """Return the second derivatives times multipliers, (36, m)."""
        return curvature_of(seat, {"force": self.force_multiplier(multiplier)})

    def force_multiplier(self, multiplier: Floats) -> Floats:
        """Return the force's multipliers, (3, m), of the rows', (rows, m)."""
        return np.asarray((self.direction / self.scale[:, None]).T @ multiplier)

    def along(self, change: Floats) -> Floats:
        """Return what a change of the force, (3, m), changes of the rows, (rows, m)."""
        return np.asarray((self.direction / self.scale[:, None]) @ change)


@dataclass(frozen=True, eq=False)
class NormBound:
    """A bound on the length of a quantity: ``|value|^2 / bound^2``.

    Parameters
    ----------
    quantity : str
    bound : float
        In the quantity's unit.
    """

    quantity: Quantity
    bound: float
    rows: int = 1

    def value(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the values, (1, m)."""
        return np.asarray(np.sum(value_of(seat, self.quantity) ** 2, axis=0)[None] / self.bound**2)

    def slope(self, seat: SeatMotion, angles: Floats, at: slice) -> Floats:
        """Return the derivatives by the variables, (8, 1, m)."""
        by = slope_of(seat, self.quantity)
        slope = np.zeros((VARIABLES, 1, by.shape[-1]))
        slope[: len(by), 0] = np.einsum("kcm,cm->km", by, value_of(seat, self.quantity))
        return slope * (2.0 / self.bound**2)

    def curvature(self, seat: SeatMotion, angles: Floats, at: slice, multiplier: Floats) -> Floats:
        """Return the second derivatives times multipliers, (36, m)."""
        weight = 2.0 * multiplier / self.bound**2
        hessian = curvature_of(seat, {self.quantity: weight * value_of(seat, self.quantity)})
        by = slope_of(seat, self.quantity)
        at_pair = 0
        for k in range(VARIABLES):
            if k < len(by):
                hessian[at_pair : at_pair + len(by) - k] += weight[0] * np.einsum(
                    "cm,lcm->lm", by[k], by[k:]
                )
            at_pair += VARIABLES - k
        return hessian


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

    def curvature(self, seat: SeatMotion, angles: Floats, at: slice, multiplier: Floats) -> Floats:
        """Return the second derivatives times multipliers (rows, count), (36, 2 count)."""
        return curvature_of(seat, {"force": self.force_multiplier(multiplier)})

    def force_multiplier(self, multiplier: Floats) -> Floats:
        """Return the force's multipliers, (3, 2 count), of the rows', (rows, count)."""
        second = self.direction.T @ multiplier  # of the second point; the first has its negative
        return np.concatenate([-second, second], axis=1)

    def along(self, change: Floats) -> Floats:
        """Return what a change of the force, (3, 2 count), changes of the rows."""
        first, second = np.split(change, 2, axis=1)
        return np.asarray(self.direction @ (second - first))
