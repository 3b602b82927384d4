"""Whether a machine can reach a table's first row from rest, and come to rest after its last.

A table may end with a joint inside all its limits and yet so fast, so near its end stop, that
it must pass it. From angle x, rate v and acceleration a a joint is brought to rest by three
phases of time: jerk J until the acceleration is -s A or less, that acceleration held, and jerk
back to zero, with s the sign of the rate that is left when the acceleration is taken back at
once, v + a |a| / 2 J. A joint that would pass its stop that way may brake on for longer and
come back: with each moment of that it stops further from the one side and nearer to the other.

To reach a first row from rest is the same with the time reversed: the rate changes its sign,
the acceleration does not.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from des_cli.model.machine import JOINTS, Joint, JointLimits
from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.verify.claim import Claim

STOPPING_TOLERANCE = 1e-6
"""Excess over a limit, relative to it, that a stop may have: a microradian or so, a
hundredth of what a joint's encoder tells apart."""

HALVINGS = 60
"""Of the time for which a joint brakes on: to the last bit."""


@dataclass(frozen=True, slots=True)
class State:
    """A joint at an instant.

    Parameters
    ----------
    angle, rate, acceleration : float
        [rad], [rad/s], [rad/s^2]
    """

    angle: float
    rate: float
    acceleration: float

    @property
    def mirrored(self) -> State:
        """The same to the other side."""
        return State(-self.angle, -self.rate, -self.acceleration)

    @property
    def reversed(self) -> State:
        """The same with time running back."""
        return State(self.angle, -self.rate, self.acceleration)

    def after(self, time: float, jerk: float) -> State:
        """Return the state after a time [s] of constant jerk [rad/s^3]."""
        x, v, a = self.angle, self.rate, self.acceleration
        return State(
            x + time * (v + time * (a / 2.0 + time * jerk / 6.0)),
            v + time * (a + time * jerk / 2.0),
            a + time * jerk,
        )


@dataclass(frozen=True, slots=True)
class Reach:
    """What a joint passes through on its way to rest.

    Parameters
    ----------
    least, most : float
        Of its angle [rad].
    rate : float
        Largest magnitude of its rate [rad/s].
    """

    least: float
    most: float
    rate: float

    def joined(self, other: Reach) -> Reach:
        """Return what is passed through on both ways."""
        return Reach(
            min(self.least, other.least), max(self.most, other.most), max(self.rate, other.rate)
        )


def check_stopping(claim: Claim) -> list[Check]:
    """Measure by how much a joint passes a limit on its way to the table, and after it."""
    if not claim.enforced:
        return []
    motion, limits = claim.table, claim.profile.machine.limits
    return [
        check
        for j, (joint, limit) in enumerate(zip(JOINTS, limits, strict=True))
        for check in stopping_checks(
            joint, limit, _first(motion, j), _last(motion, j), STOPPING_TOLERANCE
        )
    ]


def stopping_checks(
    joint: Joint, limit: JointLimits, first: State, last: State, tolerance: float
) -> Iterator[Check]:
    """Measure the way from rest to a joint's first state, and from its last to rest."""
    for key, way, state in (
        ("start", "to reach the first row from rest", first.reversed),
        ("end", "to come to rest after the last row", last),
    ):
        name = f"relative excess of the {joint} over its limits {way}"
        cure = f"let the {joint} {'begin' if key == 'start' else 'end'} slower, or farther from it"
        yield Check(f"stopping.{joint}.{key}", name, excess(state, limit), tolerance, cure)


def excess(state: State, limit: JointLimits) -> float:
    """Return by how much a joint must pass a limit of angle or rate to come to rest, relative.

    Negative where it need not; not a number where a limit is no positive number.
    """
    limits = (limit.angle, limit.rate, limit.acceleration, limit.jerk)
    if not all(each > 0.0 for each in limits):
        return math.nan
    reach = best_reach(state, limit)
    return max(
        max(reach.most, -reach.least) / limit.angle - 1.0 if math.isfinite(limit.angle) else -1.0,
        reach.rate / limit.rate - 1.0 if math.isfinite(limit.rate) else -1.0,
    )


def best_reach(state: State, limit: JointLimits) -> Reach:
    """Return what is passed through on the way to rest that leaves most room to both stops."""
    plain = reach_of_stop(state, limit)
    if max(plain.most, -plain.least) <= limit.angle or not math.isfinite(limit.jerk):
        return plain
    if plain.most < -plain.least:
        found = best_reach(state.mirrored, limit)
        return Reach(-found.most, -found.least, found.rate)
    # It passes the upper stop: brake on for as long as that takes, and no longer.
    low, high = 0.0, _time_to_turn(state, limit)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if _braked_on(state, limit, middle).most > limit.angle:
            low = middle
        else:
            high = middle
    return _braked_on(state, limit, high)


def reach_of_stop(state: State, limit: JointLimits) -> Reach:
    """Return what is passed through on the fastest way to rest.

    Parameters
    ----------
    state : State
    limit : JointLimits
        Without a jerk limit the acceleration is free at once.
    """
    most, jerk = limit.acceleration, limit.jerk
    if not math.isfinite(jerk):
        way = 0.5 * state.rate * abs(state.rate) / most if math.isfinite(most) else 0.0
        ends = (state.angle, state.angle + way)
        return Reach(min(ends), max(ends), abs(state.rate))
    left = state.rate + state.acceleration * abs(state.acceleration) / (2.0 * jerk)
    if left < 0.0:
        found = reach_of_stop(state.mirrored, limit)
        return Reach(-found.most, -found.least, found.rate)
    # Down to -peak with -jerk, hold, and up to zero with +jerk: the rate that these take off
    # is (a^2 / 2 + peak^2) / jerk where nothing is held, less what a positive a adds first.
    a = state.acceleration
    peak = math.sqrt(max(jerk * state.rate + 0.5 * a * a, 0.0))
    held = 0.0
    if peak > most:
        held = (state.rate + 0.5 * a * a / jerk - most * most / jerk) / most
        peak = most
    first = max((a + peak) / jerk, 0.0)
    return _along(state, ((first, -jerk), (held, 0.0), (peak / jerk, jerk)))


def _along(state: State, phases: tuple[tuple[float, float], ...]) -> Reach:
    """Return what is passed through in phases of constant jerk."""
    reach = Reach(state.angle, state.angle, abs(state.rate))
    for time, jerk in phases:
        # A constant acceleration is held while the rate falls, and turns nothing.
        turns = (
            (*_roots(jerk / 2.0, state.acceleration, state.rate), -state.acceleration / jerk)
            if jerk
            else ()
        )
        for t in (*turns, time):
            at = state.after(min(max(t, 0.0), time), jerk)
            reach = reach.joined(Reach(at.angle, at.angle, abs(at.rate)))
        state = at
    return reach


def _braked_on(state: State, limit: JointLimits, time: float) -> Reach:
    """Return what is passed through where a joint first brakes as hard as it can for a time."""
    ramp = min(time, (limit.acceleration + state.acceleration) / limit.jerk)
    phases = ((ramp, -limit.jerk), (time - ramp, 0.0))
    there = state.after(ramp, -limit.jerk).after(time - ramp, 0.0)
    return _along(state, phases).joined(reach_of_stop(there, limit))


def _time_to_turn(state: State, limit: JointLimits) -> float:
    """Return the time in which a joint that brakes as hard as it can comes to a standstill."""
    ramp = (limit.acceleration + state.acceleration) / limit.jerk
    # The rate is a parabola that opens down: it falls through zero at its last root.
    turn = max(_roots(-limit.jerk / 2.0, state.acceleration, state.rate), default=math.inf)
    if turn <= ramp:
        return max(turn, 0.0)
    return ramp + max(state.after(ramp, -limit.jerk).rate, 0.0) / limit.acceleration


def _roots(a: float, b: float, c: float) -> tuple[float, ...]:
    """Return the real roots of ``a t^2 + b t + c``, a not zero, without cancellation."""
    inside = b * b - 4.0 * a * c
    if inside < 0.0:
        return ()
    q = -0.5 * (b + math.copysign(math.sqrt(inside), b))
    return (q / a, c / q) if q else (0.0,)


def _first(motion: Motion, joint: int) -> State:
    return State(
        float(motion.angle[0, joint]),
        float(motion.rate_start[0, joint]),
        float(motion.acceleration[0, joint]),
    )


def _last(motion: Motion, joint: int) -> State:
    return State(
        float(motion.angle[-1, joint]),
        float(motion.rate_end[-1, joint]),
        float(motion.acceleration[-1, joint]),
    )
