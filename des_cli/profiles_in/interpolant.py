"""Rates between recorded samples: a cubic that never leaves its neighbours' range.

A cubic through four samples swings far out of them where their distances differ: over
a gap of five seconds it made 5 rad/s of two samples of 0.02. The monotone piecewise
cubic of Fritsch and Butland (SIAM J. Sci. Stat. Comput. 5, 1984), known as PCHIP, stays
between the two samples on either side whatever the distances are.
"""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.profile import BodyRates


def body_rates_of_samples(t: Floats, rates: Floats, attitude: Floats | None = None) -> BodyRates:
    """Interpolate recorded body rates.

    Parameters
    ----------
    t : (n,) array
        Increasing times, n >= 2 [s].
    rates : (n, 3) array
        p, q, r [rad/s].
    attitude : (n, 4) array, optional
        Recorded quaternions, as `BodyRates` keeps them.
    """
    step = np.diff(t)[:, None]
    slope = monotone_slopes(t, rates)
    start, end = rates[:-1], rates[1:]
    rise, first, last = end - start, step * slope[:-1], step * slope[1:]
    return BodyRates(
        start=start,
        middle=0.5 * (start + end) + 0.125 * (first - last),
        end=end,
        attitude=attitude,
        skew=0.5 * (first + last) - rise,
    )


def monotone_slopes(t: Floats, value: Floats) -> Floats:
    """Return the slopes at samples with which a piecewise cubic is monotone between them.

    Inside the weighted harmonic mean of the slopes of the two chords, which is at most
    three times the smaller; zero where the chords go opposite ways, so that an extremum
    of the samples is one of the curve. At the ends the slope of the parabola through
    three samples, held back to what keeps the interval monotone.

    Parameters
    ----------
    t : (n,) array
        Increasing times, n >= 2 [s].
    value : (n, k) array

    Returns
    -------
    (n, k) array
        [1/s]
    """
    step = np.diff(t)[:, None]
    chord = np.diff(value, axis=0) / step
    if len(t) == 2:
        return np.repeat(chord, 2, axis=0)
    slope = np.zeros_like(value)
    before, after = chord[:-1], chord[1:]
    same = np.sign(before) * np.sign(after) > 0.0
    w_before, w_after = step[:-1] + 2.0 * step[1:], 2.0 * step[:-1] + step[1:]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        mean = (w_before + w_after) / (w_before / before + w_after / after)
    slope[1:-1][same] = mean[same]
    slope[0] = _end_slope(step[0], step[1], chord[0], chord[1])
    slope[-1] = _end_slope(step[-1], step[-2], chord[-1], chord[-2])
    return slope


def _end_slope(near: Floats, next_: Floats, chord: Floats, further: Floats) -> Floats:
    """Return the slope at an end, by the chords of the first two intervals from there."""
    slope = ((2.0 * near + next_) * chord - near * further) / (near + next_)
    slope = np.where(np.sign(slope) == np.sign(chord), slope, 0.0)
    steep = (np.sign(chord) != np.sign(further)) & (np.abs(slope) > 3.0 * np.abs(chord))
    return np.where(steep, 3.0 * chord, slope)
