"""From a motion of the joints to everything it does at the seat."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from des_cli.kinematics.chain import Chain, chain_of, joint_axes
from des_cli.kinematics.coriolis import angular_acceleration_split, coriolis
from des_cli.kinematics.seat import (
    in_seat_axes,
    linear_acceleration_parts,
    pilot_g,
    specific_force,
)
from des_cli.model.machine import Machine, Seat
from des_cli.model.motion import DesiredMotion, Motion, Shortfall
from des_cli.model.response import Response
from des_cli.units import STANDARD_GRAVITY_M_S2


def respond(machine: Machine, seat: Seat, motion: Motion) -> Response:
    """Evaluate the seat's response at both ends of every interval.

    Parameters
    ----------
    machine : Machine
    seat : Seat
    motion : Motion
        Its acceleration is constant over each interval and holds at both ends.

    Returns
    -------
    Response
        ``seat_g`` is the G-vector in the pilot's signs, the other quantities
        are along plain axes; see ``kinematics.seat``.
    """
    return respond_on(chain_of(machine, seat), machine.gravity, motion)


def respond_on(chain: Chain, gravity: float, motion: Motion) -> Response:
    """Evaluate the response of a chain under a gravity [m/s^2]; see `respond`."""
    angles, rates = motion.angle_sides, motion.rate_sides
    accelerations = np.broadcast_to(motion.acceleration[:, None, :], rates.shape)
    parts = linear_acceleration_parts(chain, angles, rates, accelerations)
    force = specific_force(chain, angles, parts.sum(axis=-2), gravity)
    spin = rates[..., None, :] @ joint_axes(chain, angles, "seat")
    # dW/dt is the same vector whether W is taken along ground or along seat axes, for
    # the seat's own turning adds W x W = 0.
    noncoriolis, cross = angular_acceleration_split(chain, angles, rates, accelerations, "seat")
    return Response(
        coriolis_report=coriolis(chain, angles, rates, "report"),
        coriolis_seat=cross,
        seat_rate=spin[..., 0, :],
        seat_angular_acceleration=noncoriolis + cross,
        seat_parts=in_seat_axes(chain, angles, parts) / STANDARD_GRAVITY_M_S2,
        seat_g=pilot_g(force),
    )


def respond_as_requested(machine: Machine, seat: Seat, requested: DesiredMotion) -> Response:
    """Evaluate what a profile asks of the seat, beyond what its joint motion makes.

    Parameters
    ----------
    machine, seat, requested

    Returns
    -------
    Response
        Rate, angular acceleration and G as the record has them; the cross-coupling and
        the parts of the linear acceleration are those of the joint motion, which alone
        makes any.
    """
    return with_shortfall(respond(machine, seat, requested.motion), requested.shortfall)


def with_shortfall(response: Response, shortfall: Shortfall | None) -> Response:
    """Return a response of a joint motion with the shortfall added."""
    if shortfall is None:
        return response
    return replace(
        response,
        seat_rate=response.seat_rate + shortfall.seat_rate,
        seat_angular_acceleration=response.seat_angular_acceleration
        + shortfall.seat_angular_acceleration,
        seat_g=response.seat_g + shortfall.seat_g,
    )
