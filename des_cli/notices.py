"""What the user should know of a run beside the numbers, a sentence each."""

from __future__ import annotations

from typing import Any

import numpy as np

from des_cli.model.motion import DesiredMotion

BOUGHT = 0.05
"""Relative growth of a Coriolis component's energy that is worth a sentence."""

FELT = 0.25
"""Relative deviation of the seat's angular rate that is worth a sentence."""

HARD = 0.1
"""Share of the time at the acceleration limit that is worth a sentence."""

NOTICEABLE = 1e-3
"""Change of a desired angle [rad] by the limits that is worth a sentence."""


def find_notices(asked: DesiredMotion, metrics: dict[str, Any]) -> list[str]:
    """Return the sentences of a run.

    Parameters
    ----------
    asked : DesiredMotion
        What the profile asks for.
    metrics : dict
        As ``metrics.measure`` returns them.

    Returns
    -------
    list of str
        On a damped inverse, a replaced desired motion, a Coriolis that grew or
        was bought with another or was not there, a motion that feels different,
        hard commands, and a solver that stopped short of its tolerance.
    """
    found = [
        _damped(asked),
        _replaced(metrics),
        _nothing(metrics),
        _bought(metrics),
        _felt(metrics),
        _hard(metrics),
        _short(metrics),
    ]
    return [sentence for sentence in found if sentence]


def _usable(metrics: dict[str, Any]) -> bool:
    return metrics["solver"]["status"] in ("converged", "acceptable")


def _damped(asked: DesiredMotion) -> str:
    if not np.any(asked.damped):
        return ""
    times = asked.motion.t[asked.damped]
    largest = float(np.max(np.linalg.norm(asked.residual, axis=1)))
    return (
        f"the inverse was damped or a joint rate held at its limit at {len(times)} samples "
        f"between t = {times[0]:g} and {times[-1]:g} s; "
        f"the seat rate is off by up to {largest:.3g} rad/s there"
    )


def _replaced(metrics: dict[str, Any]) -> str:
    change = metrics["executable"]["joint_change_max_rad"]
    moved = [f"{joint} {value:.3g} rad" for joint, value in change.items() if value > NOTICEABLE]
    if not moved:
        return ""
    return (
        "the desired motion breaks limits; it was replaced by the nearest one inside them, "
        f"changed by up to {', '.join(moved)}"
    )


def _bought(metrics: dict[str, Any]) -> str:
    parts = dict(metrics["coriolis"])
    objective = parts.pop("objective")["reduction"]
    if not _usable(metrics):
        return ""
    if objective is not None and objective < 0.0:
        return f"the Coriolis that r1 weighs grew by {-100 * objective:.3g} %: nothing was gained"
    grown = [
        f"{name} grew by {-100 * part['reduction']:.0f} %"
        for name, part in parts.items()
        if part["reduction"] is not None and part["reduction"] < -BOUGHT
    ]
    return f"one component was bought with another: {', '.join(grown)}" if grown else ""


def _felt(metrics: dict[str, Any]) -> str:
    """Say that a small change of angles is not a small change of what is felt."""
    fidelity = metrics["fidelity"]
    rate, joints = fidelity["seat_rate_deviation_relative"], fidelity["joint_deviation_relative"]
    force = fidelity["seat_g_deviation_relative"]
    if not _usable(metrics) or max(rate, force) < FELT:
        return ""
    return (
        f"what the pilot feels is changed: the seat's angular rate is off by {100 * rate:.0f} %, "
        f"its G by {100 * force:.0f} %, at {100 * joints:.1f} % in the joints; a budget on "
        "seat_rate_deviation_relative or seat_g_deviation_relative bounds that"
    )


def _hard(metrics: dict[str, Any]) -> str:
    """Say where the commands drive a joint to its acceleration limit again and again."""
    hard = [
        f"{joint} {100 * part['at_acceleration_limit']:.0f} %"
        for joint, part in metrics["limits"]["modified"].items()
        if part["at_acceleration_limit"] > HARD
    ]
    jump = max(part["jump_after_g"] for part in metrics["fidelity"]["seat_g"].values())
    if not hard or not _usable(metrics):
        return ""
    return (
        f"the commands stand at the acceleration limit for much of the time ({', '.join(hard)}) "
        f"and jump from one to the other side of it: the seat's G jumps by up to {jump:.2g} g; "
        "weights r2 and tracking instead of a budget make it smoother"
    )


def _nothing(metrics: dict[str, Any]) -> str:
    if metrics["coriolis"]["vector"]["reduction"] is not None:
        return ""
    return "the desired motion makes no Coriolis: there is nothing to reduce"


def _short(metrics: dict[str, Any]) -> str:
    if metrics["solver"]["status"] != "acceptable":
        return ""
    return f"acceptable, not converged: {metrics['solver']['message']}"
