"""Rates between recorded samples: what a table says about the motion between its rows."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats


def rates_of_positions(t: Floats, position: Floats) -> Floats:
    """Estimate rates at samples by the three-point formula.

    The derivative of the parabola through a sample and its two neighbours; at
    the ends that of the parabola through the last three. Second order on any
    grid, exact for parabolas.

    Parameters
    ----------
    t : (n,) array
        Increasing times, n >= 2 [s].
    position : (n, k) array

    Returns
    -------
    (n, k) array
        Rate at each sample; of two samples, the rate of the chord.
    """
    step = np.diff(t)[:, None]
    chord = np.diff(position, axis=0) / step
    if len(t) == 2:
        return np.repeat(chord, 2, axis=0)
    rate = np.empty_like(position)
    before, after = step[:-1], step[1:]
    rate[1:-1] = (after * chord[:-1] + before * chord[1:]) / (before + after)
    # The parabola's slope is linear: a chord is its slope in the middle of the interval.
    rate[0] = 2.0 * chord[0] - rate[1]
    rate[-1] = 2.0 * chord[-1] - rate[-2]
    return rate


def middles_of_samples(t: Floats, value: Floats) -> Floats:
    """Interpolate values in the middle of every interval.

    By the cubic through the two samples on either side; in the first and last
    interval by the cubic through the nearest four (a parabola of three
    samples, a line of two). Fourth order on smooth data, on any grid.

    Parameters
    ----------
    t : (n,) array
        Increasing times, n >= 2 [s].
    value : (n, k) array

    Returns
    -------
    (n - 1, k) array
    """
    n = len(t)
    width = min(4, n)
    first = np.clip(np.arange(n - 1) - 1, 0, n - width)
    nodes = first[:, None] + np.arange(width)
    middle = 0.5 * (t[:-1] + t[1:])
    # Times relative to the middle: late starts must not cost digits.
    x = t[nodes] - middle[:, None]
    result = np.zeros((n - 1, value.shape[1]))
    for j in range(width):
        weight = np.ones(n - 1)
        for k in range(width):
            if k != j:
                weight *= x[:, k] / (x[:, k] - x[:, j])
        result += weight[:, None] * value[nodes[:, j]]
    return result
