"""What the pilot feels, before and after: the section ``felt`` of the metrics."""

from __future__ import annotations

from typing import Any

import numpy as np

from des_cli.kinematics.onset import largest_onset
from des_cli.model.arrays import Floats
from des_cli.model.motion import Motion, integrate_sides
from des_cli.model.response import Response

WEIGHTLESS = 0.1
"""Size of the G-vector [g] below which it has no direction worth an angle: there the
pilot has no down that could tilt, and a small error would turn it right round."""


def felt_metrics(motion: Motion, before: Response, after: Response) -> dict[str, Any]:
    """Return sizes of the seat's rate, of its angular acceleration and of the G-vector.

    Parameters
    ----------
    motion : Motion
        Gives the sample times.
    before, after : Response

    Returns
    -------
    dict
        ``seat_rate`` and ``seat_angular_acceleration`` by component and as
        ``magnitude``, ``seat_g`` by component.
    """
    return {
        "seat_rate": _sizes(motion.step, "pqr", before.seat_rate, after.seat_rate, "rad_s"),
        "seat_angular_acceleration": _sizes(
            motion.step,
            "xyz",
            before.seat_angular_acceleration,
            after.seat_angular_acceleration,
            "rad_s2",
        ),
        "seat_g": _g_by_axis(motion, before.seat_g, after.seat_g),
    }


def tilt_error(step: Floats, before: Floats, after: Floats) -> dict[str, float | None]:
    """Return the angle between two G-vectors: how far the pilot's down is off.

    Parameters
    ----------
    step : (n - 1,) array
        [s]
    before, after : (n - 1, 2, 3) array
        [g]

    Returns
    -------
    dict
        Largest and RMS angle [deg] over the time in which neither vector is
        shorter than ``WEIGHTLESS``; None where there is no such time.
    """
    across = np.linalg.norm(np.cross(before, after), axis=-1)
    angle = np.degrees(np.arctan2(across, np.sum(before * after, axis=-1)))
    sizes = (np.linalg.norm(before, axis=-1), np.linalg.norm(after, axis=-1))
    clear = np.minimum(*sizes) >= WEIGHTLESS
    time = float(integrate_sides(step, clear.astype(float)))
    if not time:
        return {"tilt_error_max_deg": None, "tilt_error_rms_deg": None}
    square = float(integrate_sides(step, np.where(clear, angle, 0.0) ** 2))
    return {
        "tilt_error_max_deg": float(np.max(angle[clear])),
        "tilt_error_rms_deg": float(np.sqrt(square / time)),
    }


def rms(step: Floats, sides: Floats) -> float:
    """Return the root of the mean square over time of (n - 1, 2) values on sides."""
    return float(np.sqrt(integrate_sides(step, sides**2) / step.sum()))


def rms_error(step: Floats, before: Floats, after: Floats) -> float:
    """Return the RMS length of the difference of (n - 1, 2, 3) vectors on sides."""
    return rms(step, np.linalg.norm(after - before, axis=-1))


def relative_error(step: Floats, before: Floats, after: Floats) -> float:
    """Return sqrt(int |after - before|^2 / int |before|^2) of vectors on sides."""
    size = float(integrate_sides(step, np.sum(before**2, axis=-1)))
    off = float(integrate_sides(step, np.sum((after - before) ** 2, axis=-1)))
    return float(np.sqrt(off / max(size, 1e-300)))


def _sizes(
    step: Floats, names: str, before: Floats, after: Floats, unit: str
) -> dict[str, dict[str, float]]:
    """Return RMS and peak, before and after, of each component and of the magnitude."""
    found = {}
    for name, old, new in zip(
        (*names, "magnitude"), _with_magnitude(before), _with_magnitude(after), strict=True
    ):
        found[name] = {
            f"rms_before_{unit}": rms(step, old),
            f"rms_after_{unit}": rms(step, new),
            f"peak_before_{unit}": float(np.max(np.abs(old))),
            f"peak_after_{unit}": float(np.max(np.abs(new))),
        }
    return found


def _with_magnitude(vectors: Floats) -> tuple[Floats, ...]:
    return (*np.moveaxis(vectors, -1, 0), np.linalg.norm(vectors, axis=-1))


def _g_by_axis(motion: Motion, before: Floats, after: Floats) -> dict[str, dict[str, float]]:
    onsets = {
        "before": largest_onset(motion.t, before),
        "after": largest_onset(motion.t, after),
    }
    found: dict[str, dict[str, float]] = {}
    for index, axis in enumerate(("gx", "gy", "gz")):
        part: dict[str, float] = {}
        for when, sides in (("before", before[..., index]), ("after", after[..., index])):
            part |= {
                f"peak_{when}_g": float(np.max(np.abs(sides))),
                f"min_{when}_g": float(np.min(sides)),
                f"max_{when}_g": float(np.max(sides)),
                f"onset_{when}_g_s": float(onsets[when][index]),
                f"jump_{when}_g": float(np.max(np.abs(sides[1:, 0] - sides[:-1, 1]), initial=0.0)),
            }
        part["rms_error_g"] = rms(motion.step, after[..., index] - before[..., index])
        found[axis] = part
    return found
