"""The bounds on what the occupant gets, measured on a motion as its tables play it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import OccupantBounds
from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.verify.felt import Felt

WINDOW = 0.1
"""Time [s] over which a change of G is an onset; see the nomenclature."""

MEETS = 1e-6
"""Share of the window within which its other end meets a sample, whatever rounding says."""

TOGETHER = 1024
"""Neighbouring states whose windows are looked at together."""

Window = tuple[int, float, int, int]
"""Windows of neighbouring states: 0 of starts or 1 of ends of intervals, the time from there
to their other ends [s], and the first interval and the one after the last."""

OCCUPANT_TOLERANCE = 1e-9
"""Excess over a bound that rounding alone may make, relative to the bound or to one."""


def check_occupant(bounds: OccupantBounds, motion: Motion, felt: Felt) -> list[Check]:
    """Measure a motion against the bounds that there are.

    Parameters
    ----------
    bounds : OccupantBounds
    motion : Motion
    felt : Felt
        At its states.
    """
    return [
        Check(
            f"occupant.{key}",
            f"relative excess of the occupant's {name}",
            excess,
            OCCUPANT_TOLERANCE,
        )
        for key, name, excess in (
            (key, name, float(np.max(values)))
            for key, name, values in excesses(bounds, motion, felt)
        )
    ]


def excesses(
    bounds: OccupantBounds, motion: Motion, felt: Felt
) -> Iterator[tuple[str, str, Floats]]:
    """Yield key, name and excess at each state, (2 (n - 1),), of every bound.

    The excess is in units of the bound, or of the unit where the bound is below it.
    """
    for component, name, (least, most) in zip(
        felt.g, ("gx", "gy", "gz"), (bounds.gx, bounds.gy, bounds.gz), strict=True
    ):
        over = [
            (sign * component - bound) / max(1.0, abs(bound))
            for sign, bound in ((1.0, most), (-1.0, -least))
            if np.isfinite(bound)
        ]
        if over:
            yield name, name.capitalize(), np.asarray(np.max(over, axis=0))
    if np.isfinite(bounds.g_onset):
        onset = np.max(_onset(motion, felt), axis=0)
        yield "onset", "G onset", (onset - bounds.g_onset) / max(1.0, bounds.g_onset)
    most = bounds.angular_acceleration
    if np.isfinite(most):
        size = np.sqrt(np.sum(felt.turning**2, axis=0))
        yield "angular_acceleration", "angular acceleration", (size - most) / max(1.0, most)


def steepness(bounds: OccupantBounds, motion: Motion, felt: Felt) -> Floats:
    """Return by how much G rises faster than its bound within each interval, (n - 1,).

    Relative as in `excesses`. It is not what is bounded, but a method may hold the slope
    of G at every instant, and where it does nothing moves freely.
    """
    count = len(motion.step)
    samples = np.concatenate([felt.g[:, :count], felt.g[:, -1:]], axis=1)
    slope = np.max(np.abs(np.diff(samples, axis=1)) / motion.step, axis=0)
    return np.asarray((slope - bounds.g_onset) / max(1.0, bounds.g_onset))


def largest_onsets(motion: Motion, felt: Felt) -> Floats:
    """Return the largest change of each component of G over ``WINDOW``, (3,) [g/s].

    Looked for where it can be: from states whose G, and the G where their windows end, are
    so far apart that none looked at before changes as much.
    """
    states, most = _reach(motion, felt.g)
    largest, looked = np.zeros(len(felt.g)), set[int]()
    for component in range(len(felt.g)):
        for at in np.argsort(-most[:, component]).tolist():
            if most[at, component] <= largest[component]:
                break
            if at not in looked:
                looked.add(at)
                change = _onset_at(motion, felt.g, *states[at])
                largest = np.maximum(largest, np.max(change, axis=1))
    return largest


def _onset(motion: Motion, felt: Felt) -> Floats:
    """Return the change of G over ``WINDOW`` that begins or ends at each state, (3, m) [g/s]."""
    onset, count = np.zeros_like(felt.g), len(motion.step)
    for side, shift, first, last in _windows(motion):
        here = onset[:, side * count + first : side * count + last]
        np.maximum(here, _onset_at(motion, felt.g, side, shift, first, last), out=here)
    return onset


def _windows(motion: Motion) -> list[Window]:
    """Return all windows that there are, those of neighbouring states together."""
    t, count = motion.t, len(motion.step)
    window = min(WINDOW, float(t[-1] - t[0]))
    return [
        (side, shift, first, min(first + TOGETHER, count))
        for first in range(0, count, TOGETHER)
        for side in (0, 1)
        for shift in (window, -window)
    ]


def _onset_at(motion: Motion, g: Floats, side: int, shift: float, first: int, last: int) -> Floats:
    """Return the change of G over a window that has states at one of its ends, (3, k) [g/s].

    Between the states G is a broken line that may jump at the samples; its change over a
    fixed time is largest where the time begins or ends at a corner. A motion that is not
    longer than ``WINDOW`` is one window. A window from just after a sample ends just after
    what is there, and one from just before a sample just before it.
    """
    t, count, window = motion.t, len(motion.step), abs(shift)
    there = t[first + side : last + side] + shift
    after = np.clip(np.searchsorted(t, there), 1, count)
    sample = np.where(there - t[after - 1] < t[after] - there, t[after - 1], t[after])
    there = np.where(np.abs(there - sample) <= MEETS * window, sample, there)
    inside = (there >= t[0]) & (there <= t[-1])
    here = g[:, side * count + first : side * count + last]
    change = np.abs(_beside(t, g, there, side) - here) / window
    return np.where(inside, change, 0.0)


def _reach(motion: Motion, g: Floats) -> tuple[list[Window], Floats]:
    """Return the windows, and by how much G changes over none of some together, (w, 3) [g/s]."""
    t, count = motion.t, len(motion.step)
    starts = np.arange(0, count, TOGETHER)
    both = g[:, :count], g[:, count:]
    low = np.min([np.minimum.reduceat(each, starts, axis=1) for each in both], axis=0)
    high = np.max([np.maximum.reduceat(each, starts, axis=1) for each in both], axis=0)
    windows = _windows(motion)
    most = np.empty((len(windows), len(g)))
    for at, (side, shift, first, last) in enumerate(windows):
        slack = MEETS * abs(shift)
        ends = t[first + side] + shift - slack, t[last + side - 1] + shift + slack
        # One interval more on either side: a time on a sample is in both beside it.
        begin, end = np.searchsorted(t, ends).tolist()
        begin, end = (min(max(each, 0), count - 1) for each in (begin - 2, end + 1))
        there = slice(begin // TOGETHER, end // TOGETHER + 1)
        here = first // TOGETHER
        up = np.max(high[:, there], axis=1) - low[:, here]
        down = high[:, here] - np.min(low[:, there], axis=1)
        most[at] = np.maximum(up, down) / abs(shift)
    # What is no number has to be looked at.
    return windows, np.where(np.isnan(most), np.inf, most)


def _beside(t: Floats, g: Floats, times: Floats, side: int) -> Floats:
    """Return G (3, 2 (n - 1)) just after times, or with side 1 just before them, (3, k)."""
    count = len(t) - 1
    found = np.searchsorted(t, times, side="left" if side else "right") - 1
    interval = np.clip(found, 0, count - 1)
    part = np.clip((times - t[interval]) / (t[interval + 1] - t[interval]), 0.0, 1.0)
    start, end = g[:, interval], g[:, count + interval]
    return np.asarray(start + part * (end - start))
