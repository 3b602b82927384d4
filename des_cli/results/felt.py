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
from des_cli.model.motion import Motion
from des_cli.model.response import SeatResponse
from des_cli.model.sides import in_pieces, sizes_of

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
    time = square = largest = 0.0
    for part in in_pieces(len(step)):
        old, new = before[part], after[part]
        across = length(np.cross(old, new))
        angle = np.degrees(np.arctan2(across, inner(old, new)))
        clear = np.minimum(length(old), length(new)) >= WEIGHTLESS
        angle[~clear] = 0.0
        time += 0.5 * float(step[part] @ np.sum(clear, axis=1))
        square += 0.5 * float(step[part] @ inner(angle, angle))
        largest = max(largest, float(np.max(angle)))
    return (largest, float(np.sqrt(square / time))) if time else (None, None)


def _sizes(step: Floats, before: Floats, after: Floats) -> list[tuple[float, float, float, float]]:
    """Return RMS and peak, before and after, of each component and of the magnitude."""
    old, new = sizes_of(step, before), sizes_of(step, after)
    each = (old.rms, new.rms, old.peak, new.peak)
    return [
        (float(old_rms), float(new_rms), float(old_peak), float(new_peak))
        for old_rms, new_rms, old_peak, new_peak in zip(*each, strict=True)
    ]


def _g_by_axis(motion: Motion, before: Floats, after: Floats) -> dict[GAxis, GSizes]:
    old, new = _extremes(motion.t, before), _extremes(motion.t, after)
    off = np.zeros(len(G_AXES))
    for part in in_pieces(len(motion.step)):
        error = after[part] - before[part]
        off += 0.5 * motion.step[part] @ np.einsum("nsi,nsi->ni", error, error)
    rms = np.sqrt(off / np.sum(motion.step))
    return {
        axis: GSizes(*old[index], *new[index], rms_error_g=float(rms[index]))
        for index, axis in enumerate(G_AXES)
    }


def _extremes(t: Floats, sides: Floats) -> list[tuple[float, float, float, float, float]]:
    """Return peak, least and largest value, onset and largest jump of each component."""
    values = sides.reshape(-1, sides.shape[2])
    least, most = np.min(values, axis=0), np.max(values, axis=0)
    jump = np.zeros(sides.shape[2])
    for part in in_pieces(len(sides) - 1):
        after = slice(part.start + 1, part.stop + 1)
        np.maximum(jump, np.max(np.abs(sides[after, 0] - sides[part, 1]), axis=0), out=jump)
    columns = (np.maximum(-least, most), least, most, largest_onset(t, sides), jump)
    return [(a, b, c, d, e) for a, b, c, d, e in np.stack(columns, axis=1).tolist()]
