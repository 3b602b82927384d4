"""How hard and how smoothly a motion drives the joints."""

from __future__ import annotations

import math

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.loads import JointLoad
from des_cli.model.machine import JOINTS, Joint, Machine
from des_cli.model.motion import Motion
from des_cli.model.run import Violation
from des_cli.reduction.limits import jerk_at_samples, measure_peaks

AT_LIMIT = 0.99
"""Share of the acceleration limit from which a joint counts as being at it."""

IDLE = 0.01
"""Share of the acceleration limit below which an acceleration has no sign: what is left of
it there is rounding, or a joint that coasts."""


def joint_metrics(
    machine: Machine, motion: Motion, which: str, violations: tuple[Violation, ...]
) -> dict[Joint, JointLoad]:
    """Return peaks beside limits, for each joint.

    Parameters
    ----------
    machine : Machine
    motion : Motion
    which : {"desired", "modified"}
        How the violations call the motion.
    violations : tuple of Violation

    Returns
    -------
    dict
        By joint; a limit that the machine does not have is None.
    """
    peaks = measure_peaks(motion)
    limit = np.array([joint.acceleration for joint in machine.limits])
    jerk, time = np.zeros(len(JOINTS)), np.zeros(len(JOINTS))
    for piece in motion.pieces():
        part = piece.motion
        np.maximum(jerk, np.max(np.abs(jerk_at_samples(part)[piece.own]), axis=0), out=jerk)
        full = np.abs(part.acceleration[piece.own_intervals]) >= AT_LIMIT * limit
        time += part.step[piece.own_intervals] @ full
    share = time / motion.step.sum()
    changes = sign_changes(motion.acceleration, IDLE * limit)
    broken = {v.joint for v in violations if v.motion == which}
    return {
        joint: JointLoad(
            rate_peak_rad_s=float(peaks.rate[j]),
            rate_limit_rad_s=finite(machine.limits[j].rate),
            acceleration_peak_rad_s2=float(peaks.acceleration[j]),
            acceleration_limit_rad_s2=finite(machine.limits[j].acceleration),
            jerk_peak_rad_s3=float(jerk[j]),
            jerk_limit_rad_s3=finite(machine.limits[j].jerk),
            rate_step_rad_s=float(peaks.rate_step[j]),
            at_acceleration_limit=float(share[j]),
            acceleration_sign_changes=int(changes[j]),
            ok=joint not in broken,
        )
        for j, joint in enumerate(JOINTS)
    }


def sign_changes(acceleration: Floats, least: Floats) -> list[int]:
    """Count how often each joint's acceleration changes its sign.

    Parameters
    ----------
    acceleration : (m, 3) array
        [rad/s^2]
    least : (3,) array
        Intervals at or below this magnitude have no sign and are passed over.
    """
    counts = []
    for values, floor in zip(acceleration.T, least, strict=True):
        signs = np.sign(values[np.abs(values) > (floor if np.isfinite(floor) else 0.0)])
        counts.append(int(np.sum(signs[1:] != signs[:-1])))
    return counts


def finite(limit: float) -> float | None:
    """Return a limit, None where there is none: JSON has no infinity."""
    return limit if math.isfinite(limit) else None
