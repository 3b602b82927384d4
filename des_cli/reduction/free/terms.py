"""What a free motion is judged by, as weighted squares of the seat's quantities.

The cost and most budgets are sums over points of ``|root (value - reference)|^2``, where
the value is one of the seat's quantities in ``kinematics.twist`` and the root holds the
quadrature weight, the weight matrix and the budget.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal, TypeAlias

import numpy as np

from des_cli.kinematics.twist import VARIABLES, SeatMotion
from des_cli.model.arrays import Floats

Quantity: TypeAlias = Literal["rate", "cross", "acceleration", "force"]

_RATE_VARIABLES = 5  # W and c do not depend on the accelerations


@dataclass(frozen=True, eq=False)
class Term:
    """A sum of weighted squares.

    Parameters
    ----------
    quantity : {"rate", "cross", "acceleration", "force"}
        W, c, dW/dt or the specific force.
    root : (3, 3) array
        A square root of the weight: the term is ``sum |root (value - reference)|^2``.
    reference : (3, p) array, optional
        At all points; None for zero.
    floor : float
        What the term has beside the points' squares, whatever the motion, in their unit.
    """

    quantity: Quantity
    root: Floats
    reference: Floats | None = None
    floor: float = 0.0

    @cached_property
    def _diagonal(self) -> Floats | None:
        diagonal = np.diag(self.root)
        return diagonal[:, None] if np.array_equal(self.root, np.diag(diagonal)) else None

    def residual(self, seat: SeatMotion, at: slice) -> Floats:
        """Return the residuals at points, (3, m)."""
        value = value_of(seat, self.quantity)
        off = value if self.reference is None else value - self.reference[:, at]
        return self.weigh(off)

    def weigh(self, vectors: Floats) -> Floats:
        """Return the root times vectors whose component is the last axis but one."""
        if self._diagonal is not None:
            return np.asarray(vectors * self._diagonal)
        return np.asarray(np.einsum("rc,...cm->...rm", self.root, vectors))

    def multiplier(self, residual: Floats) -> Floats:
        """Return half the derivative of the term by the value, (3, m)."""
        return np.asarray(self.root.T @ residual)

    def slope(self, seat: SeatMotion) -> Floats:
        """Return the derivatives of the residuals by the variables, (5 or 8, 3, m)."""
        return self.weigh(slope_of(seat, self.quantity))


def value_of(seat: SeatMotion, quantity: Quantity) -> Floats:
    """Return a quantity along seat axes, (3, m)."""
    if quantity == "rate":
        return seat.twist[:3]
    if quantity == "cross":
        return seat.products[:3]
    if quantity == "acceleration":
        return seat.twist_rate[:3]
    return seat.force


def slope_of(seat: SeatMotion, quantity: Quantity) -> Floats:
    """Return its derivatives by the variables that it depends on, (5 or 8, 3, m)."""
    if quantity == "rate":
        return seat.twist_slope[:, :3]
    if quantity == "cross":
        return seat.products_slope[:, :3]
    if quantity == "acceleration":
        return seat.twist_rate_slope[:, :3]
    return seat.force_slope


def curvature_of(seat: SeatMotion, multipliers: dict[Quantity, Floats]) -> Floats:
    """Return the second derivatives of quantities times their multipliers, (36, m)."""
    none = np.zeros((3, seat.rate.shape[1]))
    return seat.curvature(
        multipliers.get("rate"),
        multipliers.get("cross", none),
        multipliers.get("acceleration"),
        multipliers.get("force"),
    )


def squares(slopes: list[Floats]) -> Floats:
    """Return ``sum slope' slope`` of scaled slopes, its upper triangle, (36, m)."""
    total = np.zeros((VARIABLES * (VARIABLES + 1) // 2, slopes[0].shape[-1]))
    for count in (_RATE_VARIABLES, VARIABLES):
        alike = [slope for slope in slopes if len(slope) == count]
        if alike:
            _add_squares(np.concatenate(alike, axis=1), total)
    return total


def _add_squares(slope: Floats, total: Floats) -> None:
    """Add ``slope' slope`` of the first variables, (5 or 8, r, m), to an upper triangle."""
    first = 0
    for k in range(len(slope)):
        total[first : first + len(slope) - k] += np.einsum("rm,lrm->lm", slope[k], slope[k:])
        first += VARIABLES - k


@dataclass(frozen=True, eq=False)
class JointBudget:
    """Squared deviation of the joint angles, over that of a budget.

    Parameters
    ----------
    scale : float
        Quadrature weight over the squared budget [1/rad^2].
    off : (3, p) array
        Base angles minus the reference's, at all points [rad].
    """

    scale: float
    off: Floats
    floor: float = 0.0

    def residual(self, deviation: Floats, at: slice) -> Floats:
        """Return how far the angles are from the reference's, (3, m) [rad].

        Parameters
        ----------
        deviation : (3, m) array
            Of the angles from the base at points [rad].
        at : slice
            Which points of all.
        """
        return np.asarray(self.off[:, at] + deviation)


def square(residual: Floats) -> float:
    """Return the sum of squares."""
    flat = residual.reshape(-1)
    return float(flat @ flat)
