"""What the interior-point method needs to know of a problem."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from des_cli.model.arrays import Flags, Floats
from des_cli.reduction.constraints import Rows
from des_cli.reduction.transcription import Expansion


class Program(Protocol):
    """A cost at samples, dynamics between neighbours, and local inequalities."""

    @property
    def rows(self) -> Sequence[Rows]:
        """The inequalities."""

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
