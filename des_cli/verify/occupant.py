"""The bounds on what the occupant gets, measured on a motion as its tables play it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import OccupantBounds
from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.verify.felt import CHUNK, Felt

WINDOW = 0.1
"""Time [s] over which a change of G is an onset; see the nomenclature."""

MEETS = 1e-6
"""Share of the window within which its other end meets a sample, whatever rounding says."""

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
    """Return the largest change of each component of G over ``WINDOW``, (3,) [g/s]."""
    largest = np.zeros(len(felt.g))
    for _, onset in _onset_blocks(motion, felt):
        np.maximum(largest, np.max(onset, axis=1), out=largest)
    return largest


def _onset(motion: Motion, felt: Felt) -> Floats:
    """Return the change of G over ``WINDOW`` that begins or ends at each state, (3, m) [g/s]."""
    onset = np.zeros_like(felt.g)
    for states, change in _onset_blocks(motion, felt):
        np.maximum(onset[:, states], change, out=onset[:, states])
    return onset


def _onset_blocks(motion: Motion, felt: Felt) -> Iterator[tuple[slice, Floats]]:
    """Yield states with the change of G over a window that has them at one of its ends, (3, k).

    Between the states G is a broken line that may jump at the samples; its change over a
    fixed time is largest where the time begins or ends at a corner. A motion that is not
    longer than ``WINDOW`` is one window. A window from just after a sample ends just after
    what is there, and one from just before a sample just before it.
    """
    t, count = motion.t, len(motion.step)
    window = min(WINDOW, float(t[-1] - t[0]))
    middles = 0.5 * (t[1:] + t[:-1])
    for first in range(0, count, CHUNK):
        last = min(first + CHUNK, count)
        for side, shift in ((0, window), (0, -window), (1, window), (1, -window)):
            there = t[first + side : last + side] + shift
            sample = t[np.searchsorted(middles, there)]
            there = np.where(np.abs(there - sample) <= MEETS * window, sample, there)
            inside = (there >= t[0]) & (there <= t[-1])
            states = slice(side * count + first, side * count + last)
            change = np.abs(_beside(t, felt.g, there, side) - felt.g[:, states]) / window
            yield states, np.where(inside, change, 0.0)


def _beside(t: Floats, g: Floats, times: Floats, side: int) -> Floats:
    """Return G (3, 2 (n - 1)) just after times, or with side 1 just before them, (3, k)."""
    count = len(t) - 1
    found = np.searchsorted(t, times, side="left" if side else "right") - 1
    interval = np.clip(found, 0, count - 1)
    part = np.clip((times - t[interval]) / (t[interval + 1] - t[interval]), 0.0, 1.0)
    start, end = g[:, interval], g[:, count + interval]
    return np.asarray(start + part * (end - start))
