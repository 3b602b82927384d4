"""What the pilot feels, before and after: the section ``felt`` of the metrics."""

from __future__ import annotations

from typing import get_args

import numpy as np

from des_cli.kinematics.onset import largest_onset
from des_cli.model.arrays import Floats, inner, length
from des_cli.model.felt import (
    G_AXES,
    Felt,
    GAxis,
    GSizes,
    RateAxis,
    RateSizes,
    TurningAxis,
    TurningSizes,
)
from des_cli.model.motion import Motion, integrate_sides
from des_cli.model.response import SeatResponse

WEIGHTLESS = 0.1
"""Size of the G-vector [g] below which it has no direction worth an angle: there the
pilot has no down that could tilt, and a small error would turn it right round."""


def felt_metrics(motion: Motion, before: SeatResponse, after: SeatResponse) -> Felt:
    """Return sizes of the seat's rate, of its angular acceleration and of the G-vector.

    Parameters
    ----------
    motion : Motion
        Gives the sample times.
    before, after : SeatResponse
    """
    rates = _sizes(motion.step, before.seat_rate, after.seat_rate)
    turning = _sizes(motion.step, before.seat_angular_acceleration, after.seat_angular_acceleration)
    return Felt(
        seat_rate={
            axis: RateSizes(*each) for axis, each in zip(get_args(RateAxis), rates, strict=True)
        },
        seat_angular_acceleration={
            axis: TurningSizes(*each)
            for axis, each in zip(get_args(TurningAxis), turning, strict=True)
        },
        seat_g=_g_by_axis(motion, before.seat_g, after.seat_g),
    )


def tilt_error(step: Floats, before: Floats, after: Floats) -> tuple[float | None, float | None]:
    """Return the angle between two G-vectors: how far the pilot's down is off.

    Parameters
    ----------
    step : (n - 1,) array
        [s]
    before, after : (n - 1, 2, 3) array
        [g]

    Returns
    -------
    largest, rms : float or None
        [deg], over the time in which neither vector is
        shorter than ``WEIGHTLESS``; None where there is no such time.
    """
    across = length(np.cross(before, after))
    angle = np.degrees(np.arctan2(across, inner(before, after)))
    sizes = (length(before), length(after))
    clear = np.minimum(*sizes) >= WEIGHTLESS
    time = float(integrate_sides(step, clear.astype(float)))
    if not time:
        return None, None
    square = float(integrate_sides(step, np.where(clear, angle, 0.0) ** 2))
    return float(np.max(angle[clear])), float(np.sqrt(square / time))


def rms(step: Floats, sides: Floats) -> float:
    """Return the root of the mean square over time of (n - 1, 2) values on sides."""
    return float(np.sqrt(integrate_sides(step, sides**2) / step.sum()))


def peak(sides: Floats) -> float:
    """Return the largest magnitude of values on sides."""
    return float(np.max(np.abs(sides)))


def _sizes(step: Floats, before: Floats, after: Floats) -> list[tuple[float, float, float, float]]:
    """Return RMS and peak, before and after, of each component and of the magnitude."""
    return [
        (rms(step, old), rms(step, new), peak(old), peak(new))
        for old, new in zip(_with_magnitude(before), _with_magnitude(after), strict=True)
    ]


def _with_magnitude(vectors: Floats) -> tuple[Floats, ...]:
    return (*np.moveaxis(vectors, -1, 0), length(vectors))


def _g_by_axis(motion: Motion, before: Floats, after: Floats) -> dict[GAxis, GSizes]:
    onsets = (largest_onset(motion.t, before), largest_onset(motion.t, after))
    found = {}
    for index, axis in enumerate(G_AXES):
        old, new = before[..., index], after[..., index]
        found[axis] = GSizes(
            *_extremes(old, onsets[0][index]),
            *_extremes(new, onsets[1][index]),
            rms_error_g=rms(motion.step, new - old),
        )
    return found


def _extremes(sides: Floats, onset: float) -> tuple[float, float, float, float, float]:
    """Return peak, least and largest value, onset and largest jump of a component, (n - 1, 2)."""
    jump = float(np.max(np.abs(sides[1:, 0] - sides[:-1, 1]), initial=0.0))
    return peak(sides), float(np.min(sides)), float(np.max(sides)), float(onset), jump
