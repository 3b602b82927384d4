"""How near a motion comes to the singularity, and what of body rates its joints do not make."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from des_cli.model.arrays import Flags, Floats
from des_cli.model.metrics import Singularity
from des_cli.model.profile import BodyRates
from des_cli.verify.claim import Claim
from des_cli.verify.requested import turned
from des_cli.verify.rotations import matrices

SAME_COSINE = 1e-14
"""Difference of cosines between axes that may be rounding."""

REGULAR = 0.1
"""Singular value from which the inverse is not damped: a part of what body rates mean."""

DOUBTFUL = 1e-9
"""Relative distance from it, or from a limit of a rate, within which rounding decides."""

Numbers: TypeAlias = Iterator[tuple[str, float | None, float]]
"""Name, what is told, and what is found."""


def singularity_numbers(claim: Claim, told: Singularity) -> Numbers:
    """Yield how near the motion asked for comes to where the joints cannot turn the seat.

    Joint commands and a requested G are motions of the joints, which make all that they turn
    the seat by. Of body rates the joints may miss a part: near the singularity, where the
    inverse of the Jacobian is damped, and where a joint would be faster than its limit.
    """
    angle, command = claim.requested.angle, claim.profile.command
    yield "min_abs_cos_fork", told.min_abs_cos_fork, float(np.min(np.abs(np.cos(angle[:, 1]))))
    nearest = _nearest_to_singular(claim)
    least = _least_singular(claim.chain_before.axes(angle[nearest]))
    yield "min_singular_value", told.min_singular_value, float(np.min(least))
    if isinstance(command, BodyRates):
        yield from _of_rates(claim, command, told)
    else:
        yield "damped_samples", told.damped_samples, 0.0
        yield "max_residual_rad_s", told.max_residual_rad_s, 0.0
        yield "integration_error_max_deg", told.integration_error_max_deg, 0.0


def _nearest_to_singular(claim: Claim) -> NDArray[np.intp]:
    """Return samples of the motion asked for, among them the nearest to the singularity.

    Neighbouring axes keep the angle between them, so that the axes' matrix of cosines changes
    in one of them alone, that of arm and cab. The square of the smallest singular value is an
    eigenvalue of it, the least of what is linear in that cosine: it is least where the cosine
    is least or largest. Those of one fork angle are one sample.
    """
    chain, angle = claim.chain_before, claim.requested.angle
    # The arm does not turn its own axis in the ground, nor the cab its own in the seat.
    cab = chain.axes(angle[:1])[0, :, 2]
    arm = chain.rotation(angle[:1])[..., 0] @ chain.axes(angle[:1])[0, :, 0]
    cosine = np.empty(len(angle))
    for samples, rotation in claim.made.attitudes.blocks():
        cosine[samples] = np.tensordot(arm, np.tensordot(rotation, cab, (1, 0)), 1)
    least, most = np.min(cosine) + SAME_COSINE, np.max(cosine) - SAME_COSINE
    found = np.flatnonzero((cosine <= least) | (cosine >= most))
    _, first = np.unique(angle[found, 1], return_index=True)
    return np.asarray(found[first])


def _least_singular(columns: Floats) -> Floats:
    """Return the smallest singular values of matrices (m, 3, 3), (m,)."""
    return np.asarray(np.linalg.svd(columns, compute_uv=False)[:, -1], dtype=float)


def _of_rates(claim: Claim, command: BodyRates, told: Singularity) -> Numbers:
    made = claim.made
    columns = claim.chain_before.axes(claim.requested.angle)
    least = _least_singular(columns)
    asked = np.concatenate([command.start, command.end]).T
    missed = asked - made.rate
    start, end = np.split(missed, 2, axis=1)
    inside = 0.5 * (start[:, 1:] + end[:, :-1])
    residual = max(_longest(each) for each in (start[:, :1], inside, end[:, -1:]))
    yield "max_residual_rad_s", told.max_residual_rad_s, residual
    few, many = (
        float(np.sum(_held(claim, columns, least, asked.T, slack)))
        for slack in (-DOUBTFUL, DOUBTFUL)
    )
    count = told.damped_samples
    yield "damped_samples", count, float(np.clip(count or 0.0, few, many))
    flown = made.attitudes.matrices()
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
        Along seat axes, W per unit rate of each joint.
    least : (n,) array
        Its smallest singular value.
    demand : (2 (n - 1), 3) array
        W along seat axes [rad/s], at the starts of all intervals and then at their ends.
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


def _largest_angle(one: Floats, other: Floats) -> float:
    """Return the largest angle between attitudes (3, 3, m) [deg], by their chord."""
    chord = np.sqrt(np.max(np.sum((one - other) ** 2, axis=(0, 1))) / 8.0)
    return float(np.degrees(2.0 * np.arcsin(min(chord, 1.0))))


def _longest(vectors: Floats) -> float:
    """Return the largest length of vectors (3, m)."""
    return float(np.sqrt(np.max(np.sum(vectors**2, axis=0), initial=0.0)))
