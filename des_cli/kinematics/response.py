"""From a motion of the joints to everything it does at the seat.

Long motions are evaluated in blocks that stay in the processor's cache.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar
from weakref import WeakKeyDictionary

import numpy as np

from des_cli.kinematics.chain import Chain, chain_of, joint_axes
from des_cli.kinematics.coriolis import angular_acceleration_split
from des_cli.kinematics.coriolis_along import coriolis_along
from des_cli.kinematics.seat import (
    PILOT_SIGNS,
    in_seat_axes,
    linear_acceleration_parts,
    pilot_g,
    specific_force,
)
from des_cli.kinematics.twist import SeatForms, seat_forms
from des_cli.model.arrays import Floats
from des_cli.model.machine import Machine, Seat
from des_cli.model.motion import DesiredMotion, Motion, Shortfall
from des_cli.model.response import Response, SeatResponse
from des_cli.units import STANDARD_GRAVITY_M_S2

BLOCK = 2048
"""Intervals that are evaluated at a time."""

AnyResponse = TypeVar("AnyResponse", bound=SeatResponse)


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
    chain = chain_of(machine, seat)
    felt = respond_on(chain, machine.gravity, motion)
    return Response(
        felt.coriolis_seat,
        felt.seat_rate,
        felt.seat_angular_acceleration,
        felt.seat_g,
        coriolis_report=coriolis_along(chain, motion, "report"),
    )


def respond_on(chain: Chain, gravity: float, motion: Motion) -> SeatResponse:
    """Evaluate what is felt on a chain under a gravity [m/s^2]; see `respond`.

    Asked again for the same motion, as long as that is there, this returns the same object.
    """
    made = _made.setdefault(motion, {})
    if (chain, gravity) not in made:
        forms = seat_forms(chain, gravity)
        made[chain, gravity] = (
            _by_screws(forms, motion) if forms.vertical else _by_chain(chain, gravity, motion)
        )
    return made[chain, gravity]


_made: WeakKeyDictionary[Motion, dict[tuple[Chain, float], SeatResponse]] = WeakKeyDictionary()
"""The desired motion is compared with many, and is not to be evaluated anew for each."""


def _by_screws(forms: SeatForms, motion: Motion) -> SeatResponse:
    """Evaluate the seat's twist, for an arm that turns about the vertical."""
    intervals = len(motion.step)
    felt = [np.empty((intervals, 2, 3)) for _ in range(4)]
    cross, spin, turning, g = felt
    to_g = PILOT_SIGNS[:, None] / STANDARD_GRAVITY_M_S2
    for first in range(0, intervals, BLOCK):
        part = slice(first, min(first + BLOCK, intervals))
        start, end = motion.rate_start[part], motion.rate_end[part]
        acceleration = ((end - start) / motion.step[part, None]).T
        z = np.zeros((8, len(start) + 1))
        z[:2] = motion.angle[first : part.stop + 1, 1:].T
        samples = forms.at(z)
        for side, rate in enumerate((start, end)):
            # Both sides of a sample have the same angles.
            at = slice(side, side + len(start))
            seat = samples.moving(at, np.ascontiguousarray(rate.T), acceleration)
            cross[part, side] = seat.products[:3].T
            spin[part, side] = seat.twist[:3].T
            turning[part, side] = seat.twist_rate[:3].T
            g[part, side] = (to_g * seat.force).T
    return SeatResponse(*felt)


def _by_chain(chain: Chain, gravity: float, motion: Motion) -> SeatResponse:
    angles, rates = motion.angle_sides, motion.rate_sides
    accelerations = np.broadcast_to(motion.acceleration[:, None, :], rates.shape)
    parts = linear_acceleration_parts(chain, angles, rates, accelerations)
    force = specific_force(chain, angles, parts.sum(axis=-2), gravity)
    spin = rates[..., None, :] @ joint_axes(chain, angles, "seat")
    # dW/dt is the same vector whether W is taken along ground or along seat axes, for
    # the seat's own turning adds W x W = 0.
    noncoriolis, cross = angular_acceleration_split(chain, angles, rates, accelerations, "seat")
    return SeatResponse(cross, spin[..., 0, :], noncoriolis + cross, pilot_g(force))


def acceleration_parts(chain: Chain, motion: Motion) -> Floats:
    """Split the seat's linear acceleration at both ends of every interval.

    Parameters
    ----------
    chain : Chain
    motion : Motion

    Returns
    -------
    (n - 1, 2, 3, 3) array
        Tangential, centripetal and Coriolis part (third axis), gravity left out, along
        x, y, z of the seat [g].
    """
    angles, rates = motion.angle_sides, motion.rate_sides
    accelerations = np.broadcast_to(motion.acceleration[:, None, :], rates.shape)
    parts = linear_acceleration_parts(chain, angles, rates, accelerations)
    return in_seat_axes(chain, angles, parts) / STANDARD_GRAVITY_M_S2


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


def with_shortfall(response: AnyResponse, shortfall: Shortfall | None) -> AnyResponse:
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
