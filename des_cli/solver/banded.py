"""Linear systems whose blocks couple neighbours in time, solved in linear time."""

from __future__ import annotations

import numpy as np
from scipy.linalg import LinAlgError, cholesky_banded
from scipy.linalg.lapack import dgbtrf, dgbtrs

from des_cli.model.arrays import Floats


class BlockTridiagonal:
    """A block tridiagonal matrix, factorised by banded LU with partial pivoting.

    Parameters
    ----------
    diagonal : (n, b, b) array
        Blocks (k, k).
    upper, lower : (n - 1, b, b) array
        Blocks (k, k + 1) and (k + 1, k). Entries that are zero in every block
        and lie outside the band of the others cost nothing.

    Raises
    ------
    LinAlgError
        If the matrix is singular.
    """

    def __init__(self, diagonal: Floats, upper: Floats, lower: Floats) -> None:
        n, b, _ = diagonal.shape
        above = max(_reach(diagonal, 0), _reach(upper, b))
        below = max(_reach(np.swapaxes(diagonal, 1, 2), 0), _reach(np.swapaxes(lower, 1, 2), b))
        self._shape = (n, b)
        self._band = (below, above)
        # the first rows are room for what pivoting fills in
        band = np.zeros((2 * below + above + 1, n * b), order="F")
        middle = below + above
        for i in range(b):
            for j in range(b):
                if -below <= j - i <= above:
                    band[middle + i - j, j::b] = diagonal[:, i, j]
                if b + j - i <= above:
                    band[middle + i - j - b, b + j :: b] = upper[:, i, j]
                if b + i - j <= below:
                    band[middle + b + i - j, j : (n - 1) * b : b] = lower[:, i, j]
        self._lu, self._pivots, info = dgbtrf(band, below, above, overwrite_ab=True)
        if info != 0:
            raise LinAlgError("singular matrix")

    def solve(self, right: Floats) -> Floats:
        """Solve for one right-hand side, (n, b).

        Raises
        ------
        LinAlgError
            If the solution is not finite.
        """
        n, b = self._shape
        solution, _ = dgbtrs(self._lu, *self._band, right.reshape(n * b), self._pivots)
        if not np.all(np.isfinite(solution)):
            raise LinAlgError("singular matrix")
        return np.asarray(solution).reshape(n, b)


def is_positive_definite(diagonal: Floats, upper: Floats) -> bool:
    """Return whether a symmetric block tridiagonal matrix is positive definite.

    Parameters
    ----------
    diagonal : (n, b, b) array
        Blocks (k, k).
    upper : (n - 1, b, b) array
        Blocks (k, k + 1).
    """
    n, b, _ = diagonal.shape
    above = max(b - 1, _reach(upper, b))
    band = np.zeros((above + 1, n * b))
    for i in range(b):
        for j in range(b):
            if j >= i:
                band[above + i - j, j::b] = diagonal[:, i, j]
            if b + j - i <= above:
                band[above + i - j - b, b + j :: b] = upper[:, i, j]
    try:
        cholesky_banded(band, overwrite_ab=True, check_finite=False)
    except LinAlgError:
        return False
    return True


def _reach(blocks: Floats, shift: int) -> int:
    """Return the farthest superdiagonal on which any block has an entry."""
    used = np.any(blocks != 0.0, axis=0) if len(blocks) else np.zeros(blocks.shape[1:], bool)
    rows, columns = np.nonzero(used)
    return int(np.max(columns - rows + shift, initial=0))
