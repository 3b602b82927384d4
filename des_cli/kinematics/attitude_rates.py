"""Body rates of a recorded attitude: what turns the body through every row of it."""

from __future__ import annotations

import math

import numpy as np

from des_cli.kinematics.attitude import geodesic_angle, integrate_attitude
from des_cli.model.arrays import Floats, Indices
from des_cli.model.profile import BodyRates

CLOSENESS = math.radians(0.01)
"""How far the integrated rates may be from the recorded attitude, at any row [rad]."""

LARGEST_TURN = math.radians(90.0)
"""Turn from one row to the next up to which a record tells which way it went [rad]."""

_ROUNDS = 8
"""Rounds of inserting rows; each brings the error down to what is allowed, or nearly."""

_MOST_PARTS = 64
"""Parts of an interval at the most: its error falls with the fourth power of them."""


def rates_of_attitude(t: Floats, attitude: Floats) -> tuple[Floats, BodyRates]:
    """Return body rates that integrate to a recorded attitude.

    The attitude between the rows is scipy's rotation spline: it goes through
    every row, with continuous rates and accelerations. Where rows are so far
    apart that the parabola through the rates at start, middle and end of the
    interval misses the next row, rows are inserted from the spline.

    Parameters
    ----------
    t : (n,) array
        Increasing times, n >= 2 [s].
    attitude : (n, 4) array
        Unit quaternions (w, x, y, z), body to inertial, of either sign.

    Returns
    -------
    t : (m,) array
        The times with those of the inserted rows, m >= n [s].
    rates : BodyRates
        In the body's axes [rad/s]. Its attitude is the recorded one, not a number
        in inserted rows. Integrated, it is nowhere further from the recorded one
        than `CLOSENESS`.
    """
    from scipy.spatial.transform import Rotation, RotationSpline

    since = t - t[0]
    rotations = Rotation.from_quat(attitude[:, [1, 2, 3, 0]])
    spline = RotationSpline(since, rotations)
    recorded = rotations.as_matrix()
    turned = np.swapaxes(recorded[:-1], 1, 2) @ recorded[1:]
    parts = np.ones(len(t) - 1, dtype=np.intp)
    for _ in range(_ROUNDS):
        grid, rows = _divided(since, parts)
        rates = _sampled(spline, grid)
        error = _errors(grid, rates, rows, turned)
        # Errors of intervals add up at the worst: each gets its share of the time.
        allowed = CLOSENESS * np.diff(since) / since[-1]
        over = (error > allowed) & (parts < _MOST_PARTS)
        if not np.any(over):
            break
        growth = np.ceil((error[over] / allowed[over]) ** 0.25 * 1.05)
        parts[over] = np.minimum(_MOST_PARTS, np.maximum(parts[over] + 1, parts[over] * growth))
    kept = np.full((len(grid), 4), np.nan)
    kept[rows] = attitude
    times = t[0] + grid
    times[rows] = t
    return times, BodyRates(rates.start, rates.middle, rates.end, kept)


def turns_between(attitude: Floats) -> Floats:
    """Return the angle from each row of an attitude to the next.

    Parameters
    ----------
    attitude : (n, 4) array
        Unit quaternions of either sign.

    Returns
    -------
    (n - 1,) array
        [rad], at most pi.
    """
    alike = np.abs(np.sum(attitude[:-1] * attitude[1:], axis=1))
    return np.asarray(2.0 * np.arccos(np.minimum(alike, 1.0)))


def _divided(since: Floats, parts: Indices) -> tuple[Floats, Indices]:
    """Divide every interval into equal parts; return the times and where the rows are."""
    rows = np.concatenate([[0], np.cumsum(parts)])
    step = np.repeat(np.diff(since) / parts, parts)
    within = np.arange(rows[-1]) - np.repeat(rows[:-1], parts)
    grid = np.append(np.repeat(since[:-1], parts) + within * step, since[-1])
    return grid, np.asarray(rows, dtype=np.intp)


def _sampled(spline: object, grid: Floats) -> BodyRates:
    """Return the spline's body rates at start, middle and end of the intervals of a grid."""
    assert callable(spline)
    at = np.asarray(spline(grid, 1), dtype=np.float64)
    middle = np.asarray(spline(0.5 * (grid[:-1] + grid[1:]), 1), dtype=np.float64)
    return BodyRates(at[:-1], middle, at[1:])


def _errors(grid: Floats, rates: BodyRates, rows: Indices, turned: Floats) -> Floats:
    """Return how far the rates of each recorded interval miss its turn, (n - 1,) [rad]."""
    integrated = integrate_attitude(np.diff(grid), rates)[rows]
    found = np.swapaxes(integrated[:-1], 1, 2) @ integrated[1:]
    return geodesic_angle(found, turned)
