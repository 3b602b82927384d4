"""Joint angles from body rates: Runge-Kutta of order four in the field of joint rates."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from des_cli.kinematics.orientation import SINGULAR_VALUE_THRESHOLD
from des_cli.kinematics.rate_field import RateField, Triple
from des_cli.model.arrays import Floats
from des_cli.model.profile import BodyRates

LONGEST_TURN = 0.1
"""Joint angle per Runge-Kutta step [rad], times the smallest singular value: with
it one step's error stays below 1e-8 rad away from the singularity."""

MOST_SUBSTEPS = 64
"""Runge-Kutta steps in one interval, at the most."""


def integrate_joints(field: RateField, step: Floats, command: BodyRates, initial: Floats) -> Floats:
    """Integrate the joint angles, in shorter steps where they turn fast.

    Parameters
    ----------
    field : RateField
    step : (n - 1,) array
        [s]
    command : BodyRates
    initial : (3,) array
        Angles of arm, fork and cab at the first sample [rad].

    Returns
    -------
    (n, 3) array
        [rad]
    """
    demands = [command.start, command.middle, command.end]
    fastest = np.max(np.abs(demands), axis=(0, 2))
    powers = command.powers.reshape(-1, 12)
    arm, fork, cab = (float(each) for each in initial)
    angles = [(arm, fork, cab)]
    # Plain floats: one step hangs on the one before, and numpy is slow on three numbers.
    for h, demand, cubic in zip(step.tolist(), fastest.tolist(), powers.tolist(), strict=True):
        first, determinant = field.at(fork, cab, _rates(cubic, 0.0))
        turning = max(abs(first[0]), abs(first[1]), abs(first[2]), demand)
        turn = LONGEST_TURN * max(determinant, SINGULAR_VALUE_THRESHOLD)
        count = min(MOST_SUBSTEPS, max(1, math.ceil(h * turning / turn)))
        dt = h / count
        for part in range(count):
            a, b = part / count, (part + 1) / count
            middle = _rates(cubic, 0.5 * (a + b))
            k1 = first if part == 0 else field.at(fork, cab, _rates(cubic, a))[0]
            half = 0.5 * dt
            k2 = field.at(fork + half * k1[1], cab + half * k1[2], middle)[0]
            k3 = field.at(fork + half * k2[1], cab + half * k2[2], middle)[0]
            k4 = field.at(fork + dt * k3[1], cab + dt * k3[2], _rates(cubic, b))[0]
            sixth = dt / 6.0
            arm += sixth * (k1[0] + 2.0 * (k2[0] + k3[0]) + k4[0])
            fork += sixth * (k1[1] + 2.0 * (k2[1] + k3[1]) + k4[1])
            cab += sixth * (k1[2] + 2.0 * (k2[2] + k3[2]) + k4[2])
        angles.append((arm, fork, cab))
    return np.array(angles)


def _rates(cubic: Sequence[float], s: float) -> Triple:
    """Evaluate the rates at a part of an interval, from their coefficients by power."""
    p0, q0, r0, p1, q1, r1, p2, q2, r2, p3, q3, r3 = cubic
    return (
        p0 + s * (p1 + s * (p2 + s * p3)),
        q0 + s * (q1 + s * (q2 + s * q3)),
        r0 + s * (r1 + s * (r2 + s * r3)),
    )
