"""How fast the G-vector sets in."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.motion import PIECE

WINDOW = 0.1
"""Time [s] over which a change of G counts as one onset. A G that steps, as it does where
a joint's acceleration steps, has no derivative; over a fixed time its onset is a number
that does not depend on the grid. Nobody tells a rise over a tenth of a second from a step."""

_SAME = 1e-6
"""Share of the window within which a sample is at its end: of samples that are a whole
fraction of it apart, rounding of their times is not to say whether a jump counts."""


def largest_onset(t: Floats, sides: Floats) -> Floats:
    """Return the largest onset of each component, (m,); see `onsets`."""
    largest = np.zeros(sides.shape[2])
    for _, onset in _blocks(t, sides):
        np.maximum(largest, np.max(onset, axis=0, initial=0.0), out=largest)
    return largest


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
    begin, onset = (np.concatenate(each) for each in zip(*_blocks(t, sides), strict=True))
    order = np.argsort(begin, kind="stable")
    return begin[order], onset[order].T


def _blocks(t: Floats, sides: Floats) -> Iterator[tuple[Floats, Floats]]:
    """Yield first times (k,) and changes per second (k, m) of windows, block by block.

    The difference of two broken lines is largest where one of them has its corner: before
    a sample, or after it, and a window that lies a little earlier or later has both of its
    ends there.
    """
    window = min(WINDOW, float(t[-1] - t[0]))
    for shift in (window, -window):
        for first in range(0, len(t), PIECE):
            here = t[first : first + PIECE]
            there = _at_samples(here + shift, t, _SAME * window)
            inside = (there >= t[0]) & (there <= t[-1])
            here, there = here[inside], there[inside]
            changes = [
                np.abs(one - other)
                for one, other in zip(
                    _limits(t, sides, there), _limits(t, sides, here), strict=True
                )
            ]
            yield np.minimum(here, there), np.maximum(*changes) / window


def _limits(t: Floats, sides: Floats, times: Floats) -> tuple[Floats, Floats]:
    """Return the values just after and just before times, (k, m) each."""
    at = np.clip(np.searchsorted(t, times, side="right") - 1, 0, len(t) - 2)
    share = (times - t[at]) / (t[at + 1] - t[at])
    after = sides[at, 0] + share[:, None] * (sides[at, 1] - sides[at, 0])
    before = after.copy()
    # On a sample what is before it belongs to another interval, but at the very start.
    on = (share == 0.0) & (at > 0)
    before[on] = sides[at[on] - 1, 1]
    return after, before


def _at_samples(times: Floats, t: Floats, near: float) -> Floats:
    """Return times, those that are near a sample as the sample's own."""
    after = np.clip(np.searchsorted(t, times), 1, len(t) - 1)
    nearest = np.where(times - t[after - 1] < t[after] - times, t[after - 1], t[after])
    return np.where(np.abs(times - nearest) <= near, nearest, times)
