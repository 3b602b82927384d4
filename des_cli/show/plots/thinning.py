"""As many points of a curve as a picture can show."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from des_cli.model.arrays import Floats

# Somewhat more than the pixels between the left and the right end of an axis.
COLUMNS = 1600


def thin(t: Floats, values: Floats, columns: int = COLUMNS) -> tuple[Floats, Floats]:
    """Return the points of a curve that matter for its picture.

    The time axis is cut into equal columns, and of each the first, the lowest,
    the highest and the last point stay: every peak is drawn at its height.

    Parameters
    ----------
    t : (n,) array
        Strictly increasing.
    values : (n,) array
    columns : int

    Returns
    -------
    t, values : (m,) array
        Points of the input in their order, ``m <= 4 * columns``; all of them
        where they are no more than that.
    """
    if len(t) <= 4 * columns:
        return t, values
    edges = np.searchsorted(t, np.linspace(t[0], t[-1], columns + 1))
    edges[-1] = len(t)
    keep = []
    for start, stop in pairwise(edges):
        if start < stop:
            inside = values[start:stop]
            keep += [start, start + inside.argmin(), start + inside.argmax(), stop - 1]
    index = np.unique(keep)
    return t[index], values[index]
