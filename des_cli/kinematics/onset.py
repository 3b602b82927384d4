"""How fast the G-vector sets in."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats

WINDOW = 0.1
"""Time [s] over which a change of G counts as one onset. A G that steps, as it does where
a joint's acceleration steps, has no derivative; over a fixed time its onset is a number
that does not depend on the grid. Nobody tells a rise over a tenth of a second from a step."""

_BESIDE = 1e-9
"""Share of an interval by which its ends are drawn in, so that a jump at a sample is a
steep piece of one broken line."""


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
    beside = _BESIDE * np.diff(t)
    knots = np.stack([t[:-1] + beside, t[1:] - beside], axis=1).ravel()
    values = sides.reshape(len(knots), -1)
    # The difference of two broken lines is largest where one of them has its corner.
    corners = np.sort(np.concatenate([knots, knots - window]))
    begin = corners[(corners >= t[0]) & (corners + window <= t[-1])]
    begin = begin if len(begin) else t[:1]
    change = [
        np.interp(begin + window, knots, component) - np.interp(begin, knots, component)
        for component in values.T
    ]
    return begin, np.abs(change) / window
