"""How far the modified motion starts and ends from the profile, in words."""

from __future__ import annotations

import math

from des_cli.model.metrics import Fidelity, When

MATCHED = 0.05
"""Difference of a joint [deg, deg/s] below which it is where the profile has it."""


def end_words(fidelity: Fidelity, when: When) -> str:
    """Name the joints whose angle and whose rate are off most; empty if nothing is known.

    >>> end_words(Fidelity(end_error_rad={"arm": -0.5, "cab": 0.1}), "end")
    'arm -28.6 deg'
    >>> end_words(Fidelity(end_error_rad={"arm": 1e-9}), "end")
    'as in the profile'
    """
    off, known = [], False
    for values, unit in zip(fidelity.offset(when), ("deg", "deg/s"), strict=True):
        sizes = {joint: math.degrees(value) for joint, value in values.items() if value is not None}
        known = known or bool(sizes)
        worst = max(sizes, key=lambda joint: abs(sizes[joint]), default=None)
        if worst is not None and abs(sizes[worst]) >= MATCHED:
            off.append(f"{worst} {sizes[worst]:+.3g} {unit}")
    if not known:
        return ""
    return " and ".join(off) or "as in the profile"
