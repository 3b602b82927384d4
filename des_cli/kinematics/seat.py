"""What the pilot feels at the seat: linear acceleration in three parts, and G.

The seat's acceleration follows from (12) by differentiation::

    a = J1 theta''  +  sum_i p_ii theta_i'^2  +  2 sum_{i<j} p_ij theta_i' theta_j'
        tangential     centripetal               Coriolis

with p_ij the second partial derivatives of the seat position.

Conventions, in words:

- Ground axes: z0 up; gravity is along -z0. Seat axes are those of frame 17: x
  forward, y to the right, z down through the seat.
- The specific force is what a seat-mounted accelerometer reads, ``R^T (a + g
  z0)``, gravity included: an upright seat at rest reads (0, 0, -1) g in seat
  axes, for the seat pushes the pilot upwards. 1 g is 32.2 ft/s^2, as in the
  study.
- The G-vector is the specific force under the pilot's names, each component
  positive for the way his eyeballs go, which is against the push: +Gx (pushed
  forward) eyeballs in, +Gy (pushed to the right) eyeballs left, +Gz (pushed
  headward) eyeballs down. So (Gx, Gy, Gz) = (fx, fy, -fz), and rest is Gz = +1.
  ``Response.seat_g`` is this vector.
- ``acceleration_parts`` gives accelerations without gravity along the plain
  seat axes x, y, z.

The study's examples of Coriolis, on a planar machine: two turntables about one
axis, and on them two links of 1 m that an elbow joins.

>>> from des_cli.kinematics.chain import chain_of
>>> from des_cli.model.machine import DHRow, JointLimits, Machine, Seat
>>> rows = (DHRow(variable="arm"), DHRow(variable="fork"), DHRow(a=1, variable="cab"), DHRow(a=1))
>>> limits = (JointLimits(np.inf, 9.0, 9.0),) * 3
>>> chain = chain_of(Machine("planar", rows, limits), Seat())
>>> still = np.zeros(3)

Example 2, a disk that turns at W2 on a disk that turns at W1: at r2 = 2 m the
accelerations r2 W1^2 + r2 W2^2 (5) lack the term 2 W1 r2 W2 (6) of (7).

>>> w1, w2 = 3.0, 0.5
>>> _, centripetal, coriolis = linear_acceleration_parts(chain, still, [w1, w2, 0], still)
>>> centripetal, coriolis, (w1 + w2) ** 2 * 2
(array([-18.5,   0. ,   0. ]), array([-6.,  0.,  0.]), 24.5)

Example 1, a slider that runs out along a bar at V while the bar turns at omega:
2 omega x V (1), across the bar. Folding the elbow by 2a moves the tip, the
slider, straight along x, the bar, to 2 cos(a).

>>> a, a_rate, omega = 0.5, -0.8, 1.5
>>> folding = np.array([0.0, -a_rate, 2 * a_rate])
>>> v = linear_jacobian(chain, [0.0, -a, 2 * a]) @ folding
>>> bool(np.isclose(v[0], -2 * np.sin(a) * a_rate)), bool(abs(v[1]) < 1e-15)
(True, True)
>>> slides = linear_acceleration_parts(chain, [0, -a, 2 * a], folding, still)[2]
>>> both = linear_acceleration_parts(chain, [0, -a, 2 * a], folding + [omega, 0, 0], still)[2]
>>> bool(np.allclose(both - slides, 2 * np.cross([0, 0, omega], v), rtol=0, atol=1e-14))
True
"""

from __future__ import annotations

import numpy as np

from des_cli.kinematics.chain import (
    Chain,
    linear_jacobian,
    position_second_partials,
    seat_rotation,
)
from des_cli.model.arrays import Floats
from des_cli.units import STANDARD_GRAVITY_M_S2


def linear_acceleration_parts(
    chain: Chain, angles: Floats, rates: Floats, accelerations: Floats
) -> Floats:
    """Return the seat's linear acceleration, split in three, in ground axes.

    Parameters
    ----------
    chain : Chain
    angles, rates, accelerations : (..., 3) array
        [rad], [rad/s], [rad/s^2]; of one shape.

    Returns
    -------
    (..., 3 part, 3 component) array
        Tangential, centripetal, Coriolis [m/s^2]; their sum is the
        acceleration.
    """
    rates, accelerations = np.asarray(rates), np.asarray(accelerations)
    partials = position_second_partials(chain, angles)
    tangential = (linear_jacobian(chain, angles) @ accelerations[..., None])[..., 0]
    diagonal = np.stack([partials[..., joint, joint, :] for joint in range(3)], axis=-2)
    centripetal = (rates[..., None, :] ** 2 @ diagonal)[..., 0, :]
    mixed = np.stack(
        [partials[..., 0, 1, :], partials[..., 0, 2, :], partials[..., 1, 2, :]], axis=-2
    )
    products = rates[..., [0, 0, 1]] * rates[..., [1, 2, 2]]
    coriolis = 2.0 * (products[..., None, :] @ mixed)[..., 0, :]
    return np.stack([tangential, centripetal, coriolis], axis=-2)


def in_seat_axes(chain: Chain, angles: Floats, vectors: Floats) -> Floats:
    """Turn vectors from ground axes into seat axes.

    Parameters
    ----------
    chain : Chain
    angles : (..., 3) array
        [rad]
    vectors : (..., m, 3) array
        m vectors at each sample, along i0, j0, k0.

    Returns
    -------
    (..., m, 3) array
        Along x, y, z of the seat.
    """
    # rows: v^T R is (R^T v)^T
    return np.asarray(vectors @ seat_rotation(chain, angles))


def specific_force(
    chain: Chain, angles: Floats, acceleration: Floats, gravity: float = STANDARD_GRAVITY_M_S2
) -> Floats:
    """Return the specific force at the seat, gravity included, in seat axes.

    Parameters
    ----------
    chain : Chain
    angles : (..., 3) array
        [rad]
    acceleration : (..., 3) array
        Of the seat, in ground axes [m/s^2].
    gravity : float
        Local gravity, along -z0 [m/s^2].

    Returns
    -------
    (..., 3) array
        Along x (forward), y (right), z (down) [g].
    """
    lifted = np.asarray(acceleration) + gravity * np.array([0.0, 0.0, 1.0])
    force: Floats = in_seat_axes(chain, angles, lifted[..., None, :])[..., 0, :]
    return force / STANDARD_GRAVITY_M_S2


PILOT_SIGNS = np.array([1.0, 1.0, -1.0])
"""From the specific force along x, y, z of the seat to Gx, Gy, Gz."""


def pilot_g(force: Floats) -> Floats:
    """Return the G-vector (Gx, Gy, Gz) of a specific force in seat axes.

    Parameters
    ----------
    force : (..., 3) array
        Along x (forward), y (right), z (down) of the seat.

    Returns
    -------
    (..., 3) array
        +Gx eyeballs in, +Gy eyeballs left, +Gz eyeballs down; in the unit of
        ``force``.

    Examples
    --------
    An upright seat at rest is pushed upwards, against z, with 1 g.

    >>> pilot_g(np.array([0.0, 0.0, -1.0]))
    array([0., 0., 1.])
    """
    named: Floats = np.asarray(force) * PILOT_SIGNS
    return named + 0.0  # no negative zero
