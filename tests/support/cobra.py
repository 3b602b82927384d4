"""The Cobra, the study's (34)-(37), as formulas that share no code with the tool."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

# (angle, rate, acceleration), each (n, 3), at instants (n,) inside an interval
States = tuple[Floats, Floats, Floats]

COBRA_S = 10.0
COBRA_STEP_S = 5.0  # the arm's acceleration and the cab's rate jump here
RPM = 2 * math.pi / 60


def cobra(t: ArrayLike, *, late: ArrayLike | None = None, reach_deg: float = 60.0) -> States:
    """Return angles, rates and accelerations, (..., 3); the arm starts at 0 rad.

    ``late`` tells which instants belong to the second half, where the instant of the join is
    among them. The fork swings out to twice ``reach_deg``.
    """
    t = np.asarray(t, dtype=float)
    s = t - COBRA_STEP_S
    side = np.where(s >= 0 if late is None else late, 1.0, -1.0) + 0 * t
    w = math.pi / 5
    turned = 8.8 * COBRA_STEP_S - 0.33 * COBRA_STEP_S**2
    arm = turned + 5.5 * s + 0.33 * side * s**2
    fork = -reach_deg * (1 - np.cos(w * t))
    cab = 17.5 + 2.5 * side * s
    fork_rate, fork_acceleration = -reach_deg * w * np.sin(w * t), -reach_deg * w**2 * np.cos(w * t)
    scale = np.array([RPM, math.radians(1), math.radians(1)])
    return (
        np.stack([arm, fork, cab], axis=-1) * scale,
        np.stack([5.5 + 0.66 * side * s, fork_rate, 2.5 * side], axis=-1) * scale,
        np.stack([0.66 * side, fork_acceleration, 0 * t], axis=-1) * scale,
    )


def cobra_intervals(t: Floats, *, reach_deg: float = 60.0) -> tuple[Floats, Floats, Floats]:
    """Angles at samples, (n, 3), and rates at the two ends of every interval, (n - 1, 3) each."""
    late = t[:-1] > COBRA_STEP_S - 1e-9
    return (
        cobra(t, reach_deg=reach_deg)[0],
        cobra(t[:-1], late=late, reach_deg=reach_deg)[1],
        cobra(t[1:], late=late, reach_deg=reach_deg)[1],
    )
