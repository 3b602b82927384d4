"""What a motion of the joints does to the seat and to the pilot in it."""

from __future__ import annotations

from dataclasses import dataclass

from des_cli.model.arrays import Floats


@dataclass(frozen=True)
class SeatResponse:
    """What is felt, at both ends of every interval, so that a rate step stays a step.

    Use ``mean_of_sides`` for values at samples and ``integrate_sides`` for
    integrals.

    Parameters
    ----------
    coriolis_seat : (n - 1, 2, 3) array
        The Coriolis vector along x, y, z of the seat [rad/s^2].
    seat_rate : (n - 1, 2, 3) array
        Angular velocity p, q, r along x, y, z of the seat [rad/s].
    seat_angular_acceleration : (n - 1, 2, 3) array
        Total angular acceleration dW/dt along x, y, z of the seat [rad/s^2], which
        is what the semicircular canals answer to: J_b theta'' + c.
    seat_g : (n - 1, 2, 3) array
        G-vector: specific force along x, y, z of the seat, gravity included
        [g]. The signs are those of ``kinematics.seat``.
    """

    coriolis_seat: Floats
    seat_rate: Floats
    seat_angular_acceleration: Floats
    seat_g: Floats


@dataclass(frozen=True)
class Response(SeatResponse):
    """What is felt, and the Coriolis vector in the axes of the study.

    Parameters
    ----------
    coriolis_report : (n - 1, 2, 3) array
        (AB3, BB3, CB3) of (22)-(24), along i0, j0, k0 [rad/s^2].
    """

    coriolis_report: Floats
