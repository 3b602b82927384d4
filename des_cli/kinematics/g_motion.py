"""From a requested G-vector to the joints that make it: the inverse of ``kinematics.seat``.

The arm's rate makes the magnitude and the two gimbals the direction. With F the specific
force along the axes that turn with the arm, C1, C2, C3 the constant rotations around fork
and cab of (9), and e the requested direction along seat axes, the gimbals solve ::

    Rot_z(-s3 theta3) C2' Rot_z(-s2 theta2) C1' F / |F|  =  C3 e                    (G1)

Its component along the cab's axis does not depend on theta3 and gives theta2 from an
equation ``A cos + B sin = C``; the two others give theta3. What lies along the cab's axis
can at most be what the fork has in its plane: beyond that theta2 is the nearest.

In steady turning, F is gravity and ``rho theta1'^2`` towards the arm's axis, rho the
seat's distance from it, so that ::

    theta1'^2 = sqrt(|G|^2 - g^2) / rho                                             (G2)

where rho depends on the gimbals, and they on the arm's rate: a fixed point.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from des_cli.kinematics.chain import Chain, seat_position
from des_cli.kinematics.seat import linear_acceleration_parts
from des_cli.model.arrays import Floats
from des_cli.model.machine import Machine
from des_cli.units import STANDARD_GRAVITY_M_S2

STEADY_TOLERANCE = 1e-10
"""Change of an angle [rad] in a round of the fixed point at which it has been found."""

STEADY_ROUNDS = 200
"""Rounds at most. The seat's offset from the gimbals' centre is a fraction of the arm's
length, and a round leaves about that fraction of the error."""

NO_G = 1e-6
"""Magnitude [g] below which a G-vector has no direction, and an axis in (G1) no leverage."""

PILOT = np.array([1.0, 1.0, -1.0])
"""From the pilot's signs to seat axes and back; see `kinematics.seat.pilot_g`."""


@dataclass(frozen=True)
class SteadyJoints:
    """What makes a requested G if every sample is held for long.

    Parameters
    ----------
    arm_rate : (n,) array
        Not negative, within the arm's limit [rad/s].
    gimbal : (n, 2) array
        Fork and cab, continuous in time [rad].
    """

    arm_rate: Floats
    gimbal: Floats


def requested_directions(requested: Floats) -> Floats:
    """Return unit vectors along seat axes of requested G-vectors, (n, 3).

    Where a G-vector is zero it has the direction of the one before it, at the start of
    the next; where all are zero, that of an upright seat at rest.

    Parameters
    ----------
    requested : (n, 3) array
        In the pilot's signs [g].
    """
    size = np.linalg.norm(requested, axis=1)
    known = np.flatnonzero(size > NO_G)
    if not len(known):
        return np.tile([0.0, 0.0, -1.0], (len(requested), 1))
    last = known[np.maximum(np.searchsorted(known, np.arange(len(requested)), side="right") - 1, 0)]
    return np.asarray(requested[last] * PILOT / size[last, None])


def gimbal_angles(chain: Chain, force: Floats, direction: Floats) -> Floats:
    """Return fork and cab angles that turn a force into a direction of the seat, (G1).

    Parameters
    ----------
    chain : Chain
    force : (n, 3) array
        Specific force in ground axes while the arm's angle is zero; any unit.
    direction : (n, 3) array
        Unit vectors along seat axes.

    Returns
    -------
    (n, 2) array
        Continuous along the samples, of the two solutions the one whose fork is nearer
        to zero at the first, and of whole turns those that stay nearest to zero [rad].
    """
    c0, c1, c2, c3 = (constant[:3, :3] for constant in chain.constants)
    unit = force / np.linalg.norm(force, axis=1, keepdims=True)
    u, v = unit @ c0 @ c1, direction @ c3.T
    axis = c2[:, 2]
    even = axis[0] * u[:, 0] + axis[1] * u[:, 1]
    odd = axis[0] * u[:, 1] - axis[1] * u[:, 0]
    reach = np.hypot(even, odd)
    share = (v[:, 2] - axis[2] * u[:, 2]) / np.maximum(reach, NO_G)
    middle, aside = np.unwrap(np.arctan2(odd, even)), np.arccos(np.clip(share, -1.0, 1.0))
    both = [_nearest_turn(middle + side * aside) for side in (1.0, -1.0)]
    turned = min(both, key=lambda fork: abs(float(fork[0])))
    cosine, sine = np.cos(turned), np.sin(turned)
    seen = np.stack(
        [u[:, 0] * cosine + u[:, 1] * sine, u[:, 1] * cosine - u[:, 0] * sine, u[:, 2]], axis=1
    )
    seen = seen @ c2
    cab = np.unwrap(np.arctan2(seen[:, 1], seen[:, 0]) - np.arctan2(v[:, 1], v[:, 0]))
    return np.stack([chain.signs[1] * turned, chain.signs[2] * _nearest_turn(cab)], axis=1)


def force_of_arm(
    chain: Chain, gravity: float, gimbal: Floats, rate: Floats, acceleration: Floats
) -> Floats:
    """Return the specific force that the arm alone makes, gimbals at rest, (n, 3) [m/s^2].

    In ground axes while the arm's angle is zero.

    Parameters
    ----------
    chain : Chain
    gravity : float
        [m/s^2]
    gimbal : (n, 2) array
        [rad]
    rate, acceleration : (n,) array
        Of the arm [rad/s], [rad/s^2].
    """
    nothing = np.zeros((len(gimbal), 3))
    angle, rates, accelerations = nothing.copy(), nothing.copy(), nothing.copy()
    angle[:, 1:], rates[:, 0], accelerations[:, 0] = gimbal, rate, acceleration
    parts = linear_acceleration_parts(chain, angle, rates, accelerations)
    return np.asarray(parts.sum(axis=-2) + gravity * np.array([0.0, 0.0, 1.0]))


def steady_joints(machine: Machine, chain: Chain, requested: Floats) -> SteadyJoints:
    """Return the joints that hold each requested G, (G1) and (G2).

    Less than gravity, or more than the arm's rate limit gives, cannot be held: there the
    arm stands or turns at its limit, and the direction alone is as requested.

    Parameters
    ----------
    machine : Machine
    chain : Chain
        Of the machine with its seat.
    requested : (n, 3) array
        In the pilot's signs [g].
    """
    direction = requested_directions(requested)
    size = STANDARD_GRAVITY_M_S2 * np.linalg.norm(requested, axis=1)
    inward = np.sqrt(np.maximum(size**2 - machine.gravity**2, 0.0))
    still = np.zeros(len(requested))
    gimbal = np.zeros((len(requested), 2))
    for _ in range(STEADY_ROUNDS):
        position = seat_position(chain, np.column_stack([still, gimbal]))
        radius = np.hypot(position[:, 0], position[:, 1])
        # without an arm nothing but gravity is made, however fast it turns
        squared = np.where(radius > NO_G, inward / np.maximum(radius, NO_G), 0.0)
        rate = np.minimum(np.sqrt(squared), machine.limits[0].rate)
        force = force_of_arm(chain, machine.gravity, gimbal, rate, still)
        found = gimbal_angles(chain, force, direction)
        change = float(np.max(np.abs(found - gimbal)))
        gimbal = found
        if change < STEADY_TOLERANCE:
            break
    return SteadyJoints(rate, gimbal)


def _nearest_turn(angle: Floats) -> Floats:
    """Return a continuous angle less the whole turns that keep its range nearest to zero."""
    middle = 0.5 * (float(np.max(angle)) + float(np.min(angle)))
    return np.asarray(angle - 2.0 * np.pi * np.round(middle / (2.0 * np.pi)))
