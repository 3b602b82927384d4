"""What a gap between samples is."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats

GAP_PER_MEDIAN = 10.0
"""Steps over the median step from which samples are missing: a recorder that is busy
doubles its step now and then, and seven times it was seen on a flight controller."""

SHORTEST_GAP = 0.1
"""Time [s] up to which no step is a gap: a joint inside its limits does nothing there
that the samples on either side do not tell."""


def longest_step(t: Floats) -> float:
    """Return the longest step between samples (n,) that is no gap [s]."""
    return max(GAP_PER_MEDIAN * float(np.median(np.diff(t))), SHORTEST_GAP)


def find_gaps(t: Floats) -> list[int]:
    """Return the rows before each gap of samples (n,), n >= 2."""
    return [int(row) for row in np.flatnonzero(np.diff(t) > longest_step(t) * (1.0 + 1e-9))]
