"""Recorded joint angles without the jumps that a full turn makes of them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from des_cli.model.arrays import Floats

TURN = 2.0 * math.pi

NEAR_A_TURN = TURN / 8.0
"""How far from full turns a jump may be that is one of the numbers and not of the joint."""

FAST = TURN / 4.0
"""Usual change from row to row from which a jump cannot be told from the motion."""

SUDDEN = TURN
"""Rate [rad/s] that a step takes which is a jump of the numbers: a turn a second."""

ALONE = 10.0
"""How many times as long as the steps on either side such a step is."""

LEAST_STEPS = 3
"""Steps of a record up to which nothing is usual."""


@dataclass(frozen=True)
class Unwrapped:
    """A column of angles that turns without jumps.

    Parameters
    ----------
    angle : (n,) array
        [rad]
    jumps : list of int
        Rows before each jump that was taken out.
    unclear : list of int
        Rows before each jump that may be a wrapped angle or not.
    """

    angle: Floats
    jumps: list[int]
    unclear: list[int]


def unwrap(angle: Floats) -> Unwrapped:
    """Take full turns out of the steps of a recorded angle.

    A step of more than half a turn is not followed: near one or more full turns it is
    the number that wraps, and otherwise it is unclear. But a joint that usually turns by
    more than a quarter of a turn from row to row is taken by its word.

    Parameters
    ----------
    angle : (n,) array
        [rad]
    """
    step = np.diff(angle)
    jumping = np.abs(step) > 0.5 * TURN * (1.0 + 1e-9)
    if not jumping.any():
        return Unwrapped(angle, [], [])
    turns = np.where(jumping, np.round(step / TURN), 0.0) * TURN
    rest = step - turns
    # What wraps stays within a turn; what has gone further already counts its turns.
    within = float(np.ptp(angle)) <= 1.01 * TURN
    usual = float(np.median(np.abs(rest if within else step)))
    if len(step) >= LEAST_STEPS and usual > FAST:
        return Unwrapped(angle, [], [])
    unclear = jumping & (np.abs(rest) > NEAR_A_TURN)
    if len(step) < LEAST_STEPS:
        unclear = jumping
    smooth = angle.copy()
    smooth[1:] -= np.cumsum(turns)
    jumps, doubtful = (np.flatnonzero(each).tolist() for each in (jumping & ~unclear, unclear))
    return Unwrapped(smooth, jumps, doubtful)


def sudden_steps(t: Floats, angle: Floats) -> list[int]:
    """Return the rows before each step that stands alone and that no joint follows.

    Parameters
    ----------
    t : (n,) array
        Increasing times, n >= 2 [s].
    angle : (n,) array
        Without jumps by full turns [rad].
    """
    step = np.abs(np.diff(angle))
    if len(step) < LEAST_STEPS:
        return []
    beside = np.maximum(np.append(step[1:], 0.0), np.insert(step[:-1], 0, 0.0))
    sudden = (step > SUDDEN * np.diff(t)) & (step > ALONE * beside)
    return [int(row) for row in np.flatnonzero(sudden)]
