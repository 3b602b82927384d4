"""How fast the G-vector sets in."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats

WINDOW = 0.1
"""Time [s] over which a change of G counts as one onset. A G that steps, as it does where
a joint's acceleration steps, has no derivative; over a fixed time its onset is a number
that does not depend on the grid. Nobody tells a rise over a tenth of a second from a step."""

BLOCK = 1024
"""Samples whose windows are looked at together."""

_SAME = 1e-6
"""Share of the window within which a sample is at its end: of samples that are a whole
fraction of it apart, rounding of their times is not to say whether a jump counts."""


def largest_onset(t: Floats, sides: Floats) -> Floats:
    """Return the largest onset of each component, (m,); see `onsets`.

    Of a long motion most windows need no look: within a block of samples, and where its
    windows end, a component stays between two values, and changes by no more.
    """
    blocks, bounds = _bounds(t, sides)
    largest, seen = np.zeros(sides.shape[2]), np.zeros(len(blocks), dtype=bool)
    for component, bound in enumerate(bounds.T):
        for at in np.argsort(-bound):
            if bound[at] <= largest[component]:
                break
            if not seen[at]:
                seen[at] = True
                _, onset = _changes(t, sides, *blocks[at])
                largest = np.maximum(largest, np.max(onset, axis=0, initial=0.0))
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
    found = [_changes(t, sides, *block) for block in _blocks(t)]
    begin, onset = (np.concatenate(each) for each in zip(*found, strict=True))
    order = np.argsort(begin, kind="stable")
    return begin[order], onset[order].T


def _blocks(t: Floats) -> list[tuple[float, slice]]:
    """Return what windows there are: their times from samples on, or back, and which samples."""
    window = min(WINDOW, float(t[-1] - t[0]))
    return [
        (shift, slice(first, min(first + BLOCK, len(t))))
        for shift in (window, -window)
        for first in range(0, len(t), BLOCK)
    ]


def _changes(t: Floats, sides: Floats, shift: float, samples: slice) -> tuple[Floats, Floats]:
    """Return first times (k,) and changes per second (k, m) of windows.

    The difference of two broken lines is largest where one of them has its corner: before
    a sample, or after it, and a window that lies a little earlier or later has both of its
    ends there.
    """
    window, here = abs(shift), t[samples]
    there = _at_samples(here + shift, t, _SAME * window)
    inside = (there >= t[0]) & (there <= t[-1])
    at = np.flatnonzero(inside) + samples.start
    here, there = here[inside], there[inside]
    after, before = _limits(t, sides, there)
    # The ends of the record have one side.
    after -= np.where((at == len(sides))[:, None], sides[-1, 1], sides[at - (at == len(sides)), 0])
    before -= np.where((at == 0)[:, None], sides[0, 0], sides[at - 1, 1])
    change = np.maximum(np.abs(after, out=after), np.abs(before, out=before))
    return np.minimum(here, there), change / window


def _bounds(t: Floats, sides: Floats) -> tuple[list[tuple[float, slice]], Floats]:
    """Return the blocks, and what no change per second in them exceeds, (b, m)."""
    edges = np.arange(0, len(sides), BLOCK)
    values = sides.reshape(-1, sides.shape[2])
    least, most = (pick.reduceat(values, 2 * edges, axis=0) for pick in (np.minimum, np.maximum))
    blocks = _blocks(t)
    bounds = np.empty((len(blocks), sides.shape[2]))
    for bound, (shift, samples) in zip(bounds, blocks, strict=True):
        near = _SAME * abs(shift)
        there = t[samples][[0, -1]] + shift + np.array([-near, near])
        # With the intervals beside, whose ends are the other sides of the samples.
        first, last = np.searchsorted(t, there).tolist()
        spans = (samples.start - 1, samples.stop), (first - 2, last + 1)
        (low, high), (other_low, other_high) = (
            (np.min(least[part], axis=0), np.max(most[part], axis=0))
            for part in (_blocks_of(*span, len(sides)) for span in spans)
        )
        bound[:] = np.maximum(high - other_low, other_high - low) / abs(shift)
    return blocks, np.where(np.isnan(bounds), np.inf, bounds)


def _blocks_of(first: int, last: int, intervals: int) -> slice:
    """Return the blocks that hold the intervals first to last, those that there are."""
    begin, end = (min(max(each, 0), intervals - 1) // BLOCK for each in (first, last))
    return slice(begin, end + 1)


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
