"""What the user should know of a run beside the numbers, a sentence each."""

from __future__ import annotations

import numpy as np

from des_cli.kinematics.noise import suggest_smoothing
from des_cli.model.coriolis import COMPONENTS
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_DEVIATION,
    ANGULAR_ACCELERATION_ERROR,
    FACTOR_DEVIATION,
    JOINT_DEVIATION,
    SEAT_G_DEVIATION,
    SEAT_RATE_DEVIATION,
    label_of,
)
from des_cli.model.metrics import Metrics
from des_cli.model.motion import DesiredMotion
from des_cli.model.notice import Notice, NoticeName
from des_cli.model.profile import Profile
from des_cli.results.asked_g import asked_g_sentence
from des_cli.results.worse import find_worse
from des_cli.units import percent

BOUGHT = 0.05
"""Relative growth of a Coriolis component's energy that is worth a sentence."""

FELT = 0.25
"""Relative deviation of the seat's angular rate or G-vector that is worth a sentence."""

RESTRAINING = frozenset(
    {
        FACTOR_DEVIATION,
        SEAT_RATE_DEVIATION,
        ANGULAR_ACCELERATION_DEVIATION,
        ANGULAR_ACCELERATION_ERROR,
    }
)
"""Metrics whose budget holds back rates or accelerations. Without one of them nothing in
the problem does: it is ill-posed, and its commands jump from limit to limit."""

CHATTER = 5
"""Sign changes of a joint's acceleration from which its commands are said to chatter: a
maneuver that swings there and back and settles has two to four."""

NOTICEABLE = 1e-3
"""Change of a desired angle [rad] by the limits that is worth a sentence."""


def find_notices(profile: Profile, asked: DesiredMotion, metrics: Metrics) -> list[Notice]:
    """Return the sentences of a run, each with its name.

    Parameters
    ----------
    profile : Profile
    asked : DesiredMotion
        What the profile asks for.
    metrics : Metrics
        All of them but the sentences.

    Returns
    -------
    list of Notice
        On what reading changed, a noisy record, a ride that got worse or feels different,
        budgets that let the commands chatter, how near the machine comes to an asked G, a
        damped inverse, a replaced desired motion, a cross-coupling that grew or was bought
        with another or was not there, and a solver that stopped short of its tolerance.
    """
    remarks: list[tuple[NoticeName, str]] = [
        ("record", remark) for remark in (*profile.remarks, *asked.remarks)
    ]
    found: list[tuple[NoticeName, str]] = [
        *remarks,
        ("noisy", suggest_smoothing(profile, asked)),
        ("worse", _worse(metrics)),
        ("felt", _felt(metrics)),
        ("ill-posed", _ill_posed(metrics)),
        ("asked-g", asked_g_sentence(asked.g_offset)),
        ("damped", _damped(asked)),
        ("replaced", _replaced(metrics)),
        ("uncoupled", _nothing(metrics)),
        ("bought", _bought(metrics)),
        ("short", _short(metrics)),
    ]
    return [Notice(name, sentence) for name, sentence in found if sentence]


def _usable(metrics: Metrics) -> bool:
    return metrics.solver.status in ("converged", "acceptable")


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


def _replaced(metrics: Metrics) -> str:
    moved = [
        f"{joint} {value:.3g} rad"
        for joint, value in metrics.executable.change.joint_change_max_rad.items()
        if value is not None and value > NOTICEABLE
    ]
    if not moved:
        return ""
    why = (
        "breaks limits; it was replaced by the nearest one inside them"
        if metrics.executable.breaks_limits
        else "was made consistent: its angles are the integrals of its rates"
    )
    return (
        f"the desired motion {why}, "
        f"changed by up to {', '.join(moved)}; what is felt is measured against the profile"
    )


def _bought(metrics: Metrics) -> str:
    objective = metrics.coriolis.objective.reduction
    if not _usable(metrics):
        return ""
    if objective is not None and objective < 0.0:
        return (
            f"the cross-coupling that r1 weighs grew by {percent(-objective)}: nothing was gained"
        )
    # Of components in the study's axes the pilot feels none: only who weighs them hears of them.
    axes = metrics.solver.axes
    grown = [
        f"{component.label} grew by {percent(-reduction)}"
        for component in COMPONENTS
        if axes != "seat" or component.axes != "report"
        if (reduction := metrics.coriolis.reduction(component.key)) is not None
        and reduction < -BOUGHT
    ]
    return f"one component was bought with another: {', '.join(grown)}" if grown else ""


def _worse(metrics: Metrics) -> str:
    """Say what a pilot would rather not have, with all its numbers."""
    found = find_worse(metrics) if _usable(metrics) else []
    if not found:
        return ""
    cures = [each.cure for each in found if each.cure]
    return (
        f"worse to sit in than the profile: {', '.join(map(str, found))}; "
        f"{', '.join(cures)} bound{'s' * (len(cures) == 1)} that"
    )


def _felt(metrics: Metrics) -> str:
    """Say that a small change of angles is not a small change of what is felt."""
    budget = metrics.solver.budget or {}
    off = {
        key: value
        for key in (SEAT_RATE_DEVIATION, SEAT_G_DEVIATION)
        if key not in budget and (value := metrics.fidelity.value(key) or 0.0) >= FELT
    }
    if not _usable(metrics) or not off:
        return ""
    said = ", ".join(f"{label_of(key)} is off by {percent(value)}" for key, value in off.items())
    joints = percent(metrics.fidelity.value(JOINT_DEVIATION) or 0.0)
    return (
        f"what the pilot feels is changed: {said}, at {joints} in the joints; "
        f"a budget on {' or '.join(off)} bounds that"
    )


def _ill_posed(metrics: Metrics) -> str:
    """Say that the budgets leave the rates free, and how the commands look for it."""
    solver = metrics.solver
    budget = solver.budget or {}
    posed = solver.control == "scalar" or solver.objective not in (None, "coriolis")
    if not budget or RESTRAINING & set(budget) or posed or not _usable(metrics):
        return ""
    labels = " and ".join(label_of(key) for key in budget)
    driven = {
        joint: load.acceleration_sign_changes or 0
        for joint, load in metrics.limits.modified.items()
    }
    joint = max(driven, key=lambda name: driven[name])
    how = (
        f"the commands chatter (the {joint}'s acceleration changes sign {driven[joint]} times)"
        if driven[joint] >= CHATTER
        else "nothing in it holds the joints' rates back"
    )
    return (
        f"a budget on {labels} alone is ill-posed: {how}; "
        f"add a budget on {SEAT_RATE_DEVIATION}, or objective: blend"
    )


def _nothing(metrics: Metrics) -> str:
    if metrics.coriolis.reduction("vector") is not None:
        return ""
    return "the desired motion makes no cross-coupling: there is nothing to reduce"


def _short(metrics: Metrics) -> str:
    if metrics.solver.status != "acceptable":
        return ""
    return f"acceptable, not converged: {metrics.solver.message}"
