"""The machine: a chain of three revolute joints, their limits, and gravity."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from des_cli.units import STANDARD_GRAVITY_M_S2

Joint: TypeAlias = Literal["arm", "fork", "cab"]
JOINTS: tuple[Joint, Joint, Joint] = ("arm", "fork", "cab")
"""The joints from the ground outward; index 0, 1, 2 of every joint axis."""

Variable: TypeAlias = Literal["arm", "fork", "cab", "seat_yaw", "seat_pitch"]


@dataclass(frozen=True, slots=True)
class DHRow:
    """One row of a modified Denavit-Hartenberg table (Craig).

    ``A_i = Rot_x(alpha) Trans_x(a) Rot_z(theta) Trans_z(d)`` with
    ``theta = offset + sign * variable``.

    Parameters
    ----------
    alpha, offset : float
        Angles [rad].
    a, d : float
        Lengths [m].
    variable : str, optional
        The joint, or the seat angle, that turns this row; None for a fixed row.
    sign : int
        +1 or -1.
    """

    alpha: float = 0.0
    a: float = 0.0
    d: float = 0.0
    offset: float = 0.0
    variable: Variable | None = None
    sign: int = 1


@dataclass(frozen=True, slots=True)
class JointLimits:
    """What one joint may do; each bound holds for both directions.

    Parameters
    ----------
    angle : float
        [rad]; infinite for a joint that turns endlessly.
    rate : float
        [rad/s]
    acceleration : float
        [rad/s^2]
    jerk : float
        [rad/s^3]; infinite where the machine has no such limit.
    """

    angle: float
    rate: float
    acceleration: float
    jerk: float = math.inf


ASSUMED_JERK_PER_ACCELERATION = 2.0
"""Jerk limit of a joint over its acceleration limit [1/s] where nobody published one: the
acceleration then takes half a second from zero to its limit."""

UNBOUNDED = (-math.inf, math.inf)


@dataclass(frozen=True, slots=True)
class OccupantBounds:
    """What the person in the seat may get; what is not bounded is infinite.

    Parameters
    ----------
    gx, gy, gz : tuple of float
        Least and most of each component of the G-vector [g], in the pilot's
        signs (``kinematics.seat``).
    g_onset : float
        Largest rate of change of any component of the G-vector, in magnitude [g/s].
    angular_acceleration : float
        Largest magnitude of the seat's total angular acceleration dW/dt [rad/s^2].
    """

    gx: tuple[float, float] = UNBOUNDED
    gy: tuple[float, float] = UNBOUNDED
    gz: tuple[float, float] = UNBOUNDED
    g_onset: float = math.inf
    angular_acceleration: float = math.inf

    @property
    def bounded(self) -> bool:
        """Whether anything is bounded at all."""
        return self != OccupantBounds()


@dataclass(frozen=True, slots=True)
class Seat:
    """How the seat is fixed in the cab.

    Parameters
    ----------
    yaw, pitch : float
        theta_sy and theta_st of the study [rad].
    """

    yaw: float = math.pi / 2
    pitch: float = 0.0


@dataclass(frozen=True, slots=True)
class Machine:
    """A centrifuge with the joints arm, fork and cab.

    Parameters
    ----------
    name : str
    rows : tuple of DHRow
        The chain from the ground to the seat; arm, fork and cab stand in it
        once each and in this order.
    limits : tuple of JointLimits
        For arm, fork, cab.
    gravity : float
        [m/s^2], along -z of the ground frame.
    lengths : mapping of str to float
        The named dimensions [m] that the rows were made of, for display.
    source : str
        Where the dimensions and limits come from.
    occupant : OccupantBounds
        What the person in the seat may get.
    """

    name: str
    rows: tuple[DHRow, ...]
    limits: tuple[JointLimits, JointLimits, JointLimits]
    gravity: float = STANDARD_GRAVITY_M_S2
    lengths: Mapping[str, float] = field(default_factory=dict)
    source: str = ""
    occupant: OccupantBounds = field(default_factory=OccupantBounds)
