"""What was changed of the record before the reduction: ``changes`` and ``executable``."""

from __future__ import annotations

import numpy as np

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.response import respond_on
from des_cli.model.machine import JOINTS
from des_cli.model.metric import (
    ANGULAR_ACCELERATION_ERROR,
    ATTITUDE_ERROR,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
    MetricKey,
)
from des_cli.model.metrics import Change, Changes, Executable
from des_cli.model.motion import DesiredMotion, Motion, Shortfall
from des_cli.model.profile import Profile
from des_cli.model.sides import square_of
from des_cli.reduction.baseline import relative_reduction
from des_cli.reduction.fidelity import Deviation, joint_deviation
from des_cli.reduction.limits import find_violations

_TOLD: tuple[MetricKey, ...] = (
    SEAT_RATE_DEVIATION,
    SEAT_G_ERROR,
    ANGULAR_ACCELERATION_ERROR,
    ATTITUDE_ERROR,
)


def condition_metrics(profile: Profile, asked: DesiredMotion, target: Motion) -> Changes:
    """Return what the steps from the record to what the reduction begins from cost.

    Parameters
    ----------
    profile : Profile
    asked : DesiredMotion
        The record.
    target : Motion
        What conditioning made of it.

    Returns
    -------
    Changes
    """
    record, missing = asked.motion, asked.shortfall
    lost = None if missing is None else _cost(profile, record, record, missing)
    by_g = asked.g_offset is not None
    return Changes(
        damping=None if by_g else lost,
        machine=lost if by_g else None,
        smoothing=None if target is record else _cost(profile, record, target),
    )


def executable_metrics(profile: Profile, target: Motion, desired: Motion) -> Executable:
    """Return what keeping the limits alone cost.

    Parameters
    ----------
    profile : Profile
    target : Motion
        What was to be made.
    desired : Motion
        The same, or the nearest motion inside the limits.
    """
    broken = find_violations(profile.machine, target, "desired")
    return Executable(
        replaced=desired is not target,
        breaks_limits=bool(broken),
        change=_cost(profile, target, desired),
    )


def _cost(
    profile: Profile, before: Motion, after: Motion, missing: Shortfall | None = None
) -> Change:
    """Return what is felt, and done by the joints, of a change from one motion to another."""
    if after is before and missing is None:
        return _unchanged(profile, before)
    chains = (chain_of(profile.machine, profile.seat),) * 2
    deviation = Deviation.between(before, after, chains, profile.machine.gravity, shortfall=missing)
    moved = np.max(np.abs(after.angle - before.angle), axis=0)
    energies = (
        square_of(before.step, each.coriolis_seat) for each in (deviation.before, deviation.after)
    )
    return Change(
        joint_change_relative=joint_deviation(before, after),
        joint_change_max_rad={
            joint: float(value) for joint, value in zip(JOINTS, moved, strict=True)
        },
        coriolis_reduction=relative_reduction(*energies),
        metrics={metric: deviation.value(metric) for metric in _TOLD},
    )


def _unchanged(profile: Profile, motion: Motion) -> Change:
    """Return the change from a motion to itself, which is none."""
    response = respond_on(chain_of(profile.machine, profile.seat), profile.machine.gravity, motion)
    energy = square_of(motion.step, response.coriolis_seat)
    return Change(
        joint_change_relative=0.0,
        joint_change_max_rad=dict.fromkeys(JOINTS, 0.0),
        coriolis_reduction=relative_reduction(energy, energy),
        metrics=dict.fromkeys(_TOLD, 0.0),
    )
