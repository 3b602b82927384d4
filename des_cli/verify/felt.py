"""What the seat does along a motion, evaluated by a way of its own.

Of the rest of the program this shares the machine's Denavit-Hartenberg rows, as data, and
nothing else: no chain, no Jacobian, no joint axes. The pose of the seat in the ground
frame is a product of 4 x 4 transforms, and its derivatives in time are carried through
that product exactly. With ``Q = d Rot_z / d angle  Rot_z^-1`` every joint turns its part X
of the chain by::

    Y   = Rot_z X
    Y'  = Rot_z X' + theta' Q Y
    Y'' = Rot_z X'' + 2 theta' Q (Rot_z X') + theta'^2 Q^2 Y + theta'' Q Y

The last term, linear in the accelerations, is carried apart: without it R'' is that of
constant joint rates, whose turning is the cross-coupling. From R and p, in seat axes::

    [W x] = R' R' of the joints,  dW/dt = antisymmetric part of R^T R'',  f = R^T (p'' + g z0)
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, DHRow, Machine, Seat
from des_cli.model.motion import Motion
from des_cli.units import STANDARD_GRAVITY_M_S2

CHUNK = 2048
"""States evaluated at a time, so that temporaries stay in a core's cache."""

VALUE, FIRST, SECOND, EULER = range(4)
"""What is carried through the chain: a value, its first derivative in time, its second at
constant joint rates, and what the joints' accelerations add to the second."""


@dataclass(frozen=True)
class Felt:
    """What the seat does at m states, along its axes x, y, z.

    Parameters
    ----------
    rate : (3, m) array
        Angular velocity W [rad/s].
    cross : (3, m) array
        Its change at constant joint rates, the cross-coupling [rad/s^2].
    turning : (3, m) array
        Its whole change dW/dt [rad/s^2].
    g : (3, m) array
        G-vector in the pilot's signs [g].
    rotation : (3, 3, m) array
        From seat to ground axes.
    angle : (3, m) array
        Of the joints [rad].
    """

    rate: Floats
    cross: Floats
    turning: Floats
    g: Floats
    rotation: Floats
    angle: Floats

    def part(self, states: NDArray[np.intp]) -> Felt:
        """Return some of the states."""
        fields = (self.rate, self.cross, self.turning, self.g, self.rotation, self.angle)
        return Felt(*(values[..., states] for values in fields))

    @cached_property
    def cross_ground(self) -> Floats:
        """The cross-coupling along ground axes, (3, m) [rad/s^2]."""
        return np.asarray(np.einsum("ijm,jm->im", self.rotation, self.cross))

    @cached_property
    def rate_ground(self) -> Floats:
        """The angular velocity along ground axes, (3, m) [rad/s]."""
        return np.asarray(np.einsum("ijm,jm->im", self.rotation, self.rate))


@dataclass(frozen=True)
class SeatChain:
    """A machine's rows and how its seat is fixed: what an evaluation needs."""

    machine: Machine
    seat: Seat

    def at(self, angle: Floats, rate: Floats, acceleration: Floats) -> Felt:
        """Evaluate states.

        Parameters
        ----------
        angle, rate, acceleration : (m, 3) array
            Of arm, fork, cab [rad], [rad/s], [rad/s^2].
        """
        m = len(angle)
        vectors = np.empty((4, 3, m))
        rotation = np.empty((3, 3, m))
        for first in range(0, m, CHUNK):
            part = slice(first, first + CHUNK)
            pose = self._pose(angle[part].T, rate[part].T, acceleration[part].T)
            rotation[..., part] = pose[:, VALUE, :3]
            self._take(pose, vectors[..., part])
        rates, cross, turning, g = vectors
        return Felt(rates, cross, turning, g, rotation, angle.T)

    def along(self, motion: Motion) -> Felt:
        """Evaluate a motion at the start of every interval, then at the end of every one.

        Returns
        -------
        Felt
            Of m = 2 (n - 1) states.
        """
        return self.at(
            np.concatenate([motion.angle[:-1], motion.angle[1:]]),
            np.concatenate([motion.rate_start, motion.rate_end]),
            np.concatenate([motion.acceleration] * 2),
        )

    def _pose(self, angle: Floats, rate: Floats, acceleration: Floats) -> Floats:
        """Return R and p with their derivatives, (3 row, 4 carried, 4 column, m)."""
        constants, signs = _constants(self.machine.rows, self.seat)
        pose = np.zeros((3, 4, 4, angle.shape[1]))
        pose[:, VALUE] = constants[-1][:3, :, None]
        for joint in reversed(range(len(JOINTS))):
            sign = signs[joint]
            pose = _turned(
                pose, sign * angle[joint], sign * rate[joint], sign * acceleration[joint]
            )
            pose = _placed(constants[joint], pose)
        return pose

    def _take(self, pose: Floats, out: Floats) -> None:
        """Write rate, cross-coupling, dW/dt and G of a pose, (4, 3, m)."""
        r, first, second, euler = (pose[:, k, :3] for k in range(4))
        cross, turned = out[1], out[2]
        for x, (y, z) in enumerate(((1, 2), (2, 0), (0, 1))):
            out[0, x] = _dot(r[:, z], first[:, y])
            cross[x] = 0.5 * (_dot(r[:, z], second[:, y]) - _dot(r[:, y], second[:, z]))
            turned[x] = _dot(r[:, z], euler[:, y])
        turned += cross
        lifted = pose[:, SECOND, 3] + pose[:, EULER, 3]
        lifted[2] += self.machine.gravity
        out[3] = np.einsum("ijm,im->jm", r, lifted) / STANDARD_GRAVITY_M_S2
        out[3, 2] *= -1.0  # +Gz is eyeballs down, and z is down: the seat pushes up


def _turned(pose: Floats, angle: Floats, rate: Floats, acceleration: Floats) -> Floats:
    """Return a pose turned about z by a joint that moves."""
    cosine, sine = np.cos(angle), np.sin(angle)
    out = np.empty_like(pose)
    out[0] = cosine * pose[0] - sine * pose[1]
    out[1] = sine * pose[0] + cosine * pose[1]
    out[2] = pose[2]
    # Q maps rows (0, 1) to (-1, 0); the second derivative comes first, it needs the turned
    # first one without this joint's own share.
    value, first, second, euler = (out[:2, k] for k in range(4))
    square, twice = rate * rate, 2.0 * rate
    second[0] -= twice * first[1] + square * value[0]
    second[1] += twice * first[0] - square * value[1]
    first[0] -= rate * value[1]
    first[1] += rate * value[0]
    euler[0] -= acceleration * value[1]
    euler[1] += acceleration * value[0]
    return out


def _placed(constant: Floats, pose: Floats) -> Floats:
    """Return a pose after a constant transform."""
    out = (constant[:3, :3] @ pose.reshape(3, -1)).reshape(pose.shape)
    out[:, VALUE, 3] += constant[:3, 3, None]
    return out


def _dot(one: Floats, other: Floats) -> Floats:
    return np.asarray(one[0] * other[0] + one[1] * other[1] + one[2] * other[2])


@lru_cache(maxsize=64)
def _constants(rows: tuple[DHRow, ...], seat: Seat) -> tuple[tuple[Floats, ...], tuple[int, ...]]:
    """Return the transforms before, between and after the joints, and the joints' signs."""
    fixed = {"seat_yaw": seat.yaw, "seat_pitch": seat.pitch}
    constants, signs = [np.eye(4)], []
    for row in rows:
        joint = row.variable in JOINTS
        turn = 0.0 if joint or row.variable is None else row.sign * fixed[row.variable]
        constants[-1] = constants[-1] @ _link(row.alpha, row.a, row.offset + turn)
        if joint:
            signs.append(row.sign)
            constants.append(np.eye(4))
        constants[-1] = constants[-1] @ _raised(row.d)
    return tuple(constants), tuple(signs)


def _link(alpha: float, a: float, theta: float) -> Floats:
    """Return ``Rot_x(alpha) Trans_x(a) Rot_z(theta)``, written out."""
    (ca, sa), (ct, st) = ((math.cos(v), math.sin(v)) for v in (alpha, theta))
    return np.array(
        [
            [ct, -st, 0.0, a],
            [ca * st, ca * ct, -sa, 0.0],
            [sa * st, sa * ct, ca, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def _raised(d: float) -> Floats:
    transform = np.eye(4)
    transform[2, 3] = d
    return transform
