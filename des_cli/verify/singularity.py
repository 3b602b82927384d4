"""How near a motion that is asked for comes to where the joints cannot turn the seat.

Joint commands and a requested G are motions of the joints, which make all that they turn the
seat by. Of body rates the joints may miss a part: near the singularity, where the inverse of
the Jacobian is damped, and where a joint would be faster than its limit.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

import numpy as np

from des_cli.model.arrays import Flags, Floats
from des_cli.model.metrics import Singularity
from des_cli.model.profile import BodyRates
from des_cli.verify.claim import Claim
from des_cli.verify.factors import jacobian
from des_cli.verify.requested import matrices, turned

REGULAR = 0.1
"""Singular value from which the inverse is not damped: a part of what body rates mean."""

DOUBTFUL = 1e-9
"""Relative distance from it, or from a limit of a rate, within which rounding decides."""

Numbers: TypeAlias = Iterator[tuple[str, float | None, float]]


def singularity_numbers(claim: Claim, told: Singularity) -> Numbers:
    """Yield name, what is told, and what is found, of the motion asked for."""
    angle, command = claim.requested.angle, claim.profile.command
    yield "min_abs_cos_fork", told.min_abs_cos_fork, float(np.min(np.abs(np.cos(angle[:, 1]))))
    columns = jacobian(claim.chain_before, angle)
    least = np.asarray(np.linalg.svd(columns, compute_uv=False)[:, -1], dtype=float)
    yield "min_singular_value", told.min_singular_value, float(np.min(least))
    if isinstance(command, BodyRates):
        yield from _of_rates(claim, command, told, columns, least)
    else:
        yield "damped_samples", told.damped_samples, 0.0
        yield "max_residual_rad_s", told.max_residual_rad_s, 0.0
        yield "integration_error_max_deg", told.integration_error_max_deg, 0.0


def _of_rates(
    claim: Claim, command: BodyRates, told: Singularity, columns: Floats, least: Floats
) -> Numbers:
    made = claim.made
    asked = np.concatenate([command.start, command.end]).T
    missed = asked - made.rate
    start, end = np.split(missed, 2, axis=1)
    inside = 0.5 * (start[:, 1:] + end[:, :-1])
    residual = max(_longest(each) for each in (start[:, :1], inside, end[:, -1:]))
    yield "max_residual_rad_s", told.max_residual_rad_s, residual
    demand = np.einsum("ijm,jm->mi", made.rotation, asked)
    few, many = (
        float(np.sum(_held(claim, columns, least, demand, slack)))
        for slack in (-DOUBTFUL, DOUBTFUL)
    )
    count = told.damped_samples
    yield "damped_samples", count, float(np.clip(count or 0.0, few, many))
    flown = np.concatenate([made.rotation[..., : len(least) - 1], made.rotation[..., -1:]], axis=-1)
    turns = turned(claim.requested.step, command)
    apart = _largest_angle(flown, np.tensordot(flown[..., 0], turns, 1))
    yield "integration_error_max_deg", told.integration_error_max_deg, apart
    if command.attitude is not None and np.all(np.isfinite(command.attitude[0])):
        known = np.all(np.isfinite(command.attitude), axis=1)
        size = np.linalg.norm(command.attitude[known], axis=1)[:, None]
        recorded = matrices(command.attitude[known] / size)
        apart = _largest_angle(recorded, np.tensordot(recorded[..., 0], turns[..., known], 1))
        yield "recorded_attitude_error_max_deg", told.recorded_attitude_error_max_deg, apart


def _held(claim: Claim, columns: Floats, least: Floats, demand: Floats, slack: float) -> Flags:
    """Return the samples, (n,), at either side of which rates are damped or held at a limit.

    Parameters
    ----------
    claim : Claim
    columns : (n, 3, 3) array
        Along ground axes, W per unit rate of each joint.
    least : (n,) array
        Its smallest singular value.
    demand : (2 (n - 1), 3) array
        W along ground axes [rad/s], at the starts of all intervals and then at their ends.
    slack : float
        Share by which what is regular and slow enough is taken to be less.
    """
    limit = np.array([joint.rate for joint in claim.profile.machine.limits])
    damped = least < REGULAR * (1.0 + slack)
    inverse = np.linalg.inv(np.where(damped[:, None, None], np.eye(3), columns))
    sides = []
    for at, part in zip((slice(-1), slice(1, None)), np.split(demand, 2), strict=True):
        rate = np.abs(inverse[at] @ part[:, :, None])[:, :, 0]
        sides.append(damped[at] | np.any(rate > limit * (1.0 - slack), axis=1))
    return np.asarray(np.append(sides[0], False) | np.append(False, sides[1]))


def _longest(vectors: Floats) -> float:
    return float(np.max(np.linalg.norm(vectors, axis=0), initial=0.0))


def _largest_angle(one: Floats, other: Floats) -> float:
    """Return the largest angle between attitudes (3, 3, m) [deg], by their chord."""
    chord = np.sqrt(np.max(np.sum((one - other) ** 2, axis=(0, 1))) / 8.0)
    return float(np.degrees(2.0 * np.arcsin(min(chord, 1.0))))
