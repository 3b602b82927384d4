"""Curves as text inside the page: as many rows as a screen shows, as 32-bit numbers."""

from __future__ import annotations

import base64
from itertools import pairwise

import numpy as np

from des_cli.model.arrays import Floats, Indices
from des_cli.show.page.curves import Family

FINEST = 700
"""Columns of pixels that a curve is cut into on a page of few runs."""

COARSEST = 120
"""The same on a page of many."""

_COLUMNS_OF_PAGE = 3600
"""Of all runs together: what keeps a page of many of them small."""


_MOST_ROWS = 4
"""Rows for each column of pixels above which a family is thinned further."""

_FEWEST = 30
"""Columns below which it is not."""


def columns_for(runs: int) -> int:
    """Return into how many columns the curves of each run are cut.

    >>> [columns_for(runs) for runs in (1, 5, 15, 100)]
    [700, 700, 240, 120]
    """
    return min(FINEST, max(COARSEST, _COLUMNS_OF_PAGE // runs))


def thin_family(family: Family, columns: int) -> Family:
    """Return the rows of a family that matter for its picture.

    The time axis is cut into equal columns; of each the first row stays, and the rows with
    the least and the largest value of every curve: all peaks keep their heights and their
    times.
    """
    t = family.t
    if len(t) <= 2 * columns:
        return family
    values = np.stack(list(family.values.values()), axis=1)
    rows = _telling_rows(t, values, columns)
    # Curves of noise have their extremes at different times: wider columns have fewer of them.
    wide = columns // 2
    while len(rows) > _MOST_ROWS * columns and wide >= _FEWEST:
        rows = _telling_rows(t, values, wide)
        wide //= 2
    return Family(t[rows], {name: each[rows] for name, each in family.values.items()})


def _telling_rows(t: Floats, values: Floats, columns: int) -> Indices:
    """Return the first rows of equal columns of time, and those of all extremes in them."""
    edges = np.searchsorted(t, np.linspace(t[0], t[-1], columns + 1))
    edges[-1] = len(t)
    keep = {0, len(t) - 1}
    for start, stop in pairwise(edges.tolist()):
        if start < stop:
            inside = values[start:stop]
            keep |= {start, *(start + inside.argmin(axis=0)), *(start + inside.argmax(axis=0))}
    return np.array(sorted(keep), dtype=np.intp)


def pack_family(family: Family, start: float) -> dict[str, str]:
    """Return a family's times, counted from a start [s], and its curves."""
    packed = {"t": pack(family.t - start)}
    return packed | {name: pack(values) for name, values in family.values.items()}


def pack(values: Floats) -> str:
    """Return numbers as the base64 of 32-bit floats, the lowest byte first."""
    with np.errstate(over="ignore"):
        return base64.b64encode(values.astype("<f4").tobytes()).decode("ascii")
