"""The Newton system of a problem that is banded in time, factorised once."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from des_cli.model.arrays import Flags, Floats
from des_cli.solver.banded import BandedLU, Part, is_positive_definite

DYNAMICS_WEIGHT = 1e3
"""Weight on the squared dynamics in the test for convexity, relative to the problem's
scale and times the square of the number of samples: the weakest dynamics, a drift
over all of them, falls with that. Large against any negative curvature, and small
enough that the rounding of what it weighs is none."""


class Dynamics:
    """Linearised dynamics in the unknowns that move.

    Parameters
    ----------
    left, ahead : (n - 1, 3, w) array
        d defect_k / d x_k and / d x_{k+1}.
    pinned : (n, w) array of bool
        Unknowns that do not move.
    """

    def __init__(self, left: Floats, ahead: Floats, pinned: Flags) -> None:
        self.pinned = pinned
        self.left, self.ahead = left, ahead
        if np.any(pinned[:-1]):
            self.left = left * ~pinned[:-1, None, :]
        if np.any(pinned[1:]):
            self.ahead = ahead * ~pinned[1:, None, :]

    @cached_property
    def squared(self) -> tuple[Floats, Floats]:
        """Blocks (k, k) and (k + 1, k) of the squared dynamics, (n or n - 1, w, w)."""
        turned = transposed(self.ahead)
        at = np.zeros((len(self.left) + 1, self.left.shape[2], self.left.shape[2]))
        at[:-1] = transposed(self.left) @ self.left
        at[1:] += turned @ self.ahead
        return at, turned @ self.left


class NewtonSystem:
    """Symmetric blocks of a Hessian over a linearised dynamics.

    The unknowns of a sample stand together with the multiplier of the interval
    that it begins: [x_k, lambda_k].

    Parameters
    ----------
    hessian : (n, w, w) array
        Blocks (k, k); the system takes them over.
    across : (n - 1, w, w) array, optional
        Blocks (k, k + 1); it takes them over too.
    dynamics : Dynamics
    """

    def __init__(self, hessian: Floats, across: Floats | None, dynamics: Dynamics) -> None:
        self.dynamics, self._hessian, self._across = dynamics, hessian, across
        still = dynamics.pinned
        k = np.flatnonzero(np.any(still, axis=1))
        ends = np.arange(hessian.shape[1])
        hessian[k] *= (~still[k])[:, :, None] & (~still[k])[:, None, :]
        hessian[k[:, None], ends, ends] += still[k]
        if across is not None and len(k):
            across *= (~still[:-1])[:, :, None] & (~still[1:])[:, None, :]
        self._lu: BandedLU | None = None

    def is_convex(self, size: float) -> bool:
        """Return whether the Hessian is positive definite on the linearised dynamics.

        Parameters
        ----------
        size : float
            Typical size of the Hessian's blocks.
        """
        n, width, _ = self._hessian.shape
        weight = DYNAMICS_WEIGHT * n**2 * size
        at, behind = self.dynamics.squared
        below = weight * behind
        if self._across is not None:
            below += transposed(self._across)
        parts = (Part(self._hessian + weight * at), Part(below, ahead=-1))
        return is_positive_definite(n, width, parts)

    def solve(self, force: Floats, defect: Floats) -> tuple[Floats, Floats]:
        """Return the step in x, (n, w), and the new multipliers, (n - 1, 3).

        Raises
        ------
        LinAlgError
            If the system is singular.
        """
        n, width, _ = self._hessian.shape
        if self._lu is None:
            self._lu = self._factorise()
        right = np.zeros((n, width + 3))
        right[:, :width] = -force
        right[:, :width][self.dynamics.pinned] = 0.0
        right[:-1, width:] = -defect
        solution = self._lu.solve(right)
        return solution[:, :width], solution[:-1, width:]

    def _factorise(self) -> BandedLU:
        n, width, _ = self._hessian.shape
        left, ahead = self.dynamics.left, self.dynamics.ahead
        parts = [
            Part(self._hessian),
            Part(left, row=width),
            Part(transposed(left), column=width),
            Part(np.eye(3)[None], width, width, first=n - 1),  # the last begins no interval
            Part(ahead, row=width, ahead=1),
            Part(transposed(ahead), column=width, ahead=-1),
        ]
        if self._across is not None:
            parts += [Part(self._across, ahead=1), Part(transposed(self._across), ahead=-1)]
        return BandedLU(n, width + 3, parts)


def transposed(blocks: Floats) -> Floats:
    """Return the transposes of blocks, (k, j, i)."""
    return np.swapaxes(blocks, 1, 2)
