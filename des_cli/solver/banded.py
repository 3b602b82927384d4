"""Linear systems whose blocks couple neighbours in time, solved in linear time.

Of n by n blocks, each b by b, those near the diagonal are not zero. A `Part` is a run of
like ones: of n = 4 and b = 2, the diagonal with ``ahead=0``, and with ``ahead=1`` a part
of one row and two columns, ``row=1``, marked o::

      k    0   |   1   |   2   |   3
    0    x   x |       |       |
         x   x | o   o |       |          ``below`` = 1 and ``above`` = 2 places of the
    1          | x   x |       |          diagonal are used: the band has as many rows as
               | x   x | o   o |          that, whatever the blocks' size.
    2          |       | x   x |
               |       | x   x | o   o
    3          |       |       | x   x
               |       |       | x   x

LAPACK keeps a band by columns: entry (i, j) in row ``below + above + i - j`` of column j,
below as many rows of room for what pivoting fills in.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError
from scipy.linalg.lapack import dgbtrf, dgbtrs, dpbtrf

from des_cli.model.arrays import Flags, Floats

BLOCK = 512
"""Samples written at a time: their columns stay in a core's cache."""


@dataclass(frozen=True)
class Part:
    """Like blocks at successive samples of a matrix of n by n blocks.

    Parameters
    ----------
    values : (m, r, c) array
        Its last two axes are rows and columns inside a block.
    row, column : int
        Where in the block they begin.
    ahead : int
        How many samples its columns are ahead of its rows.
    first : int
        The sample of the first one: of its rows, or where these are ahead of its columns.
    """

    values: Floats
    row: int = 0
    column: int = 0
    ahead: int = 0
    first: int = 0

    def used(self) -> Flags:
        """Return the places that are not zero in every block, (r, c)."""
        return np.asarray(self.values.any(axis=0))


class BandedLU:
    """A banded matrix, factorised with partial pivoting.

    Parameters
    ----------
    n, b : int
        Number and size of the diagonal blocks.
    parts : sequence of Part
        What it consists of; parts do not overlap. Places that are zero in every block
        and lie outside the band of the others cost nothing.

    Raises
    ------
    LinAlgError
        If the matrix is singular.
    """

    def __init__(self, n: int, b: int, parts: Sequence[Part]) -> None:
        used = [part.used() for part in parts]
        reaches = [_reach(part, places, b) for part, places in zip(parts, used, strict=True)]
        below = max((reach[0] for reach in reaches), default=0)
        above = max((reach[1] for reach in reaches), default=0)
        self._shape = (n, b)
        self._band = (below, above)
        # the first rows are room for what pivoting fills in
        band = np.zeros((n, b, 2 * below + above + 1))
        _fill(band, parts, used, below + above)
        columns = band.reshape(n * b, -1).T
        self._lu, self._pivots, info = dgbtrf(columns, below, above, overwrite_ab=True)
        if info != 0:
            raise LinAlgError("singular matrix")

    def solve(self, right: Floats) -> Floats:
        """Solve for right-hand sides, (n, b) or (n, b, s).

        Raises
        ------
        LinAlgError
            If the solution is not finite.
        """
        n, b = self._shape
        columns = right.reshape(n * b, -1)
        solution, _ = dgbtrs(self._lu, *self._band, columns, self._pivots)
        if not np.all(np.isfinite(solution)):
            raise LinAlgError("singular matrix")
        return np.asarray(solution).reshape(right.shape)


def is_positive_definite(n: int, b: int, parts: Sequence[Part]) -> bool:
    """Return whether a symmetric banded matrix is positive definite.

    Parameters
    ----------
    n, b : int
        Number and size of the diagonal blocks.
    parts : sequence of Part
        Its lower triangle, of which what stands above the diagonal is left out.
    """
    used = [part.used() for part in parts]
    below = max(_reach(part, places, b)[0] for part, places in zip(parts, used, strict=True))
    band = np.zeros((n, b, below + 1))
    lower = [w & (_below(part, b) >= 0) for part, w in zip(parts, used, strict=True)]
    _fill(band, parts, lower, 0)
    return bool(dpbtrf(band.reshape(n * b, -1).T, lower=1, overwrite_ab=True)[1] == 0)


def _below(part: Part, b: int) -> np.ndarray[tuple[int, int], np.dtype[np.intp]]:
    """Return how far below the diagonal each place of a part stands, (r, c)."""
    _, rows, columns = part.values.shape
    row = part.row + np.arange(rows)[:, None]
    return row - part.column - np.arange(columns) - b * part.ahead


def _reach(part: Part, used: Flags, b: int) -> tuple[int, int]:
    """Return how far a part reaches below and above the diagonal."""
    below = _below(part, b)[used]
    return int(np.max(below, initial=0)), int(np.max(-below, initial=0))


def _fill(band: Floats, parts: Sequence[Part], used: Sequence[Flags], diagonal: int) -> None:
    """Write parts into the columns of a band, (n, b, height), some samples at a time."""
    places = [
        [(i, j, diagonal + _below(part, band.shape[1])[i, j]) for i, j in np.argwhere(where)]
        for part, where in zip(parts, used, strict=True)
    ]
    for start in range(0, len(band), BLOCK):
        for part, each in zip(parts, places, strict=True):
            shift = part.first + max(part.ahead, 0)
            first = max(start, shift)
            values = part.values[first - shift : start + BLOCK - shift]
            columns = band[first : first + len(values), part.column :]
            for i, j, height in each:
                columns[:, j, height] = values[:, i, j]
