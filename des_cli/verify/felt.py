"""What the seat does along a motion, evaluated by a way of its own.

Of the rest of the program this shares the machine's Denavit-Hartenberg rows, as data, and
nothing else: no chain, no Jacobian, no joint axes. From the ground to the seat, frame by
frame, four vectors are carried along the axes of each frame: its angular velocity W, how
that changes at constant joint rates (the cross-coupling), how it changes in all, and the
acceleration of its origin, which gravity's reaction g z0 is added to at the ground. A
constant transform of rotation R and shift p leaves the first three but for their axes, and
makes of the acceleration a::

    R^T (a + dW/dt x p + W x (W x p))

and a joint that turns about its z by an angle theta adds its own rate and acceleration,
and what the rate of all before it makes of its axis, W x z theta'. At the seat the last is
the specific force.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, DHRow, Machine, Seat
from des_cli.model.motion import Motion
from des_cli.units import STANDARD_GRAVITY_M_S2
from des_cli.verify.rotations import exponential

CHUNK = 2048
"""States evaluated at a time, so that temporaries stay in a core's cache."""

RATE, CROSS, TURNING, FORCE = range(4)
"""The vectors that are carried through the chain."""

Turn = tuple[Floats, Floats]
"""Cosine and sine of what a joint turns its frame by, (m,) each."""


@dataclass(frozen=True, eq=False)
class Attitudes:
    """Attitudes of the seat in the ground, evaluated when they are asked for.

    Parameters
    ----------
    chain : SeatChain
    angle : (k, 3) array
        Of the joints [rad].
    sided : bool
        Whether these are the samples of a motion, of which the states are the starts of
        all intervals and then their ends; else they are the states' own.
    turn : (k, 3) array, optional
        Rotation vectors along seat axes by which the seat is turned further [rad].
    """

    chain: SeatChain
    angle: Floats
    sided: bool = False
    turn: Floats | None = None

    def matrices(self, samples: slice = slice(None)) -> Floats:
        """Return the rotations from seat to ground axes, (3, 3, k)."""
        made = self.chain.rotation(self.angle[samples])
        if self.turn is None:
            return made
        return np.asarray(np.einsum("ijm,jkm->ikm", made, exponential(self.turn[samples])))

    def blocks(self) -> Iterator[tuple[slice, Floats]]:
        """Yield samples and their rotations, block by block."""
        for first in range(0, len(self.angle), CHUNK):
            samples = slice(first, min(first + CHUNK, len(self.angle)))
            yield samples, self.matrices(samples)

    def part(self, states: NDArray[np.intp]) -> Attitudes:
        """Return those of some states."""
        count = len(self.angle) - 1
        at = np.where(states < count, states, states - count + 1) if self.sided else states
        turn = None if self.turn is None else self.turn[at]
        return Attitudes(self.chain, self.angle[at], turn=turn)

    def block(self, states: slice) -> Attitudes:
        """Return those of neighbouring states, of a motion starts alone or ends alone."""
        count = len(self.angle) - 1
        shift = 1 - count if self.sided and states.start >= count else 0
        at = slice(states.start + shift, states.stop + shift)
        turn = None if self.turn is None else self.turn[at]
        return Attitudes(self.chain, self.angle[at], turn=turn)

    def at_states(self, values: Floats) -> Floats:
        """Return values at the samples, (..., k), at the states, (..., m)."""
        if not self.sided:
            return values
        return np.concatenate([values[..., :-1], values[..., 1:]], axis=-1)


@dataclass(frozen=True, eq=False)
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
    attitudes : Attitudes
    """

    rate: Floats
    cross: Floats
    turning: Floats
    g: Floats
    attitudes: Attitudes

    def part(self, states: NDArray[np.intp]) -> Felt:
        """Return some of the states."""
        return Felt(
            rate=self.rate[:, states],
            cross=self.cross[:, states],
            turning=self.turning[:, states],
            g=self.g[:, states],
            attitudes=self.attitudes.part(states),
        )

    def block(self, states: slice) -> Felt:
        """Return neighbouring states, of a motion starts alone or ends alone, without a copy."""
        return Felt(
            rate=self.rate[:, states],
            cross=self.cross[:, states],
            turning=self.turning[:, states],
            g=self.g[:, states],
            attitudes=self.attitudes.block(states),
        )

    @property
    def angle(self) -> Floats:
        """Of the joints, (3, m) [rad]."""
        return self.attitudes.at_states(self.attitudes.angle.T)

    @property
    def rotation(self) -> Floats:
        """From seat to ground axes, (3, 3, m)."""
        return self.attitudes.at_states(self.attitudes.matrices())

    @cached_property
    def cross_ground(self) -> Floats:
        """The cross-coupling along ground axes, (3, m) [rad/s^2]."""
        return self._in_ground(self.cross)

    @cached_property
    def rate_ground(self) -> Floats:
        """The angular velocity along ground axes, (3, m) [rad/s]."""
        return self._in_ground(self.rate)

    def _in_ground(self, vectors: Floats) -> Floats:
        found, attitudes = np.empty_like(vectors), self.attitudes
        last = len(attitudes.angle) - 1
        for samples, rotation in attitudes.blocks():
            first, end = samples.start, samples.stop
            if not attitudes.sided:
                _turn_into(found, vectors, rotation, samples)
                continue
            starts, before = slice(first, min(end, last)), max(first, 1)
            _turn_into(found, vectors, rotation[..., : starts.stop - first], starts)
            ends = slice(last + before - 1, last + end - 1)
            _turn_into(found, vectors, rotation[..., before - first :], ends)
        return found


def _turn_into(found: Floats, vectors: Floats, rotation: Floats, states: slice) -> None:
    """Write vectors, turned by rotations (3, 3, k), at k states."""
    x, y, z = (each[states] for each in vectors)
    for row, out in zip(rotation, found, strict=True):
        out[states] = row[0] * x + row[1] * y + row[2] * z


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
        for first in range(0, m, CHUNK):
            part = slice(first, min(first + CHUNK, m))
            turns = self._turns(angle[part])
            self._carry(turns, rate[part].T, acceleration[part].T, vectors[..., part])
        rates, cross, turning, g = vectors
        return Felt(rates, cross, turning, g, Attitudes(self, angle))

    def along(self, motion: Motion) -> Felt:
        """Evaluate a motion at the start of every interval, then at the end of every one.

        Returns
        -------
        Felt
            Of m = 2 (n - 1) states.
        """
        count = len(motion.t) - 1
        vectors = np.empty((4, 3, 2 * count))
        for part, sides in self.blocks(motion):
            for shift, side in zip((0, count), sides, strict=True):
                vectors[..., shift + part.start : shift + part.stop] = side
        rates, cross, turning, g = vectors
        return Felt(rates, cross, turning, g, Attitudes(self, motion.angle, sided=True))

    def blocks(self, motion: Motion) -> Iterator[tuple[slice, Floats]]:
        """Yield intervals, with the vectors at their starts and at their ends, (2, 4, 3, m).

        Rate, cross-coupling, dW/dt and G, as of `Felt`; overwritten by the next block.
        """
        count = len(motion.t) - 1
        held = np.empty((2, 4, 3, min(CHUNK, count)))
        for first in range(0, count, CHUNK):
            last = min(first + CHUNK, count)
            start, end = motion.rate_start[first:last].T, motion.rate_end[first:last].T
            acceleration = (end - start) / (motion.t[first + 1 : last + 1] - motion.t[first:last])
            turns = self._turns(motion.angle[first : last + 1])
            sides = held[..., : last - first]
            for side, rate in enumerate((start, end)):
                at = slice(side, side + last - first)
                here = [(cosine[at], sine[at]) for cosine, sine in turns]
                self._carry(here, rate, acceleration, sides[side])
            yield slice(first, last), sides

    def axes(self, angle: Floats) -> Floats:
        """Return W along seat axes per unit rate of each joint, (m, 3, 3 joint)."""
        found = np.empty((len(angle), 3, len(JOINTS)))
        still = np.zeros((len(JOINTS), min(CHUNK, len(angle))))
        vectors = np.empty((4, 3, still.shape[1]))
        for first in range(0, len(angle), CHUNK):
            turns = self._turns(angle[first : first + CHUNK])
            m = len(turns[0][0])
            for joint, unit in enumerate(np.eye(len(JOINTS))):
                rate = np.broadcast_to(unit[:, None], (len(JOINTS), m))
                self._carry(turns, rate, still[:, :m], vectors[..., :m])
                found[first : first + m, :, joint] = vectors[RATE, :, :m].T
        return found

    def rotation(self, angle: Floats) -> Floats:
        """Return the rotations from seat to ground axes at angles (m, 3), (3, 3, m)."""
        constants, _ = _constants(self.machine.rows, self.seat)
        rotation = np.empty((3, 3, len(angle)))
        for first in range(0, len(angle), CHUNK):
            turns = self._turns(angle[first : first + CHUNK])
            columns = np.repeat(constants[-1][:3, :3, None], len(turns[0][0]), axis=2)
            for (cosine, sine), constant in zip(reversed(turns), constants[-2::-1], strict=True):
                x, y = columns[0], columns[1]
                turned = np.stack([cosine * x - sine * y, sine * x + cosine * y, columns[2]])
                columns = (constant[:3, :3] @ turned.reshape(3, -1)).reshape(turned.shape)
            rotation[..., first : first + columns.shape[2]] = columns
        return rotation

    def _turns(self, angle: Floats) -> list[Turn]:
        """Return what each joint turns its frame by."""
        _, signs = _constants(self.machine.rows, self.seat)
        return [
            (np.cos(theta), sign * np.sin(theta))
            for theta, sign in zip(angle.T, signs, strict=True)
        ]

    def _carry(
        self, turns: Sequence[Turn], rate: Floats, acceleration: Floats, out: Floats
    ) -> None:
        """Write rate, cross-coupling, dW/dt and G at states, (4, 3, m).

        Parameters
        ----------
        turns : sequence of Turn
        rate, acceleration : (3, m) array
            Of the joints [rad/s], [rad/s^2].
        out : (4, 3, m) array
        """
        constants, signs = _constants(self.machine.rows, self.seat)
        carried = np.zeros((3, 4, out.shape[2]))
        # What the first joint stands on does not move.
        reaction = self.machine.gravity * constants[0][2, :3]
        carried[:, FORCE] = reaction[:, None]
        if np.any(reaction[:2]):
            cosine, sine = turns[0]
            carried[0, FORCE] = cosine * reaction[0] + sine * reaction[1]
            carried[1, FORCE] = cosine * reaction[1] - sine * reaction[0]
        carried[2, RATE] = signs[0] * rate[0]
        carried[2, TURNING] = signs[0] * acceleration[0]
        for joint in range(1, len(JOINTS)):
            carried = _placed(constants[joint], carried)
            moving = signs[joint] * rate[joint], signs[joint] * acceleration[joint]
            carried = _turned(carried, turns[joint], *moving)
        carried = _placed(constants[-1], carried)
        out[:] = carried.swapaxes(0, 1)
        out[FORCE] /= STANDARD_GRAVITY_M_S2
        out[FORCE, 2] *= -1.0  # +Gz is eyeballs down, and z is down: the seat pushes up


def _turned(carried: Floats, turn: Turn, rate: Floats, acceleration: Floats) -> Floats:
    """Return vectors (3, 4, m) along the axes of a frame that a joint turns about their z."""
    cosine, sine = turn
    out = np.empty_like(carried)
    out[0] = cosine * carried[0] + sine * carried[1]
    out[1] = cosine * carried[1] - sine * carried[0]
    out[2] = carried[2]
    swept_x, swept_y = rate * out[1, RATE], rate * out[0, RATE]  # W x z theta', but for a sign
    for vector in (CROSS, TURNING):
        out[0, vector] += swept_x
        out[1, vector] -= swept_y
    out[2, RATE] += rate
    out[2, TURNING] += acceleration
    return out


def _placed(constant: Floats, carried: Floats) -> Floats:
    """Return vectors (3, 4, m) of a frame that a constant transform places in theirs."""
    shift = constant[:3, 3]
    if np.any(shift):
        rate, turning, force = carried[:, RATE], carried[:, TURNING], carried[:, FORCE]
        force += _cross_with(shift) @ turning
        force += rate * (shift @ rate) - shift[:, None] * np.sum(rate * rate, axis=0)
    along = constant[:3, :3].T @ carried.reshape(3, -1)
    return np.asarray(along.reshape(carried.shape))


def _cross_with(vector: Floats) -> Floats:
    """Return the matrix that makes a cross product with a vector on the right, (3, 3)."""
    x, y, z = vector
    return np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])


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
