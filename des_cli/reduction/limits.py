"""The machine's limits, measured on a motion as the actuators would see it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, Machine
from des_cli.model.motion import Motion
from des_cli.model.run import Violation

TOLERANCE = 1e-9
"""Relative excess over a limit that rounding alone may make."""

STEP_TOLERANCE = 1e-9
"""A jump of the rate at a sample [rad/s] below which it is rounding, and no step."""

Which = Literal["desired", "modified"]


@dataclass(frozen=True)
class Peaks:
    """Largest magnitudes of a motion, (3,) each, for arm, fork and cab.

    ``acceleration`` leaves out the samples at which the rate steps: a finite
    difference across a step grows without bound as the grid is refined.
    ``rate_step`` is the largest step [rad/s].
    """

    angle: Floats
    rate: Floats
    acceleration: Floats
    rate_step: Floats


def measure_peaks(motion: Motion) -> Peaks:
    """Return the largest magnitudes of a motion."""
    return Peaks(
        angle=np.max(np.abs(motion.angle), axis=0),
        rate=np.max(np.abs(motion.rate_sides), axis=(0, 1)),
        acceleration=np.max(acceleration_magnitude(motion), axis=0),
        rate_step=np.max(np.abs(motion.rate_step), axis=0, initial=0.0),
    )


def acceleration_magnitude(motion: Motion) -> Floats:
    """Return the acceleration that the tables ask for at each sample, (n, 3) [rad/s^2].

    The larger of what the rates and what the positions say: the change of rate
    over the neighbouring intervals, and for the position-commanded fork and cab
    the second difference of the angle, which a rate that was estimated from a
    table of positions can hide.
    """
    by_rate = np.abs(motion.acceleration)
    magnitude = np.zeros_like(motion.angle)
    magnitude[:-1] = by_rate
    magnitude[1:] = np.maximum(magnitude[1:], by_rate)
    if len(motion.t) > 2:
        chord = np.diff(motion.angle, axis=0) / motion.step[:, None]
        apart = 0.5 * (motion.step[1:] + motion.step[:-1])[:, None]
        second = np.abs(np.diff(chord, axis=0) / apart)
        second[np.abs(motion.rate_step) > STEP_TOLERANCE] = 0.0
        second[:, 0] = 0.0  # the arm is commanded by its velocity
        magnitude[1:-1] = np.maximum(magnitude[1:-1], second)
    return magnitude


def find_violations(machine: Machine, motion: Motion, which: Which) -> tuple[Violation, ...]:
    """Name every limit that a motion breaks.

    Parameters
    ----------
    machine : Machine
    motion : Motion
    which : {"desired", "modified"}
        How the violations call the motion.
    """
    found: list[Violation] = []
    rate = np.zeros_like(motion.angle)
    rate[:-1] = np.abs(motion.rate_start)
    rate[1:] = np.maximum(rate[1:], np.abs(motion.rate_end))
    acceleration = acceleration_magnitude(motion)
    for j, (joint, limit) in enumerate(zip(JOINTS, machine.limits, strict=True)):
        step = np.zeros(len(motion.t))
        step[1:-1] = np.abs(motion.rate_step[:, j])
        # No finite acceleration makes a step: any step beyond rounding is named.
        for quantity, values, bound, allowed in (
            ("angle", np.abs(motion.angle[:, j]), limit.angle, limit.angle),
            ("rate", rate[:, j], limit.rate, limit.rate),
            ("acceleration", acceleration[:, j], limit.acceleration, limit.acceleration),
            ("rate step", step, 0.0, STEP_TOLERANCE),
        ):
            broken = np.flatnonzero(values > allowed * (1.0 + TOLERANCE))
            if len(broken):
                found.append(
                    Violation(
                        motion=which,
                        joint=joint,
                        quantity=quantity,  # type: ignore[arg-type]
                        peak=float(values.max()),
                        limit=bound,
                        from_s=float(motion.t[broken[0]]),
                        to_s=float(motion.t[broken[-1]]),
                    )
                )
    return tuple(found)
