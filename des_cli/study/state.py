"""Every quantity of the study at given states of the joints, to look at and to compare.

The solvers need few of them and compute those elsewhere; here each has its own
name, frame and equation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from des_cli.kinematics.chain import chain_of, linear_jacobian, transform
from des_cli.kinematics.coriolis import angular_acceleration_split
from des_cli.kinematics.orientation import body_jacobian, ground_jacobian
from des_cli.kinematics.seat import (
    in_seat_axes,
    linear_acceleration_parts,
    pilot_g,
    specific_force,
)
from des_cli.model.arrays import Floats
from des_cli.model.machine import Machine, Seat
from des_cli.model.motion import Motion, mean_of_sides
from des_cli.study.closed_forms import seat_turn
from des_cli.units import STANDARD_GRAVITY_M_S2


@dataclass(frozen=True)
class StateReport:
    """The kinematics of n states; "ground" is along i0, j0, k0, "seat" along x, y, z.

    Parameters
    ----------
    angle, rate, acceleration : (n, 3) array
        Of arm, fork, cab [rad], [rad/s], [rad/s^2].
    t_0_17 : (n, 4, 4) array
        Seat frame to ground frame, (9) [m].
    j1 : (n, 3, 3) array
        Seat velocity along ground axes per joint rate, (12) [m/rad].
    j2 : (n, 3, 3) array
        J2 of (32), ``M(seat) J_in``.
    ground_jacobian, body_jacobian : (n, 3, 3) array
        Angular velocity along ground and along seat axes per joint rate.
    j1_determinant : (n,) array
        [m^3]
    orientation_determinant : (n,) array
        Of J2, the ground and the body Jacobian alike: they differ by rotations.
    singular_values : (n, 3) array
        Of the same three, largest first; the last is the distance to the
        singularity.
    w_ground, w_eq32, w_seat : (n, 3) array
        Angular velocity along ground axes, the axes of (32), seat axes [rad/s].
    angular_ground, angular_seat : (n, 3) array
        Angular acceleration, (16)-(18) [rad/s^2].
    coriolis_ground, coriolis_seat : (n, 3) array
        Its Coriolis part, (22)-(24) [rad/s^2].
    position, velocity : (n, 3) array
        Of the seat, along ground axes [m], [m/s].
    parts_ground : (n, 4, 3) array
        Seat acceleration along ground axes: tangential, centripetal, Coriolis
        part, and their sum [m/s^2].
    parts_seat : (n, 4, 3) array
        The same along seat axes [g].
    specific_force : (n, 3) array
        What an accelerometer at the seat reads, along seat axes [g].
    g_vector : (n, 3) array
        (Gx, Gy, Gz): eyeballs in, left, down [g].
    """

    angle: Floats
    rate: Floats
    acceleration: Floats
    t_0_17: Floats
    j1: Floats
    j2: Floats
    ground_jacobian: Floats
    body_jacobian: Floats
    j1_determinant: Floats
    orientation_determinant: Floats
    singular_values: Floats
    w_ground: Floats
    w_eq32: Floats
    w_seat: Floats
    angular_ground: Floats
    angular_seat: Floats
    coriolis_ground: Floats
    coriolis_seat: Floats
    position: Floats
    velocity: Floats
    parts_ground: Floats
    parts_seat: Floats
    specific_force: Floats
    g_vector: Floats


def report_states(
    machine: Machine, seat: Seat, angle: Floats, rate: Floats, acceleration: Floats
) -> StateReport:
    """Compute every quantity at n states.

    Parameters
    ----------
    machine : Machine
    seat : Seat
    angle, rate, acceleration : (n, 3) array
        Of arm, fork, cab [rad], [rad/s], [rad/s^2].

    Returns
    -------
    StateReport
    """
    angle, rate, acceleration = (np.asarray(values) for values in (angle, rate, acceleration))
    chain = chain_of(machine, seat)
    frame = transform(chain, angle)
    j1, ground = linear_jacobian(chain, angle), ground_jacobian(chain, angle)
    body, j2 = body_jacobian(chain, angle), seat_turn(seat) @ ground
    linear, ground_coriolis = angular_acceleration_split(chain, angle, rate, acceleration, "report")
    felt, seat_coriolis = angular_acceleration_split(chain, angle, rate, acceleration, "seat")
    parts = linear_acceleration_parts(chain, angle, rate, acceleration)
    total = parts.sum(axis=-2)
    parts = np.concatenate([parts, total[:, None]], axis=1)
    force = specific_force(chain, angle, total, machine.gravity)
    return StateReport(
        angle=angle,
        rate=rate,
        acceleration=acceleration,
        t_0_17=frame,
        j1=j1,
        j2=j2,
        ground_jacobian=ground,
        body_jacobian=body,
        j1_determinant=np.linalg.det(j1),
        orientation_determinant=np.linalg.det(ground),
        singular_values=np.array(np.linalg.svd(ground, compute_uv=False), dtype=np.float64),
        w_ground=_apply(ground, rate),
        w_eq32=_apply(j2, rate),
        w_seat=_apply(body, rate),
        angular_ground=linear + ground_coriolis,
        angular_seat=felt + seat_coriolis,
        coriolis_ground=ground_coriolis,
        coriolis_seat=seat_coriolis,
        position=frame[:, :3, 3],
        velocity=_apply(j1, rate),
        parts_ground=parts,
        parts_seat=in_seat_axes(chain, angle, parts) / STANDARD_GRAVITY_M_S2,
        specific_force=force,
        g_vector=pilot_g(force),
    )


def report_motion(machine: Machine, seat: Seat, motion: Motion) -> StateReport:
    """Compute every quantity at each sample of a motion.

    Where the rate or the acceleration steps, the state at the sample has the
    mean of both sides.
    """
    acceleration = motion.acceleration
    sides = np.stack([acceleration, acceleration], axis=1)
    return report_states(machine, seat, motion.angle, motion.rate, mean_of_sides(sides))


def _apply(matrix: Floats, vector: Floats) -> Floats:
    return np.asarray((matrix @ vector[..., None])[..., 0])
