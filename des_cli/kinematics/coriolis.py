"""The Coriolis part of the seat's angular acceleration, (16)-(24), and its derivatives.

The angular velocity is ``W = sum_k w_k theta_k'``; its derivative splits into
the noncoriolis part ``sum_k w_k theta_k''`` and the Coriolis vector

    c = sum_{j<k} theta_j' theta_k' (w_j x w_k)                               (21)

whose components along i0, j0, k0 are (AB3, BB3, CB3) of (22)-(24). Axes
"report" are those of the ground frame, "seat" those of frame 17 (x forward, y
right, z down): the same vector, R_0^17^T c. Rates are in rad/s, c in rad/s^2.

No cross product is taken at run time. In ground axes ``dw_k/dtheta_j`` is
``w_j x w_k`` for j < k; in seat axes ``dw_j/dtheta_k`` is the same vector. So
the pair products are derivatives of the joint axes, trigonometric polynomials
like these, and c and all its derivatives are matrix products with constants.
In report axes they do not depend on the cab's angle, in seat axes not on the
arm's.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from des_cli.kinematics.chain import Chain
from des_cli.kinematics.trig_polynomial import BLOCK, TrigPolynomial, basis, stack
from des_cli.model.arrays import Floats
from des_cli.model.profile import Axes

PAIRS = ((0, 1), (0, 2), (1, 2))
"""Joint pairs in the order of every pair axis: arm-fork, arm-cab, fork-cab."""


def coriolis_pairs(chain: Chain, angles: Floats, axes: Axes) -> Floats:
    """Return ``w_j x w_k`` for the joint pairs of ``PAIRS``.

    Parameters
    ----------
    chain : Chain
    angles : (..., 3) array
        [rad]
    axes : {"report", "seat"}

    Returns
    -------
    (..., 3 pair, 3 component) array
    """
    return _forms(chain, axes).pairs(angles)


def coriolis_pairs_gradient(chain: Chain, angles: Floats, axes: Axes) -> Floats:
    """Return the partial derivatives of ``coriolis_pairs``, (..., 3 angle, 3 pair, 3)."""
    return _forms(chain, axes).gradient(angles)


def coriolis_pairs_hessian(chain: Chain, angles: Floats, axes: Axes) -> Floats:
    """Return the second partials of ``coriolis_pairs``, (..., 3 angle, 3 angle, 3 pair, 3)."""
    return _forms(chain, axes).gradient.gradient()(angles)


def pairs_form(chain: Chain, axes: Axes) -> TrigPolynomial:
    """Return what ``coriolis_pairs`` is evaluated from, value (3 pair, 3 component)."""
    return _forms(chain, axes).pairs


def angle_gradient_form(chain: Chain, axes: Axes) -> TrigPolynomial:
    """Return the same of ``coriolis_pairs_gradient``, value (3 angle, 3 pair, 3)."""
    return _forms(chain, axes).gradient


def coriolis(chain: Chain, angles: Floats, rates: Floats, axes: Axes) -> Floats:
    """Return the Coriolis vector c of (21)-(24).

    Parameters
    ----------
    chain : Chain
    angles, rates : (..., 3) array
        [rad], [rad/s]; they broadcast.
    axes : {"report", "seat"}

    Returns
    -------
    (..., 3) array
        [rad/s^2]
    """
    return _evaluate(chain, angles, rates, axes, derivatives=False)[0]


def coriolis_derivatives(
    chain: Chain, angles: Floats, rates: Floats, axes: Axes
) -> tuple[Floats, Floats, Floats]:
    """Return the Coriolis vector with its partial derivatives.

    Parameters
    ----------
    chain : Chain
    angles, rates : (..., 3) array
        [rad], [rad/s]; they broadcast.
    axes : {"report", "seat"}

    Returns
    -------
    c : (..., 3) array
        [rad/s^2]
    dc_dangle : (..., 3 component, 3 angle) array
        At fixed rates.
    dc_drate : (..., 3 component, 3 rate) array
        At fixed angles.
    """
    c, dc_dangle, dc_drate = _evaluate(chain, angles, rates, axes, derivatives=True)
    return c, dc_dangle, dc_drate


def coriolis_curvature(
    chain: Chain, angles: Floats, rates: Floats, weight: Floats, axes: Axes
) -> tuple[Floats, Floats, Floats]:
    """Return the second derivatives of ``weight . c`` in angles and rates.

    Parameters
    ----------
    chain : Chain
    angles, rates, weight : (n, 3) array
        [rad], [rad/s], and one factor for each component.
    axes : {"report", "seat"}

    Returns
    -------
    angle_angle, angle_rate, rate_rate : (n, 3, 3) array
        The first two have the angles first; ``angle_rate`` is no symmetric matrix.
    """
    forms = _forms(chain, axes)
    n = len(angles)
    angle_angle, angle_rate = np.empty((n, 3, 3)), np.empty((n, 3, 3))
    rate_rate = np.zeros((n, 3, 3))
    for start in range(0, n, BLOCK):
        block = slice(start, start + BLOCK)
        functions = basis(angles[block], forms.pairs.joints)
        heavy, fast = (np.ascontiguousarray(v[block].T) for v in (weight, rates))
        by_weight = (functions[:, None] * heavy).reshape(-1, heavy.shape[1])
        values = forms.from_weights.T @ by_weight
        along, turned, second = values[:3], values[3:12].reshape(3, 3, -1), values[12:]
        for pair, (j, k) in enumerate(PAIRS):
            rate_rate[block, j, k] = rate_rate[block, k, j] = along[pair]
        for angle in range(3):
            with_arm_fork, with_arm_cab, with_fork_cab = turned[angle]
            angle_rate[block, angle, 0] = with_arm_fork * fast[1] + with_arm_cab * fast[2]
            angle_rate[block, angle, 1] = with_arm_fork * fast[0] + with_fork_cab * fast[2]
            angle_rate[block, angle, 2] = with_arm_cab * fast[0] + with_fork_cab * fast[1]
        products = np.stack([fast[j] * fast[k] for j, k in PAIRS])
        by_angles = (second.reshape(6, 3, -1) * products).sum(axis=1)
        for which, (a, b) in enumerate(_ANGLE_PAIRS):
            angle_angle[block, a, b] = angle_angle[block, b, a] = by_angles[which]
    return angle_angle, angle_rate, rate_rate


def angular_acceleration_split(
    chain: Chain, angles: Floats, rates: Floats, accelerations: Floats, axes: Axes
) -> tuple[Floats, Floats]:
    """Split the seat's angular acceleration, (16)-(18), as (20) does.

    Parameters
    ----------
    chain : Chain
    angles, rates, accelerations : (..., 3) array
        [rad], [rad/s], [rad/s^2]
    axes : {"report", "seat"}

    Returns
    -------
    noncoriolis, coriolis : (..., 3) array
        [rad/s^2]; their sum is dW/dt.
    """
    joint_axes = (chain.ground_axes if axes == "report" else chain.seat_axes)(angles)
    noncoriolis = (np.asarray(accelerations)[..., None, :] @ joint_axes)[..., 0, :]
    return noncoriolis, coriolis(chain, angles, rates, axes)


@dataclass(frozen=True, eq=False)
class _Forms:
    """What one chain needs in one set of axes.

    ``from_products`` (b * 3, 3 + 9) and ``from_rates`` (b * 3, 9) turn the b
    basis functions times the pairs' rate products, or times the rates, into
    [c, dc_dangle] and dc_drate. ``from_weights`` (b * 3, 3 + 9 + 18) turns them
    times weights on c into the weighted pairs, their derivatives in the angles, and
    the second ones in the order of ``_ANGLE_PAIRS``.
    """

    pairs: TrigPolynomial
    gradient: TrigPolynomial
    from_products: Floats
    from_rates: Floats
    from_weights: Floats


_ANGLE_PAIRS = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))


@lru_cache(maxsize=64)
def _forms(chain: Chain, axes: Axes) -> _Forms:
    joint_axes = chain.ground_axes if axes == "report" else chain.seat_axes
    each = []
    for j, k in PAIRS:
        moved, mover = (k, j) if axes == "report" else (j, k)
        derivative = joint_axes.derivative(mover)
        each.append(TrigPolynomial(derivative.coefficient[..., moved, :]))
    pairs = stack(each)
    gradient = pairs.gradient()

    used = tuple(slice(None) if joint in pairs.joints else 0 for joint in range(3))
    value = pairs.coefficient[used].reshape(-1, 3, 3)  # basis, pair, component
    slope = gradient.coefficient[used].reshape(-1, 3, 3, 3)  # basis, angle, pair, component
    rate = np.zeros((len(value), 3, 3, 3))  # basis, rate of the partner, component, rate
    for pair, (j, k) in enumerate(PAIRS):
        rate[:, k, :, j] = rate[:, j, :, k] = value[:, pair]
    curve = gradient.gradient().coefficient[used].reshape(-1, 3, 3, 3, 3)
    first, second = np.transpose(_ANGLE_PAIRS)
    columns = (  # basis and component first, then the columns
        value.transpose(0, 2, 1),
        slope.transpose(0, 3, 1, 2),
        curve[:, first, second].transpose(0, 3, 1, 2),
    )
    return _Forms(
        pairs=pairs,
        gradient=gradient,
        from_products=np.hstack([value.reshape(-1, 3), slope.transpose(0, 2, 3, 1).reshape(-1, 9)]),
        from_rates=rate.reshape(-1, 9),
        from_weights=np.hstack([each.reshape(3 * len(value), -1) for each in columns]),
    )


def _evaluate(
    chain: Chain, angles: Floats, rates: Floats, axes: Axes, *, derivatives: bool
) -> tuple[Floats, ...]:
    """Return c, and with ``derivatives`` also dc_dangle and dc_drate."""
    angles, rates = np.broadcast_arrays(angles, rates)
    leading = angles.shape[:-1]
    theta, speed = angles.reshape(-1, 3), rates.reshape(-1, 3)
    forms = _forms(chain, axes)
    shapes = [(3,), (3, 3), (3, 3)] if derivatives else [(3,)]
    matrices = [forms.from_products[:, :3], forms.from_products[:, 3:], forms.from_rates]
    dtype = np.result_type(theta.dtype, speed.dtype, np.float64)
    results = [np.empty((len(theta), 3 ** len(shape)), dtype=dtype) for shape in shapes]
    for start in range(0, len(theta), BLOCK):
        block = slice(start, start + BLOCK)
        functions = basis(theta[block], forms.pairs.joints)
        fast = np.ascontiguousarray(speed[block].T)
        products = np.stack([fast[j] * fast[k] for j, k in PAIRS])
        by_product = (functions[:, None] * products).reshape(-1, fast.shape[1]).T
        np.matmul(by_product, matrices[0], out=results[0][block])
        if derivatives:
            np.matmul(by_product, matrices[1], out=results[1][block])
            by_rate = (functions[:, None] * fast).reshape(-1, fast.shape[1]).T
            np.matmul(by_rate, matrices[2], out=results[2][block])
    return tuple(
        result.reshape(leading + shape) for result, shape in zip(results, shapes, strict=True)
    )
