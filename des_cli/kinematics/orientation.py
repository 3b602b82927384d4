"""Orientation Jacobians, the distance to the singularity, and the damped inverse.

``W = J theta'`` (13) holds with the ground Jacobian for components along i0,
j0, k0 and with the body Jacobian for those along x, y, z of the seat. On the
DES both have the determinant cos(theta2) and the singular values 1, sqrt(1 + s2)
and sqrt(1 - s2): at theta2 = pi/2 + k pi the arm and the cab turn about one
axis, and (19) has no inverse.
"""

from __future__ import annotations

import math

import numpy as np

from des_cli.kinematics.chain import Chain, joint_axes
from des_cli.model.arrays import Flags, Floats

SINGULAR_VALUE_THRESHOLD = 0.1
"""Singular value below which a direction is damped. The undamped gain is its
inverse, 10: a weak demand of 0.3 rad/s then takes the fork and the cab of the
DES to their 3.14 rad/s, and more could not be flown. On the DES it is reached
8 degrees from the singularity. Order of magnitude as in Maciejewski and Klein,
"Numerical filtering for the operation of robotic manipulators through
kinematically singular configurations", J. Robotic Systems 5 (1988)."""

SAME_COSINE = 16.0 * float(np.finfo(np.float64).eps)
"""Difference of cosines between axes that may be rounding."""

DAMPING_PER_THRESHOLD = math.sqrt(0.5)
"""Largest damping factor over the threshold. With ``lambda = lambda_max (1 -
(s/threshold)^2)``, a smooth form of Nakamura and Hanafusa's (J. Dynamic
Systems, Measurement and Control 108, 1986), the gain ``s/(s^2 + lambda^2)`` is
``2x/(threshold (1 + x^4))``, x = s/threshold: never over 1.14/threshold."""


def ground_jacobian(chain: Chain, angles: Floats) -> Floats:
    """Return J_in, ``W = J_in theta'`` along ground axes i0, j0, k0.

    Parameters
    ----------
    chain : Chain
    angles : (..., 3) array
        [rad]

    Returns
    -------
    (..., 3 component, 3 joint) array
    """
    return joint_axes(chain, angles, "ground").swapaxes(-1, -2)


def body_jacobian(chain: Chain, angles: Floats) -> Floats:
    """Return the Jacobian of p, q, r: ``W = J theta'`` along x, y, z of the seat.

    It does not depend on the arm's angle.

    Returns
    -------
    (..., 3 component, 3 joint) array
    """
    return joint_axes(chain, angles, "seat").swapaxes(-1, -2)


def smallest_singular_value(jacobian: Floats) -> Floats:
    """Return the distance to the singularity, (...), of Jacobians (..., 3, 3)."""
    return np.asarray(np.linalg.svd(jacobian, compute_uv=False)[..., -1])


def least_singular_value(chain: Chain, angles: Floats) -> float:
    """Return the least distance to the singularity along joint angles (n, 3).

    The axes of arm and fork keep the angle between them, and so do those of fork and cab.
    The squared singular values are therefore eigenvalues of a matrix that is linear in one
    number, the cosine between the axes of arm and cab. The smallest is the least of linear
    functions of it, which is concave: it is least where the cosine is least or largest.
    """
    cosine = _arm_to_cab(chain, angles[:, 1])
    ends = (cosine <= np.min(cosine) + SAME_COSINE) | (cosine >= np.max(cosine) - SAME_COSINE)
    rows = np.flatnonzero(ends)
    # A cosine has no slope on the singularity itself, where rounding hides which row is
    # nearest; a fork that stands still is at one angle on all rows.
    _, first = np.unique(angles[rows, 1], return_index=True)
    return float(np.min(smallest_singular_value(body_jacobian(chain, angles[rows[first]]))))


def _arm_to_cab(chain: Chain, fork: Floats) -> Floats:
    """Return the cosine between the axes of arm and cab, (n,), at angles of the fork."""
    x, y, z = chain.constants[1][2, :3]
    toward = chain.constants[2][:3, 2]
    along, across = x * toward[0] + y * toward[1], y * toward[0] - x * toward[1]
    _, sign, _ = chain.signs
    turned = along * np.cos(fork) + sign * across * np.sin(fork) + z * toward[2]
    return np.asarray(chain.signs[0] * chain.signs[2] * turned)


def damped_inverse_rates(
    jacobian: Floats,
    w: Floats,
    *,
    reference: Floats | None = None,
    threshold: float = SINGULAR_VALUE_THRESHOLD,
    max_damping: float | None = None,
) -> tuple[Floats, Flags, Floats]:
    """Solve ``J theta' = W`` for the joint rates, damped near the singularity.

    The solution is sought about a reference, ``theta' = ref + J# (W - J ref)``,
    and only the singular directions below the threshold are damped: where the
    machine is well conditioned this is (19) exactly, and a W that was made by
    ``J ref`` gives ``ref`` back even on the singularity.

    Parameters
    ----------
    jacobian : (..., 3, 3) array
        Ground or body Jacobian.
    w : (..., 3) array
        Angular velocity along the Jacobian's axes [rad/s].
    reference : (..., 3) array, optional
        Joint rates [rad/s] that a lost direction keeps; zero if not given.
    threshold : float
        Singular value below which a direction is damped.
    max_damping : float, optional
        Damping factor at the singularity; ``DAMPING_PER_THRESHOLD`` times the
        threshold if not given.

    Returns
    -------
    rates : (..., 3) array
        [rad/s]
    damped : (...) array of bool
        Where damping was in force.
    residual : (..., 3) array
        ``W - J theta'`` [rad/s], never longer than ``W - J ref``; rounding
        only, where nothing was damped.
    """
    jacobian, w = np.asarray(jacobian), np.asarray(w)
    start = np.zeros_like(w) if reference is None else np.asarray(reference)
    missing = w - _apply(jacobian, start)
    left, value, right = np.linalg.svd(jacobian)
    if max_damping is None:
        max_damping = DAMPING_PER_THRESHOLD * threshold
    weak = value < threshold
    damping = np.where(weak, max_damping * (1.0 - (value / threshold) ** 2), 0.0)
    squared = value**2 + damping**2
    # a direction that is lost altogether, and not damped, is left alone
    gain = np.divide(value, squared, out=np.zeros_like(value), where=squared > 0.0)
    along = _apply(left.swapaxes(-1, -2), missing)
    rates = start + _apply(right.swapaxes(-1, -2), gain * along)
    return rates, np.asarray(weak[..., -1]), w - _apply(jacobian, rates)


def _apply(matrix: Floats, vector: Floats) -> Floats:
    return np.asarray((matrix @ vector[..., None])[..., 0])
