"""The Coriolis vector along a motion, and its slope, in pieces that stay in a cache.

Both sides of a sample have the same angles: what depends on these is evaluated once for
both, and only the rates' products differ.
"""

from __future__ import annotations

from collections.abc import Iterator
from weakref import WeakKeyDictionary

import numpy as np

from des_cli.kinematics.chain import Chain
from des_cli.kinematics.coriolis import PAIRS, angle_gradient_form, pairs_form
from des_cli.kinematics.trig_polynomial import TrigPolynomial, basis
from des_cli.model.arrays import Floats
from des_cli.model.motion import Motion
from des_cli.model.profile import Axes
from des_cli.model.sides import integral_of

BLOCK = 2048
"""Intervals that are evaluated at a time."""


def coriolis_along(chain: Chain, motion: Motion, axes: Axes) -> Floats:
    """Return the Coriolis vector at both ends of every interval, (n - 1, 2, 3) [rad/s^2].

    Parameters
    ----------
    chain : Chain
    motion : Motion
    axes : {"report", "seat"}
    """
    values = np.empty((len(motion.t) - 1, 2, 3))
    for part, sides in coriolis_blocks(chain, motion, axes):
        for side, c in enumerate(sides):
            values[part, side] = c.T
    return values


def coriolis_blocks(
    chain: Chain, motion: Motion, axes: Axes
) -> Iterator[tuple[slice, tuple[Floats, Floats]]]:
    """Yield blocks of intervals with the vector at their starts and at their ends, (3, m) each."""
    form = pairs_form(chain, axes)
    for part, angle, rates in _blocks(motion):
        pairs = _values(form, angle).reshape(3, 3, -1)
        start, end = (
            _contract(pairs[..., at], _products(rate))
            for at, rate in zip((slice(None, -1), slice(1, None)), rates, strict=True)
        )
        yield part, (start, end)


def weighted_square(chain: Chain, motion: Motion, axes: Axes, r1: Floats) -> float:
    """Return ``int c' R1 c dt`` of a motion, by the trapezoidal rule [rad^2/s^3].

    Asked again for the same motion, as long as that is there, this returns what it found.

    Parameters
    ----------
    chain : Chain
    motion : Motion
    axes : {"report", "seat"}
    r1 : (3, 3) array
    """
    known = _squares.setdefault(motion, {})
    key = (chain, axes, r1.tobytes())
    if key not in known:
        square = np.empty(len(motion.t) - 1)
        for part, (start, end) in coriolis_blocks(chain, motion, axes):
            square[part] = np.sum((r1 @ start) * start, axis=0)
            square[part] += np.sum((r1 @ end) * end, axis=0)
        known[key] = integral_of(motion.step, square)
    return known[key]


_squares: WeakKeyDictionary[Motion, dict[tuple[Chain, Axes, bytes], float]] = WeakKeyDictionary()


def coriolis_slope(chain: Chain, motion: Motion, axes: Axes, r1: Floats) -> Floats:
    """Return ``1/2 d/dangle c' R1 c``, summed over both ends of every interval.

    Parameters
    ----------
    chain : Chain
    motion : Motion
    axes : {"report", "seat"}
    r1 : (3, 3) array
        Symmetric weight on the components.

    Returns
    -------
    (n - 1, 3 angle) array
        At fixed rates.
    """
    form, gradient = pairs_form(chain, axes), angle_gradient_form(chain, axes)
    slope = np.zeros((len(motion.t) - 1, 3))
    for part, angle, rates in _blocks(motion):
        pairs = _values(form, angle).reshape(3, 3, -1)
        turned = _values(gradient, angle).reshape(3, 3, 3, -1)  # angle, pair, component
        for at, rate in zip((slice(None, -1), slice(1, None)), rates, strict=True):
            products = _products(rate)
            weighted = r1.T @ _contract(pairs[..., at], products)
            for joint in gradient.joints:
                by_angle = _contract(turned[joint][..., at], products)
                slope[part, joint] += np.sum(weighted * by_angle, axis=0)
    return slope


def _blocks(motion: Motion) -> Iterator[tuple[slice, Floats, tuple[Floats, Floats]]]:
    """Yield intervals, the angles at their samples (m + 1, 3), and both rates (3, m)."""
    intervals = len(motion.t) - 1
    for first in range(0, intervals, BLOCK):
        part = slice(first, min(first + BLOCK, intervals))
        start, end = (
            np.ascontiguousarray(rate[part].T) for rate in (motion.rate_start, motion.rate_end)
        )
        yield part, motion.angle[first : part.stop + 1], (start, end)


def _values(form: TrigPolynomial, angle: Floats) -> Floats:
    """Return the values of a polynomial, (size of one, m)."""
    return np.asarray(form.matrix.T @ basis(angle, form.joints))


def _products(rate: Floats) -> list[Floats]:
    """Return the products of the rates (3, m) of the joint pairs."""
    return [rate[j] * rate[k] for j, k in PAIRS]


def _contract(pairs: Floats, products: list[Floats]) -> Floats:
    """Return the sum over the pairs, (3 pair, 3, m) and three (m,), (3, m)."""
    one, two, three = products
    c = pairs[0] * one
    c += pairs[1] * two
    c += pairs[2] * three
    return np.asarray(c)
