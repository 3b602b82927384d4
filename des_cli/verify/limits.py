"""The machine's limits, measured on a motion as its tables play it."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS
from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.verify.claim import Claim

LIMIT_TOLERANCE = 1e-9
"""Relative excess over a limit that rounding alone may make."""

STEP_TOLERANCE = 1e-9
"""A jump of the rate at a sample [rad/s] below which it is rounding, and no step."""

RATE_ROUNDING = 16.0 * float(np.finfo(np.float64).eps)
"""Relative rounding of a difference of three rates; a jerk divides it by the step squared."""


QUANTITIES = ("angle", "rate", "acceleration", "jerk")
"""What a joint has limits of."""


def check_limits(claim: Claim) -> list[Check]:
    """Measure the table against every limit, as the relative excess."""
    if not claim.enforced:
        return []
    found = {quantity: np.zeros(len(JOINTS)) for quantity in (*QUANTITIES, "rate_step")}
    for piece in claim.table.pieces():
        # Where a piece ends its samples lack neighbours, and are the next one's too.
        here = magnitudes(piece.motion)
        here["jerk"] -= _jerk_rounding(piece.motion)
        here["rate_step"] = np.abs(piece.motion.rate_step)
        for quantity, values in here.items():
            largest = np.max(values, axis=0, initial=0.0)
            found[quantity] = np.maximum(found[quantity], largest)
    checks = []
    for j, (joint, limit) in enumerate(zip(JOINTS, claim.profile.machine.limits, strict=True)):
        for quantity in QUANTITIES:
            bound = getattr(limit, quantity)
            if np.isfinite(bound):
                checks.append(
                    Check(
                        f"limits.{joint}.{quantity}",
                        f"relative excess of the {joint}'s {quantity} over its limit",
                        float(found[quantity][j]) / bound - 1.0,
                        LIMIT_TOLERANCE,
                    )
                )
        checks.append(
            Check(
                f"limits.{joint}.rate_step",
                f"largest step of the {joint}'s rate [rad/s]",
                float(found["rate_step"][j]),
                STEP_TOLERANCE,
            )
        )
    return checks


def magnitudes(motion: Motion) -> dict[str, Floats]:
    """Return the largest magnitudes next to each sample, (n, 3) each, by quantity.

    An angle also between the sample and the next: where the rate changes its sign the
    parabola has its extremum there.
    """
    rate = np.zeros_like(motion.angle)
    rate[:-1] = np.abs(motion.rate_start)
    rate[1:] = np.maximum(rate[1:], np.abs(motion.rate_end))
    acceleration = np.zeros_like(motion.angle)
    acceleration[:-1] = np.abs(motion.acceleration)
    acceleration[1:] = np.maximum(acceleration[1:], np.abs(motion.acceleration))
    jerk = np.zeros_like(motion.angle)
    jerk[1:-1] = np.abs(motion.jerk)
    return {
        "angle": _angle(motion),
        "rate": rate,
        "acceleration": acceleration,
        "jerk": jerk,
    }


def _angle(motion: Motion) -> Floats:
    """Return the largest angle from each sample to the next, (n, 3) [rad]."""
    angle = np.abs(motion.angle)
    turns = motion.rate_start * motion.rate_end < 0.0
    slope = np.where(turns, motion.acceleration, 1.0)
    extremum = np.abs(motion.angle[:-1] - 0.5 * motion.rate_start**2 / slope)
    angle[:-1] = np.maximum(angle[:-1], np.where(turns, extremum, 0.0))
    return angle


def _jerk_rounding(motion: Motion) -> Floats:
    """Return how much of each sample's jerk may be rounding of doubles, (n, 3) [rad/s^3].

    The rates of a modified motion are its own, each right to a few units in the last
    place; their second difference over the step squared is not.
    """
    allowance = np.zeros_like(motion.angle)
    step = np.minimum(motion.step[1:], motion.step[:-1])[:, None]
    rate = np.maximum(np.abs(motion.rate_start), np.abs(motion.rate_end))
    allowance[1:-1] = RATE_ROUNDING * np.maximum(rate[1:], rate[:-1]) / step**2
    return allowance
