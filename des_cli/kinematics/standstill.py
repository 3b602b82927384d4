"""To rest from any state of a joint, inside limits of acceleration and jerk.

The acceleration is taken to its bound with constant jerk, held, and taken back, as far as each is
needed. A joint that would pass its end stop so may brake on for a while first, and come back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import JointLimits

SHARES = (0.25, 0.5, 1.0)
"""Of the limits of acceleration and jerk, the first with which a joint keeps its other limits: as
gentle as the leads of a table where there is room."""

UNLIMITED_JERK = 2.0
"""Jerk over acceleration [1/s] of a joint without a limit of jerk."""

UNLIMITED = 1.0
"""Acceleration [rad/s^2] of a joint without a limit of it."""

BRAKES = 64
"""Times of braking on that are tried, up to that in which the joint comes to a standstill."""

SAMPLES = 200
"""Of each phase, among which its largest angle and rate are looked for."""


@dataclass(frozen=True)
class Stop:
    """A joint's way to rest, in phases of constant jerk.

    Parameters
    ----------
    start : (float, float, float)
        Angle, rate and acceleration [rad, rad/s, rad/s^2].
    phases : tuple of (float, float)
        Duration [s] and jerk [rad/s^3] of each.
    """

    start: tuple[float, float, float]
    phases: tuple[tuple[float, float], ...]

    @property
    def duration(self) -> float:
        """Until it rests [s]."""
        return sum(time for time, _ in self.phases)

    def at(self, t: Floats) -> tuple[Floats, Floats, Floats]:
        """Return angle, rate and acceleration at times from the start on, (k,) each.

        Parameters
        ----------
        t : (k,) array
            [s]; after its duration the joint rests.
        """
        t = np.maximum(t, 0.0)
        angle, rate, acceleration = (np.empty(len(t)) for _ in range(3))
        x, v, a, begin = *self.start, 0.0
        for time, jerk in self.phases:
            now = t >= begin
            u = t[now] - begin
            angle[now] = x + u * (v + u * (a / 2.0 + u * jerk / 6.0))
            rate[now] = v + u * (a + u * jerk / 2.0)
            acceleration[now] = a + u * jerk
            x, v, a = _after((x, v, a), time, jerk)
            begin += time
        rests = t >= begin
        # What rounding leaves of the rate is no motion.
        angle[rests], rate[rests], acceleration[rests] = x, 0.0, 0.0
        return angle, rate, acceleration

    def keeps(self, limit: JointLimits) -> bool:
        """Tell whether it keeps the limits of angle and rate, as far as the start does."""
        angle, rate, _ = self.at(np.linspace(0.0, self.duration, SAMPLES * len(self.phases)))
        most = max(limit.angle, abs(self.start[0]))
        fastest = max(limit.rate, abs(self.start[1]))
        return bool(np.max(np.abs(angle)) <= most and np.max(np.abs(rate)) <= fastest)


def come_to_rest(angle: float, rate: float, acceleration: float, limit: JointLimits) -> Stop:
    """Return a way to rest inside the limits of a joint.

    Parameters
    ----------
    angle, rate, acceleration : float
        [rad], [rad/s], [rad/s^2]
    limit : JointLimits

    Returns
    -------
    Stop
        Where no way keeps the limits of angle and rate, the fastest one.
    """
    start = (angle, rate, acceleration)
    for share in SHARES:
        stop = Stop(start, _phases(rate, acceleration, *_bounds(limit, share)))
        if stop.keeps(limit):
            return stop
    most, jerk = _bounds(limit, 1.0)
    side = math.copysign(1.0, rate)
    longest = abs(rate) / most + 2.0 * (most + abs(acceleration)) / jerk
    for on in np.linspace(0.0, longest, BRAKES + 1)[1:]:
        first = max((most + side * acceleration) / jerk, 0.0)
        braking = ((min(on, first), -side * jerk), (max(on - first, 0.0), 0.0))
        there = start
        for phase in braking:
            there = _after(there, *phase)
        longer = Stop(start, (*braking, *_phases(there[1], there[2], most, jerk)))
        if longer.keeps(limit):
            return longer
    return stop


def _phases(
    rate: float, acceleration: float, most: float, jerk: float
) -> tuple[tuple[float, float], ...]:
    """Return the phases of the fastest way to rest inside an acceleration and a jerk."""
    # What is left of the rate if the acceleration is taken back at once.
    left = rate + acceleration * abs(acceleration) / (2.0 * jerk)
    if left < 0.0:
        return tuple((time, -each) for time, each in _phases(-rate, -acceleration, most, jerk))
    if acceleration <= -most:
        # It brakes harder than it is to: what is left of the rate stays the same meanwhile.
        eased = (-acceleration - most) / jerk
        return ((eased, jerk), (left / most, 0.0), (most / jerk, jerk))
    peak = math.sqrt(max(jerk * rate + 0.5 * acceleration**2, 0.0))
    held = 0.0
    if peak > most:
        held = (rate + 0.5 * acceleration**2 / jerk - most**2 / jerk) / most
        peak = most
    return ((max((acceleration + peak) / jerk, 0.0), -jerk), (held, 0.0), (peak / jerk, jerk))


def _bounds(limit: JointLimits, share: float) -> tuple[float, float]:
    """Return a share of the limits of acceleration and jerk."""
    most = limit.acceleration if math.isfinite(limit.acceleration) else UNLIMITED
    jerk = limit.jerk if math.isfinite(limit.jerk) else UNLIMITED_JERK * most
    return share * most, share * jerk


def _after(
    state: tuple[float, float, float], time: float, jerk: float
) -> tuple[float, float, float]:
    x, v, a = state
    return (
        x + time * (v + time * (a / 2.0 + time * jerk / 6.0)),
        v + time * (a + time * jerk / 2.0),
        a + time * jerk,
    )
