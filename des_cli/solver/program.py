"""What the interior-point method needs to know of a problem."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np

from des_cli.model.arrays import Flags, Floats

Indices: TypeAlias = np.ndarray[tuple[int], np.dtype[np.intp]]


@dataclass(frozen=True)
class Expansion:
    """Cost with its first and second derivatives at one iterate.

    Parameters
    ----------
    cost : float
    gradient : (n, 3 + m) array
    hessian : (n, 3 + m, 3 + m) array
        Blocks (k, k) of the Gauss-Newton Hessian: positive semidefinite.
    across : (n - 1, 3 + m, 3 + m) array, optional
        Its blocks (k, k + 1), where the cost couples neighbours.
    curvature : (n, 3 + m, 3 + m) array, optional
        What is missing to the exact Hessian.
    """

    cost: float
    gradient: Floats
    hessian: Floats
    across: Floats | None = None
    curvature: Floats | None = None

    def plus(self, price: float, other: Expansion) -> Expansion:
        """Add another expansion at a price."""
        return Expansion(
            self.cost + price * other.cost,
            self.gradient + price * other.gradient,
            self.hessian + price * other.hessian,
            _add(self.across, price, other.across),
            _add(self.curvature, price, other.curvature),
        )


class Rows(ABC):
    """Many inequalities ``-1 <= value(x) <= 1``, each local in time.

    Parameters
    ----------
    node : (q,) int array
        The sample k that each group of inequalities belongs to; it may also
        depend on samples k + 1 and k + 2.
    """

    def __init__(self, node: Indices) -> None:
        self.node = node

    @abstractmethod
    def value(self, x: Floats) -> Floats:
        """Return the values, (q, r)."""

    @abstractmethod
    def jacobian(self, x: Floats) -> tuple[Floats, ...]:
        """Return d value / d x_k, and as far as it reaches d x_{k+1}, d x_{k+2}; (q, r, 3 + m)."""

    def curvature(self, x: Floats, multiplier: Floats) -> Floats | None:
        """Return multiplier' d2 value / dx dx, blocks (k, k), (n, 3 + m, 3 + m), or None."""
        return None


class Measure(ABC):
    """A measure of a whole iterate with a budget: at most one."""

    @abstractmethod
    def value(self, x: Floats) -> float:
        """Return the value of an iterate."""

    @abstractmethod
    def expand(self, x: Floats) -> Expansion:
        """Expand the value to second order; the Hessian may be a Gauss-Newton one."""


class Program(Protocol):
    """A cost at samples, dynamics between neighbours, local inequalities, and budgets."""

    @property
    def rows(self) -> Sequence[Rows]:
        """The local inequalities."""

    @property
    def budgets(self) -> Sequence[Measure]:
        """The measures that stay at or below one."""

    @property
    def pinned(self) -> Flags:
        """Unknowns that keep their first value, (n, 3 + m)."""

    @property
    def weight(self) -> Floats:
        """Quadrature weight of each sample, (n,); residuals are judged per unit time."""

    @property
    def scale(self) -> float:
        """Typical size of the running cost's derivative."""

    def cost(self, x: Floats) -> float:
        """Return the cost."""

    def expand(self, x: Floats) -> Expansion:
        """Expand the cost to second order."""

    def defect(self, x: Floats) -> Floats:
        """Return the residual of the dynamics, (n - 1, 3)."""

    def defect_jacobian(self, x: Floats) -> tuple[Floats, Floats]:
        """Return d defect_k / d x_k and / d x_{k+1}, (n - 1, 3, 3 + m) each."""

    def defect_curvature(self, x: Floats, multiplier: Floats) -> Floats | None:
        """Return the second derivatives of multiplier' defect, (n, 3 + m, 3 + m), or None."""


def _add(one: Floats | None, price: float, other: Floats | None) -> Floats | None:
    if other is None:
        return one
    return price * other if one is None else one + price * other
