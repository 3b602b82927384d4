"""A motion of the three joints over a grid of sample times."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from des_cli.model.arrays import Flags, Floats, freeze

if TYPE_CHECKING:
    from des_cli.model.profile import BodyRates


PIECE = 8192
"""Samples of a piece of a motion: what is made of one stays in a processor's cache."""

_BESIDE = 2
"""Samples on either side that a piece has beside its own: a jerk is made of three."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Joint angles at samples, and joint rates at both ends of every interval.

    Between two samples the acceleration is constant and the rate linear. A
    rate may step at a sample, where two segments of a maneuver join: it is
    therefore kept by interval and never smeared across the step.

    Parameters
    ----------
    t : (n,) array
        Sample times, strictly increasing [s].
    angle : (n, 3) array
        Arm, fork, cab [rad].
    rate_start, rate_end : (n - 1, 3) array
        Joint rates just after the first and just before the last sample of
        each interval [rad/s].
    """

    t: Floats
    angle: Floats
    rate_start: Floats
    rate_end: Floats

    def __post_init__(self) -> None:
        freeze(self, "t", (None,))
        n = len(self.t)
        freeze(self, "angle", (n, 3))
        freeze(self, "rate_start", (n - 1, 3))
        freeze(self, "rate_end", (n - 1, 3))

    def with_joints(self, joints: Sequence[int], other: Motion) -> Motion:
        """Return the motion with some joints moving as in another one of the same times."""
        if not joints:
            return self
        columns = [self.angle.copy(), self.rate_start.copy(), self.rate_end.copy()]
        for column, source in zip(
            columns, (other.angle, other.rate_start, other.rate_end), strict=True
        ):
            column[:, joints] = source[:, joints]
        return Motion(self.t, *columns)

    def pieces(self) -> Iterator[Piece]:
        """Yield the motion in pieces, for what is measured on long ones sample by sample."""
        count = len(self.t)
        for first in range(0, count, PIECE):
            last = min(first + PIECE, count)
            begin, end = max(first - _BESIDE, 0), min(last + _BESIDE, count)
            part = Motion(
                self.t[begin:end],
                self.angle[begin:end],
                self.rate_start[begin : end - 1],
                self.rate_end[begin : end - 1],
            )
            yield Piece(part, slice(first - begin, last - begin), first)

    @cached_property
    def step(self) -> Floats:
        """Length of each interval, (n - 1,) [s]."""
        return np.diff(self.t)

    @cached_property
    def weight(self) -> Floats:
        """Weights of the trapezoidal rule for values at samples, (n,) [s]."""
        weight = np.zeros_like(self.t)
        weight[:-1] = 0.5 * self.step
        weight[1:] += 0.5 * self.step
        return weight

    @cached_property
    def rate(self) -> Floats:
        """Rate at each sample, (n, 3) [rad/s]; the mean of both sides at a step."""
        samples = np.empty_like(self.angle)
        samples[0], samples[-1] = self.rate_start[0], self.rate_end[-1]
        np.add(self.rate_end[:-1], self.rate_start[1:], out=samples[1:-1])
        samples[1:-1] *= 0.5
        return samples

    @cached_property
    def acceleration(self) -> Floats:
        """Acceleration of each interval, (n - 1, 3) [rad/s^2]."""
        return (self.rate_end - self.rate_start) / self.step[:, None]

    @cached_property
    def jerk(self) -> Floats:
        """Jerk at each interior sample, (n - 2, 3) [rad/s^3].

        The change of the acceleration from one interval to the next, over the time
        between their middles. Where the rate steps it means nothing.
        """
        apart = 0.5 * (self.step[1:] + self.step[:-1])
        return np.diff(self.acceleration, axis=0) / apart[:, None]

    @cached_property
    def rate_step(self) -> Floats:
        """Jump of the rate at each interior sample, (n - 2, 3) [rad/s]."""
        return self.rate_start[1:] - self.rate_end[:-1]

    @property
    def angle_sides(self) -> Floats:
        """Angles at start and end of each interval, (n - 1, 2, 3) [rad]."""
        return np.stack([self.angle[:-1], self.angle[1:]], axis=1)

    @property
    def rate_sides(self) -> Floats:
        """Rates at start and end of each interval, (n - 1, 2, 3) [rad/s]."""
        return np.stack([self.rate_start, self.rate_end], axis=1)


@dataclass(frozen=True, slots=True)
class Piece:
    """Samples of a motion with some on either side, so that they have all their neighbours.

    Parameters
    ----------
    motion : Motion
        The samples and those beside them.
    own : slice
        Which of these are the piece's own.
    first : int
        Where the first of its own stands in the whole motion.
    """

    motion: Motion
    own: slice
    first: int

    @property
    def own_intervals(self) -> slice:
        """The intervals that begin at its own samples."""
        return slice(self.own.start, min(self.own.stop, len(self.motion.t) - 1))


@dataclass(frozen=True)
class GOffset:
    """How far the G that a machine can make is from the one that is asked.

    Parameters
    ----------
    rms, largest : float
        Of the length of the difference of the G-vectors [g].
    largest_at : float
        Time of the largest [s].
    onset_asked, onset_made : float
        Largest change of |G| over a tenth of a second, per second [g/s].
    roll_rate_rms, pitch_rate_rms : float, optional
        Of the difference of the seat's rates, where rates are asked beside the G [rad/s].
    """

    rms: float
    largest: float
    largest_at: float
    onset_asked: float
    onset_made: float
    roll_rate_rms: float | None = None
    pitch_rate_rms: float | None = None


@dataclass(frozen=True)
class Shortfall:
    """What a profile asks of the seat beyond what its joint motion makes: asked less made.

    Parameters
    ----------
    seat_rate : (n - 1, 2, 3) array
        At both ends of every interval, along x, y, z of the seat [rad/s].
    seat_angular_acceleration : (n - 1, 2, 3) array
        Likewise [rad/s^2].
    seat_g : (n - 1, 2, 3) array
        Likewise, in the pilot's signs [g].
    attitude : (n, 3) array
        At samples, the rotation vector along x, y, z of the seat that turns the
        attitude that is made into the one that is asked for [rad].
    """

    seat_rate: Floats
    seat_angular_acceleration: Floats
    seat_g: Floats
    attitude: Floats

    def __post_init__(self) -> None:
        n = len(self.attitude)
        freeze(self, "attitude", (n, 3))
        for name in ("seat_rate", "seat_angular_acceleration", "seat_g"):
            freeze(self, name, (n - 1, 2, 3))


@dataclass(frozen=True, eq=False)
class Record:
    """What is asked of the machine.

    Parameters
    ----------
    motion : Motion
    shortfall : Shortfall, optional
        What is asked for beyond it.
    """

    motion: Motion
    shortfall: Shortfall | None = None

    def __eq__(self, other: object) -> bool:
        """Return whether it is the very same motion and shortfall."""
        return (
            isinstance(other, Record)
            and self.motion is other.motion
            and self.shortfall is other.shortfall
        )

    def __hash__(self) -> int:
        """Return a hash of what makes it the same."""
        return hash((id(self.motion), id(self.shortfall)))


@dataclass(frozen=True)
class DesiredMotion:
    """The motion that a profile asks for, and how well the joints can make it.

    Parameters
    ----------
    motion : Motion
    least_singular_value : float
        Of the orientation Jacobian, the smallest at any sample.
    damped : (n,) array of bool
        Where the inverse was damped or a rate was held at its limit.
    residual : (n, 3) array
        ``W - J theta'`` in seat axes [rad/s]; zero where nothing was damped.
    attitude_error : float
        Largest geodesic angle between the attitude that the joints make and
        the one integrated directly from the rates [rad].
    recorded_attitude_error : float, optional
        Largest geodesic angle between the attitude integrated from the rates
        and the recorded one, both relative to the first sample [rad].
    g_offset : GOffset, optional
        How near that is.
    shortfall : Shortfall, optional
        What is asked for and not made; None where the joints make all of it.
    rates : BodyRates, optional
        Where body rates are asked for: these, on the rows of the motion.
    remarks : tuple of str
        Sentences on what was changed to make it.
    """

    motion: Motion
    least_singular_value: float
    damped: Flags
    residual: Floats
    attitude_error: float = 0.0
    recorded_attitude_error: float | None = None
    g_offset: GOffset | None = None
    shortfall: Shortfall | None = None
    rates: BodyRates | None = None
    remarks: tuple[str, ...] = ()

    @property
    def record(self) -> Record:
        """What is asked for, as fidelity is measured against it."""
        return Record(self.motion, self.shortfall)


def mean_of_sides(sides: Floats) -> Floats:
    """Turn values at both ends of every interval into values at samples.

    Parameters
    ----------
    sides : (n - 1, 2, ...) array

    Returns
    -------
    (n, ...) array
        The mean of what the two intervals at a sample say.
    """
    samples = np.empty((len(sides) + 1, *sides.shape[2:]))
    samples[0], samples[-1] = sides[0, 0], sides[-1, 1]
    samples[1:-1] = 0.5 * (sides[:-1, 1] + sides[1:, 0])
    return samples


def integrate_sides(step: Floats, sides: Floats) -> Floats:
    """Integrate values at both ends of every interval by the trapezoidal rule.

    Parameters
    ----------
    step : (n - 1,) array
    sides : (n - 1, 2, ...) array

    Returns
    -------
    array of shape ``sides.shape[2:]``
    """
    return np.tensordot(step, 0.5 * (sides[:, 0] + sides[:, 1]), axes=1)
