"""The Newton system of a problem that is banded in time, factorised once."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Flags, Floats
from des_cli.solver.banded import BlockTridiagonal, is_positive_definite

DYNAMICS_WEIGHT = 1e6
"""Weight on the squared dynamics, relative to the problem's scale, in the test for
convexity: large against any negative curvature, small against 1e16."""


class NewtonSystem:
    """Symmetric blocks of a Hessian over a linearised dynamics.

    The unknowns of a sample stand together with the multiplier of the interval
    that it begins: [x_k, lambda_k].

    Parameters
    ----------
    hessian : (n, w, w) array
        Blocks (k, k).
    across : (n - 1, w, w) array
        Blocks (k, k + 1).
    left, ahead : (n - 1, 3, w) array
        d defect_k / d x_k and / d x_{k+1}.
    pinned : (n, w) array of bool
        Unknowns that do not move.
    """

    def __init__(
        self, hessian: Floats, across: Floats, left: Floats, ahead: Floats, pinned: Flags
    ) -> None:
        self._free = free = ~pinned
        self._left = left * free[:-1, None, :]
        self._ahead = ahead * free[1:, None, :]
        self._here = hessian * free[:, :, None] * free[:, None, :]
        ends = np.arange(hessian.shape[1])
        self._here[:, ends, ends] += pinned
        self._across = across * free[:-1, :, None] * free[1:, None, :]
        self._lu: BlockTridiagonal | None = None

    def is_convex(self, size: float) -> bool:
        """Return whether the Hessian is positive definite on the linearised dynamics.

        Parameters
        ----------
        size : float
            Typical size of the Hessian's blocks.
        """
        weight = DYNAMICS_WEIGHT * size
        squared = self._here.copy()
        squared[:-1] += weight * transposed(self._left) @ self._left
        squared[1:] += weight * transposed(self._ahead) @ self._ahead
        return is_positive_definite(
            squared, self._across + weight * transposed(self._left) @ self._ahead
        )

    def solve(self, force: Floats, defect: Floats) -> tuple[Floats, Floats]:
        """Return the step in x, (n, w), and the new multipliers, (n - 1, 3).

        Raises
        ------
        LinAlgError
            If the system is singular.
        """
        n, width = self._free.shape
        if self._lu is None:
            self._lu = self._factorise()
        right = np.zeros((n, width + 3))
        right[:, :width] = -force * self._free
        right[:-1, width:] = -defect
        solution = self._lu.solve(right)
        return solution[:, :width], solution[:-1, width:]

    def _factorise(self) -> BlockTridiagonal:
        n, width = self._free.shape
        block = width + 3
        diagonal = np.zeros((n, block, block))
        upper, lower = np.zeros((n - 1, block, block)), np.zeros((n - 1, block, block))
        diagonal[:, :width, :width] = self._here
        diagonal[:-1, width:, :width] = self._left
        diagonal[:-1, :width, width:] = transposed(self._left)
        diagonal[-1, width:, width:] = np.eye(3)  # the last sample begins no interval
        upper[:, :width, :width], lower[:, :width, :width] = self._across, transposed(self._across)
        upper[:, width:, :width], lower[:, :width, width:] = self._ahead, transposed(self._ahead)
        return BlockTridiagonal(diagonal, upper, lower)


def transposed(blocks: Floats) -> Floats:
    """Return the transposes of blocks, (k, j, i)."""
    return np.swapaxes(blocks, 1, 2)
