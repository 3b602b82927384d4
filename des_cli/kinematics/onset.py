"""How fast the G-vector sets in."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats

WINDOW = 0.1
"""Time [s] over which a change of G counts as one onset. A G that steps, as it does where
a joint's acceleration steps, has no derivative; over a fixed time its onset is a number
that does not depend on the grid. Nobody tells a rise over a tenth of a second from a step."""

_BESIDE = 1e-9
"""Share of the longest interval by which the ends of each are drawn in, so that a jump at a
sample is a steep piece of one broken line."""

_SAME = 1e-6
"""Share of the window within which a sample is at its end: of samples that are a whole
fraction of it apart, rounding of their times is not to say whether a jump counts."""


def largest_onset(t: Floats, sides: Floats) -> Floats:
    """Return the largest onset of each component, (m,); see `onsets`."""
    return np.asarray(np.max(onsets(t, sides)[1], axis=1))


def onsets(t: Floats, sides: Floats) -> tuple[Floats, Floats]:
    """Return the change of each component over ``WINDOW``, per second.

    Parameters
    ----------
    t : (n,) array
        Sample times [s].
    sides : (n - 1, 2, m) array
        Values at both ends of every interval, between which they are taken for
        linear; where the two sides of a sample differ they jump.

    Returns
    -------
    begin : (k,) array
        The windows' first times, increasing [s]: all at which a change can be largest.
        A maneuver shorter than the window is one window.
    onset : (m, k) array
        Magnitudes, in the unit of ``sides`` per second.
    """
    window = min(WINDOW, float(t[-1] - t[0]))
    step = np.diff(t)
    beside = min(_BESIDE * float(np.max(step)), 0.25 * float(np.min(step)))
    knots = np.stack([t[:-1] + beside, t[1:] - beside], axis=1).ravel()
    values = sides.reshape(len(knots), -1)
    # The difference of two broken lines is largest where one of them has its corner: before
    # a sample, or after it, and a window that lies a little earlier or later has both of its
    # ends there.
    begin = np.concatenate([t, _at_samples(t - window, t, _SAME * window)])
    end = np.concatenate([_at_samples(t + window, t, _SAME * window), t])
    inside = (begin >= t[0]) & (end <= t[-1])
    order = np.argsort(begin[inside], kind="stable")
    begin, end = begin[inside][order], end[inside][order]
    change = [
        [
            np.interp(end + side, knots, component) - np.interp(begin + side, knots, component)
            for side in (beside, -beside)
        ]
        for component in values.T
    ]
    return begin, np.max(np.abs(change), axis=1) / window


def _at_samples(times: Floats, t: Floats, near: float) -> Floats:
    """Return times, those that are near a sample as the sample's own."""
    after = np.clip(np.searchsorted(t, times), 1, len(t) - 1)
    nearest = np.where(times - t[after - 1] < t[after] - times, t[after - 1], t[after])
    return np.where(np.abs(times - nearest) <= near, nearest, times)
