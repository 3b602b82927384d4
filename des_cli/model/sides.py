"""Integrals and largest values of vectors at both ends of every interval.

A long motion has tens of megabytes of each: they are taken in pieces, so that nothing of
their size is made of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.motion import PIECE


class Sizes(NamedTuple):
    """Sizes of vectors over a motion: of each component, then of the length, (d + 1,) each.

    Parameters
    ----------
    square : array
        Integral of the square.
    rms : array
        Root of its mean over time.
    peak : array
        Largest magnitude.
    """

    square: Floats
    rms: Floats
    peak: Floats


def in_pieces(count: int) -> Iterator[slice]:
    """Yield pieces of so many intervals."""
    for first in range(0, count, PIECE):
        yield slice(first, min(first + PIECE, count))


def sizes_of(step: Floats, sides: Floats) -> Sizes:
    """Return the sizes of vectors.

    Parameters
    ----------
    step : (n - 1,) array
        [s]
    sides : (n - 1, 2, d) array
    """
    parts = sides.shape[2]
    square, most = np.zeros(parts + 1), np.zeros(parts + 1)
    for part in in_pieces(len(step)):
        squares = np.empty((parts + 1, 2, part.stop - part.start))
        by_component = np.moveaxis(sides[part], (1, 2), (1, 0))
        np.multiply(by_component, by_component, out=squares[:-1])
        np.sum(squares[:-1], axis=0, out=squares[-1])
        np.maximum(most, np.max(squares, axis=(1, 2)), out=most)
        for i, (start, end) in enumerate(squares):
            square[i] += 0.5 * float(step[part] @ (start + end))
    return Sizes(square, np.sqrt(square / np.sum(step)), np.sqrt(most))


def integral_of(step: Floats, sums: Floats) -> float:
    """Integrate what both ends of every interval have together, (n - 1,)."""
    return sum(0.5 * float(step[part] @ sums[part]) for part in in_pieces(len(step)))


def square_of(step: Floats, sides: Floats, less: Floats | None = None) -> float:
    """Integrate the squared length of vectors, or of their difference from others.

    Parameters
    ----------
    step : (n - 1,) array
    sides, less : (n - 1, 2, d) array
    """
    total = 0.0
    for part in in_pieces(len(step)):
        vectors = sides[part] if less is None else sides[part] - less[part]
        total += 0.5 * float(step[part] @ np.einsum("nsi,nsi->n", vectors, vectors))
    return total


def largest_of(sides: Floats) -> float:
    """Return the largest length of vectors (n - 1, 2, d)."""
    squares = [
        np.max(np.einsum("nsi,nsi->ns", sides[part], sides[part])) for part in in_pieces(len(sides))
    ]
    return float(np.sqrt(np.max(squares)))
