"""How far the modified motion starts and ends from the profile, in words."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Literal, TypeAlias

from des_cli.model.machine import JOINTS
from des_cli.results.reading import number

When: TypeAlias = Literal["start", "end"]

MATCHED = 0.05
"""Difference of a joint [deg, deg/s] below which it is where the profile has it."""

# Paths of the angle's and of the rate's difference, for each joint.
_PATHS: Mapping[When, tuple[str, str]] = {
    "start": ("fidelity.start_error.{}_rad", "fidelity.start_error.{}_rad_s"),
    "end": ("fidelity.end_error_rad.{}", "fidelity.end_error_rad_s.{}"),
}


def end_words(metrics: Mapping[str, Any], when: When) -> str:
    """Name the joints whose angle and whose rate are off most; empty if nothing is known.

    >>> end_words({"fidelity": {"end_error_rad": {"arm": -0.5, "cab": 0.1}}}, "end")
    'arm -28.6 deg'
    >>> end_words({"fidelity": {"end_error_rad": {"arm": 1e-9}}}, "end")
    'as in the profile'
    """
    off, known = [], False
    for path, unit in zip(_PATHS[when], ("deg", "deg/s"), strict=True):
        values = {joint: number(metrics, path.format(joint)) for joint in JOINTS}
        sizes = {joint: math.degrees(value) for joint, value in values.items() if value is not None}
        known = known or bool(sizes)
        worst = max(sizes, key=lambda joint: abs(sizes[joint]), default=None)
        if worst is not None and abs(sizes[worst]) >= MATCHED:
            off.append(f"{worst} {sizes[worst]:+.3g} {unit}")
    if not known:
        return ""
    return " and ".join(off) or "as in the profile"
