"""What the feasible interior point needs to know of a problem.

A program has a cost, few integral budgets, and many local limits: linear ones on both
sides, and nonlinear ones. Vectors are those of the full space, (N,); which of them may
move is the program's own business (``reduce``, ``System.solve``).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, TypeVar

from des_cli.model.arrays import Floats


@dataclass(frozen=True, slots=True)
class Values:
    """A program's functions at a point: cost, budgets (j,), local bounds (k,)."""

    cost: float
    budgets: Floats
    local: Floats


class Expansion(Protocol):
    """A program's functions at a point, with first derivatives, and a Hessian inside.

    Vectors are those of the full space, (N,).
    """

    @property
    def cost(self) -> float:
        """The cost."""

    @property
    def budgets(self) -> Floats:
        """Values of the budgets, (j,)."""

    @property
    def gradient(self) -> Floats:
        """Of the cost, (N,)."""

    @property
    def budget_gradients(self) -> Floats:
        """Of the budgets, as columns, (N, j)."""

    def local_change(self, step: Floats) -> Floats:
        """Return the derivative of the local bounds along a step, (k,)."""

    def local_adjoint(self, multiplier: Floats) -> Floats:
        """Return the transposed derivative times multipliers, (N,)."""


class System(Protocol):
    """A factorised positive definite system."""

    def solve(self, right: Floats) -> Floats:
        """Solve for columns of the full space, (N, r): reduce, solve, expand again."""


E = TypeVar("E", bound=Expansion)


class Program(Protocol[E]):
    """What the method needs to know of a problem."""

    @property
    def bounds(self) -> Floats:
        """Of the linear rows, (m,)."""

    def linear(self, x: Floats) -> Floats:
        """Return the linear rows' values, (m,)."""

    def linear_change(self, step: Floats) -> Floats:
        """Return what a step changes of them."""

    def linear_adjoint(self, multiplier: Floats) -> Floats:
        """Return the transposed rows times multipliers, (N,)."""

    def values(self, x: Floats) -> Values:
        """Evaluate the functions."""

    def expand(self, x: Floats, budget: Floats, local: Floats, stiffness: Floats) -> E:
        """Evaluate with derivatives, once for all shares of the curvature.

        Parameters
        ----------
        x : (N,) array
        budget, local : (j,), (k,) array
            Multipliers, for the Hessian of the Lagrangian.
        stiffness : (k,) array
            Weights of ``grad h grad h'`` that the barrier adds.
        """

    def system(self, expansion: E, share: float, stiffness: Floats, shift: float) -> System | None:
        """Factorise the Hessian and ``rows' diag(stiffness) rows``; None if not convex.

        Parameters
        ----------
        expansion : Expansion
        share : float
            Of the curvature part of the Hessian, 0 to 1.
        stiffness : (m,) array
            Of the linear rows.
        shift : float
            That the diagonal grows by, relative to itself.
        """

    def reduce(self, gradient: Floats) -> Floats:
        """Return a gradient by the free unknowns, zero where nothing moves."""
