"""Commands given as expressions, sampled on a grid that respects their joints."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.profiles_in.dual import Side
from des_cli.profiles_in.expression import Expression, constant_expression
from des_cli.profiles_in.sections import Section

LONGEST = 1e7
"""Longest profile [s], a hundred days and more: what is longer was meant in another unit."""

SHORTEST_STEP = 1e-9
"""Shortest step [s]: a jerk over a shorter one is no number to compare with a limit."""

FINEST = 1e-12
"""Shortest step over the largest time: what a shorter one changes is rounding for the most
part."""

MAX_WORK = 400_000_000
"""Samples times operations of an expression: some seconds of arithmetic."""

_MERGE = 1e-6
"""Times closer than this part of a step are one sample: an interval that much
shorter than its neighbours would carry rounding instead of motion."""


MAX_MAGNITUDE = 1e6
"""Largest angle or rate of a command [rad, rad/s]: beyond any machine, and small
enough that no product of a few of them overflows."""


class SamplingError(ValueError):
    """A command that has no finite values on the grid; the message says when."""


@dataclass(frozen=True, slots=True)
class Piece:
    """One stretch of a command.

    Parameters
    ----------
    start, stop : float
        Profile times [s].
    expression : Expression
    index : int, optional
        Its place in a list of segments.
    """

    start: float
    stop: float
    expression: Expression
    index: int | None = None


def pieces_of(value: Any) -> tuple[Piece, ...]:
    """Return the stretches of a command as the schema read it.

    Parameters
    ----------
    value : float, Expression or list of segments
    """
    if isinstance(value, list):
        return tuple(_segment_piece(segment, index) for index, segment in enumerate(value))
    return (Piece(-math.inf, math.inf, _expression(value)),)


def _segment_piece(segment: Section, index: int) -> Piece:
    value = segment.value  # type: ignore[attr-defined]
    return Piece(segment.si("from"), segment.si("to"), _expression(value), index)


def _expression(value: Any) -> Expression:
    return value if isinstance(value, Expression) else constant_expression(value)


def count_samples(start: float, stop: float, step: float) -> float:
    """Return how many samples a regular grid would have (perhaps too many to make)."""
    return (stop - start) / step + 1.0


def regular_grid(start: float, stop: float, step: float) -> Floats:
    """Return times from start to stop; the last step is shorter where need be.

    Each time is the double nearest to its decimal value (0.35, not
    0.01 * 35 = 0.35000000000000003), so that a segment's joint and a kink of
    an expression fall on the sample that a reader of the file expects.

    Parameters
    ----------
    start, stop, step : float
        [s]; stop > start, step > 0.

    Returns
    -------
    (n,) array
        n >= 2 [s].
    """
    steps = (stop - start) / step
    whole = round(steps)
    exact = whole >= 1 and abs(steps - whole) <= _MERGE
    count = whole if exact else math.floor(steps)
    first, each = Fraction(repr(start)), Fraction(repr(step))
    scale = math.lcm(first.denominator, each.denominator)
    numerators = int(first * scale), int(each * scale)
    index = np.arange(count + 1, dtype=np.float64)
    if scale < 2**53 and abs(numerators[0]) + abs(numerators[1]) * (count + 1) < 2**53:
        t = (numerators[0] + index * numerators[1]) / scale
    else:
        t = start + index * step
    if exact:
        t[-1] = stop
        return t
    return np.append(t, stop)


def grid_with_joints(t: Floats, joints: Iterable[float]) -> Floats:
    """Insert the times at which segments join, where the grid has no sample yet.

    Parameters
    ----------
    t : (n,) array
        Increasing times [s].
    joints : iterable of float
        [s]; those outside the grid are left out.

    Returns
    -------
    (m,) array
        m >= n [s].
    """
    inside = np.array(sorted({joint for joint in joints if t[0] < joint < t[-1]}))
    if not len(inside):
        return t
    after = np.searchsorted(t, inside)
    near = np.minimum(np.abs(inside - t[after - 1]), np.abs(t[after] - inside))
    new = inside[near > _MERGE * (t[after] - t[after - 1])]
    apart = np.diff(new, prepend=-np.inf) > 0
    return np.union1d(t, new[apart])


@dataclass(frozen=True, slots=True)
class Sides:
    """A command at both ends of every interval, in SI units and radians.

    Parameters
    ----------
    start, end : (n - 1,) array
        Values.
    rate_start, rate_end : (n - 1,) array
        Exact derivatives with respect to time.
    """

    start: Floats
    end: Floats
    rate_start: Floats
    rate_end: Floats


def sample_sides(pieces: tuple[Piece, ...], t: Floats, to_si: float, *, rates: bool) -> Sides:
    """Evaluate a command at both ends of every interval.

    Parameters
    ----------
    pieces : tuple of Piece
        They cover the grid without gaps.
    t : (n,) array
        The grid [s]; a joint of two pieces is a sample of it.
    to_si : float
        Factor from the command's unit.
    rates : bool
        Whether the derivatives must be finite too.

    Raises
    ------
    SamplingError
        Naming the first time at which a value or derivative is not finite.
    """
    start, rate_start = _sample(pieces, t, t[:-1], 1)
    end, rate_end = _sample(pieces, t, t[1:], -1)
    sides: tuple[tuple[Floats, Side], ...] = ((t[:-1], 1), (t[1:], -1))
    for (times, side), values in zip(sides, (start, end), strict=True):
        _require_finite(pieces, times, values * to_si, side, "the expression")
    if rates:
        for (times, side), values in zip(sides, (rate_start, rate_end), strict=True):
            _require_finite(pieces, times, values * to_si, side, "the rate of the expression")
    # Adding zero turns a negative zero, as -60*(1 - cos(0)) makes, into zero.
    return Sides(*(part * to_si + 0.0 for part in (start, end, rate_start, rate_end)))


def sample_middle(pieces: tuple[Piece, ...], t: Floats, to_si: float) -> Floats:
    """Evaluate a command in the middle of every interval, (n - 1,)."""
    middle = 0.5 * (t[:-1] + t[1:])
    values = _sample(pieces, t, middle, 1)[0] * to_si
    _require_finite(pieces, middle, values, 1, "the expression")
    return values


def _sample(
    pieces: tuple[Piece, ...], t: Floats, times: Floats, side: Side
) -> tuple[Floats, Floats]:
    """Evaluate at one time of every interval, by the piece that covers the interval."""
    middle = 0.5 * (t[:-1] + t[1:])
    first = np.searchsorted(middle, [piece.start for piece in pieces])
    last = np.append(first[1:], len(middle))
    first[0] = 0
    value, rate = np.empty(len(middle)), np.empty(len(middle))
    for piece, start, stop in zip(pieces, first, last, strict=True):
        if stop > start:
            part = slice(start, stop)
            value[part], rate[part] = piece.expression.at(times[part], side)
    return value, rate


def _require_finite(
    pieces: tuple[Piece, ...], times: Floats, values: Floats, side: Side, what: str
) -> None:
    wrong = ~(np.abs(values) <= MAX_MAGNITUDE)
    if not wrong.any():
        return
    index = int(np.argmax(wrong))
    first = float(times[index])
    if np.isfinite(values[index]):
        raise SamplingError(
            f"{what} is beyond {MAX_MAGNITUDE:g} rad or rad/s at t = {first:.12g} s"
        )
    if any(
        piece.expression.overflows(first, side)
        for piece in pieces
        if piece.start <= first <= piece.stop
    ):
        raise SamplingError(f"{what} comes to a number that is too large at t = {first:.12g} s")
    raise SamplingError(
        f"{what} has no finite value at t = {first:.12g} s "
        "(a division by zero, or outside a function's domain)"
    )


def first_jump(sides: Sides, t: Floats, tolerance: float) -> tuple[float, float, float] | None:
    """Return the first time at which a command jumps, with both values, or None.

    Parameters
    ----------
    sides : Sides
    t : (n,) array
    tolerance : float
        Relative to the larger of 1 and the value.
    """
    before, after = sides.end[:-1], sides.start[1:]
    jumps = np.abs(after - before) > tolerance * np.maximum(1.0, np.abs(before))
    if not jumps.any():
        return None
    at = int(np.argmax(jumps))
    return float(t[at + 1]), float(before[at]), float(after[at])
