"""The Newton system of a problem that is banded in time, factorised once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Border:
    """Rank-one terms of a Hessian, ``sum_i stiffness_i a_i a_i'``, that couple all samples.

    Parameters
    ----------
    vectors : (n, w, s) array
    stiffness : (s,) array
        Positive.
    """

    vectors: Floats
    stiffness: Floats


class NewtonSystem:
    """Symmetric blocks of a Hessian over a linearised dynamics.

    The unknowns of a sample stand together with the multiplier of the interval
    that it begins: [x_k, lambda_k]. With H_k the blocks (k, k) of the Hessian, C_k those
    (k, k + 1), E_k those (k, k + 2), and L_k, A_k the derivatives of a defect by x_k and
    x_{k+1}, the symmetric band is ::

              x_0   l_0 | x_1   l_1 | x_2   l_2 | x_3
        x_0   H_0   L_0'| C_0    .  | E_0    .  |  .
        l_0   L_0    .  | A_0    .  |  .     .  |  .
        x_1   C_0'  A_0'| H_1   L_1'| C_1    .  | E_1
        l_1    .     .  | L_1    .  | A_1    .  |  .
        x_2   E_0'   .  | C_1'  A_1'| H_2   L_2'| C_2
        l_2    .     .  |  .     .  | L_2    .  | A_2
        x_3    .     .  | E_1'   .  | C_2'  A_2'| H_3

    and a one stands for the multiplier of the last sample, which begins no interval.
    Terms that couple all samples border the band: they are solved for by the formula of
    Sherman, Morrison and Woodbury, for one more right-hand side each.

    Parameters
    ----------
    hessian : (n, w, w) array
        Blocks (k, k); the system takes them over.
    across : sequence of (n - 1 or n - 2, w, w) arrays
        Blocks (k, k + 1) and, if any, (k, k + 2); it takes them over too.
    dynamics : Dynamics
    border : Border, optional
    """

    def __init__(
        self,
        hessian: Floats,
        across: Sequence[Floats],
        dynamics: Dynamics,
        border: Border | None = None,
    ) -> None:
        self.dynamics, self._hessian, self._across = dynamics, hessian, across
        still = dynamics.pinned
        k = np.flatnonzero(np.any(still, axis=1))
        ends = np.arange(hessian.shape[1])
        hessian[k] *= (~still[k])[:, :, None] & (~still[k])[:, None, :]
        hessian[k[:, None], ends, ends] += still[k]
        for off, blocks in enumerate(across, start=1):
            blocks *= (~still[:-off])[:, :, None] & (~still[off:])[:, None, :]
        self._border = border
        self._lu: BandedLU | None = None
        self._woodbury: tuple[Floats, Floats, Floats] | None = None

    def is_convex(self, size: float) -> bool:
        """Return whether the banded Hessian is positive definite on the linearised dynamics.

        Parameters
        ----------
        size : float
            Typical size of the Hessian's blocks.
        """
        n, width, _ = self._hessian.shape
        weight = DYNAMICS_WEIGHT * n**2 * size
        at, behind = self.dynamics.squared
        below = [transposed(blocks) for blocks in self._across] or [np.zeros_like(behind)]
        below[0] = below[0] + weight * behind
        parts = [Part(values, ahead=-off) for off, values in enumerate(below, start=1)]
        return is_positive_definite(n, width, [Part(self._hessian + weight * at), *parts])

    def solve(self, force: Floats, defect: Floats) -> tuple[Floats, Floats]:
        """Return the step in x, (n, w), and the new multipliers, (n - 1, 3).

        Raises
        ------
        LinAlgError
            If the system is singular.
        """
        n, width, _ = self._hessian.shape
        right = np.zeros((n, width + 3))
        right[:, :width] = -self._moving(force)
        right[:-1, width:] = -defect
        if self._lu is None:
            self._lu = self._factorise()
        solution = self._lu.solve(right)
        if self._border is not None:
            solution = self._correct(solution, self._lu, self._border)
        return solution[:, :width], solution[:-1, width:]

    def _moving(self, force: Floats) -> Floats:
        """Return a force on x, (n, w), without what acts on pinned unknowns."""
        return np.where(self.dynamics.pinned, 0.0, force)

    def _correct(self, solution: Floats, lu: BandedLU, border: Border) -> Floats:
        """Return a solution of the band with the border taken in."""
        n, block = solution.shape
        if self._woodbury is None:
            count = len(border.stiffness)
            right = np.zeros((n, block, count))
            for i in range(count):
                right[:, :-3, i] = self._moving(border.vectors[:, :, i])
            answers = lu.solve(right).reshape(n * block, count)
            rows = right.reshape(n * block, count)
            self._woodbury = rows, answers, np.diag(1.0 / border.stiffness) + rows.T @ answers
        rows, answers, small = self._woodbury
        share = np.linalg.solve(small, rows.T @ solution.ravel())
        return np.asarray(solution - (answers @ share).reshape(n, block))

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
        for off, blocks in enumerate(self._across, start=1):
            parts += [Part(blocks, ahead=off), Part(transposed(blocks), ahead=-off)]
        return BandedLU(n, width + 3, parts)


def transposed(blocks: Floats) -> Floats:
    """Return the transposes of blocks, (k, j, i)."""
    return np.swapaxes(blocks, 1, 2)
