"""The motion that fidelity is measured against, between its samples."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.motion import Motion


def sample_motion(motion: Motion, t: Floats) -> tuple[Floats, Floats, Floats]:
    """Return a motion's angles, rates and accelerations at any times.

    By the cubic on each interval that has the angles and rates at both of its ends:
    where the rates are linear and the angles their integral it is that parabola, and
    where they are samples of something smooth it is of the fourth order.

    Parameters
    ----------
    motion : Motion
    t : (q,) array
        Times inside the motion [s].

    Returns
    -------
    angle, rate, acceleration : (q, 3) array
        [rad], [rad/s], [rad/s^2]; at a sample, of the interval that begins there.
    """
    k = np.clip(np.searchsorted(motion.t, t, side="right") - 1, 0, len(motion.t) - 2)
    h = motion.step[k][:, None]
    u = (np.asarray(t) - motion.t[k])[:, None] / h
    first, rise = motion.angle[k], motion.angle[k + 1] - motion.angle[k]
    r0, r1 = h * motion.rate_start[k], h * motion.rate_end[k]
    square, cube = 3.0 * rise - 2.0 * r0 - r1, r0 + r1 - 2.0 * rise
    angle = first + u * (r0 + u * (square + u * cube))
    rate = (r0 + u * (2.0 * square + 3.0 * u * cube)) / h
    acceleration = (2.0 * square + 6.0 * u * cube) / h**2
    return angle, rate, acceleration


def sample_sides(t: Floats, sides: Floats, times: Floats) -> Floats:
    """Return values that are linear over each interval at any times, (q, 3).

    Parameters
    ----------
    t : (n,) array
        Samples [s].
    sides : (n - 1, 2, 3) array
        At both ends of every interval.
    times : (q,) array
        [s]
    """
    k = np.clip(np.searchsorted(t, times, side="right") - 1, 0, len(t) - 2)
    u = ((times - t[k]) / (t[k + 1] - t[k]))[:, None]
    return np.asarray((1.0 - u) * sides[k, 0] + u * sides[k, 1])
