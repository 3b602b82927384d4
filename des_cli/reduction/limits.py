"""The machine's limits, measured on a motion as the actuators would see it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal
from weakref import WeakKeyDictionary

import numpy as np

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.coriolis import angular_acceleration_split
from des_cli.kinematics.onset import onsets
from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, JointLimits, Machine, Seat
from des_cli.model.motion import Motion, Piece
from des_cli.model.response import SeatResponse
from des_cli.model.run import JointQuantity, SeatQuantity, Violation

TOLERANCE = 1e-9
"""Relative excess over a limit that rounding alone may make."""

STEP_TOLERANCE = 1e-9
"""A jump of the rate at a sample [rad/s] below which it is rounding, and no step."""

ROUNDING = 4.0 * np.finfo(np.float64).eps
"""Relative error of a rate, or of an angle in a table, that a few operations on doubles
leave. A jerk divides it by the step squared, or cubed: it is no longer small there."""

Which = Literal["desired", "modified"]

_Component = tuple[SeatQuantity, SeatQuantity, tuple[float, float]]


@dataclass(frozen=True)
class Peaks:
    """Largest magnitudes of a motion, (3,) each, for arm, fork and cab.

    ``acceleration`` and ``jerk`` leave out the samples at which the rate steps: a
    finite difference across a step grows without bound as the grid is refined.
    ``rate_step`` is the largest step [rad/s].
    """

    angle: Floats
    rate: Floats
    acceleration: Floats
    jerk: Floats
    rate_step: Floats


def measure_peaks(motion: Motion) -> Peaks:
    """Return the largest magnitudes of a motion; asked again, what was found the first time."""
    if motion not in _peaks:
        _peaks[motion] = _measured(motion)
    return _peaks[motion]


_peaks: WeakKeyDictionary[Motion, Peaks] = WeakKeyDictionary()


def _measured(motion: Motion) -> Peaks:
    measures = (angle_magnitude, _rate, acceleration_magnitude, jerk_magnitude, _rate_step)
    peaks = np.zeros((len(measures), len(JOINTS)))
    for piece in motion.pieces():
        here = [np.max(measure(piece.motion)[piece.own], axis=0) for measure in measures]
        np.maximum(peaks, here, out=peaks)
    return Peaks(*peaks)


def largest_angle(motion: Motion) -> Floats:
    """Return the largest angle of each joint, also between samples, (3,) [rad]."""
    largest = np.zeros(len(JOINTS))
    for piece in motion.pieces():
        here = angle_magnitude(piece.motion)[piece.own]
        np.maximum(largest, np.max(here, axis=0), out=largest)
    return largest


def acceleration_magnitude(motion: Motion) -> Floats:
    """Return the acceleration that the tables ask for at each sample, (n, 3) [rad/s^2].

    The larger of what the rates and what the positions say: the change of rate
    over the neighbouring intervals, and for the position-commanded fork and cab
    the second difference of the angle, which a rate that was estimated from a
    table of positions can hide.
    """
    by_rate = np.abs(motion.acceleration)
    magnitude = np.zeros_like(motion.angle)
    magnitude[:-1] = by_rate
    magnitude[1:] = np.maximum(magnitude[1:], by_rate)
    if len(motion.t) > 2:
        chord = np.diff(motion.angle, axis=0) / motion.step[:, None]
        apart = 0.5 * (motion.step[1:] + motion.step[:-1])[:, None]
        second = np.abs(np.diff(chord, axis=0) / apart)
        second[np.abs(motion.rate_step) > STEP_TOLERANCE] = 0.0
        second[:, 0] = 0.0  # the arm is commanded by its velocity
        magnitude[1:-1] = np.maximum(magnitude[1:-1], second)
    return magnitude


def angle_magnitude(motion: Motion) -> Floats:
    """Return the largest angle on the interval from each sample on, (n, 3) [rad].

    Between samples the angle is a parabola, whose vertex may lie beyond both of them.
    """
    start, end = motion.rate_start, motion.rate_end
    turns = start * end < 0.0
    rise = np.where(turns, 0.5 * start**2 / np.where(turns, start - end, 1.0), 0.0)
    vertex = motion.angle[:-1] + rise * motion.step[:, None]
    magnitude = np.abs(motion.angle)
    magnitude[:-1] = np.maximum(magnitude[:-1], np.abs(vertex))
    return magnitude


def jerk_at_samples(motion: Motion) -> Floats:
    """Return the jerk at every sample, (n, 3) [rad/s^3].

    The change of the acceleration from the interval before a sample to the one
    after it, over the time between their middles. It is zero where the rate steps,
    for there it would mean nothing; at the ends it is that of the next sample.
    """
    jerk = np.zeros_like(motion.angle)
    if len(motion.t) > 2:
        jerk[1:-1] = np.where(np.abs(motion.rate_step) > STEP_TOLERANCE, 0.0, motion.jerk)
        jerk[0], jerk[-1] = jerk[1], jerk[-2]
    return jerk


def jerk_magnitude(motion: Motion) -> Floats:
    """Return the jerk's magnitude at each sample, (n, 3) [rad/s^3]; 0 at the ends."""
    magnitude = np.abs(jerk_at_samples(motion))
    magnitude[[0, -1]] = 0.0
    return magnitude


def _rate(motion: Motion) -> Floats:
    """Return the larger rate of both sides of each sample, (n, 3) [rad/s]."""
    rate = np.zeros_like(motion.angle)
    rate[:-1] = np.abs(motion.rate_start)
    rate[1:] = np.maximum(rate[1:], np.abs(motion.rate_end))
    return rate


def _rate_step(motion: Motion) -> Floats:
    """Return the jump of the rate at each sample, (n, 3) [rad/s]; 0 at the ends."""
    step = np.zeros_like(motion.angle)
    step[1:-1] = np.abs(motion.rate_step)
    return step


def _jerk_rounding(motion: Motion, which: Which) -> Floats:
    """Return how much of each sample's jerk may be rounding of doubles, (n, 3) [rad/s^3].

    A modified motion has rates of its own. Those of a desired motion may have been
    estimated from a table of positions, whose rounding is divided by the step once more.
    """
    allowance = np.zeros_like(motion.angle)
    if len(motion.t) < 3:
        return allowance
    step = np.minimum(motion.step[1:], motion.step[:-1])[:, None]
    rate = np.maximum(np.abs(motion.rate_start), np.abs(motion.rate_end))
    allowance[1:-1] = 4.0 * ROUNDING * np.maximum(rate[1:], rate[:-1]) / step**2
    if which == "desired":
        allowance[1:-1, 1:] += 4.0 * ROUNDING * np.abs(motion.angle[1:-1, 1:]) / step**3
    return allowance


def find_violations(machine: Machine, motion: Motion, which: Which) -> tuple[Violation, ...]:
    """Name every joint limit that a motion breaks.

    Parameters
    ----------
    machine : Machine
    motion : Motion
    which : {"desired", "modified"}
        How the violations call the motion.

    Returns
    -------
    tuple of Violation
        Joint by joint.
    """
    if _inside(machine.limits, measure_peaks(motion)):
        return ()
    found: dict[tuple[int, int], Violation] = {}
    for piece in motion.pieces():
        for place, violation in _broken(machine.limits, piece, which):
            before = found.get(place, violation)
            peak = max(before.peak, violation.peak)
            found[place] = replace(violation, peak=peak, from_s=before.from_s)
    return tuple(found[place] for place in sorted(found))


def _inside(limits: tuple[JointLimits, ...], peaks: Peaks) -> bool:
    """Return whether no peak is beyond its limit; what is no number is not inside."""
    kept = peaks.rate_step <= STEP_TOLERANCE
    for quantity in ("angle", "rate", "acceleration", "jerk"):
        bound = np.array([getattr(limit, quantity) for limit in limits])
        kept &= getattr(peaks, quantity) <= bound * (1.0 + TOLERANCE)
    return bool(np.all(kept))


def _broken(
    limits: tuple[JointLimits, ...], piece: Piece, which: Which
) -> Iterator[tuple[tuple[int, int], Violation]]:
    """Yield what the samples of a piece break, with the numbers of joint and quantity."""
    motion, own = piece.motion, piece.own
    t = motion.t[own]
    none = np.zeros_like(motion.angle)
    # No finite acceleration makes a step: any step beyond rounding is named.
    quantities: tuple[tuple[JointQuantity, Floats, Floats], ...] = (
        ("angle", angle_magnitude(motion), none),
        ("rate", _rate(motion), none),
        ("acceleration", acceleration_magnitude(motion), none),
        ("jerk", jerk_magnitude(motion), _jerk_rounding(motion, which)),
        ("rate step", _rate_step(motion), none + STEP_TOLERANCE),
    )
    for q, (quantity, values, allowance) in enumerate(quantities):
        bounds = [0.0 if quantity == "rate step" else getattr(each, quantity) for each in limits]
        beyond = values > np.array(bounds) * (1.0 + TOLERANCE) + allowance
        for j in np.flatnonzero(np.any(beyond[own], axis=0)):
            broken = np.flatnonzero(beyond[own, j])
            yield (
                (int(j), q),
                Violation(
                    motion=which,
                    joint=JOINTS[j],
                    quantity=quantity,
                    peak=float(values[own, j][broken].max()),
                    limit=bounds[j],
                    from_s=float(t[broken[0]]),
                    to_s=float(t[broken[-1]]),
                ),
            )


def steps_too_short(machine: Machine, motion: Motion, share: float) -> str:
    """Say where a jerk cannot be told from rounding, or nothing.

    Parameters
    ----------
    machine : Machine
    motion : Motion
    share : float
        Of a jerk limit, that rounding may make at the most.
    """
    limit = np.array([limit.jerk for limit in machine.limits])
    part, worst, joint = 0.0, 0, 0
    for piece in motion.pieces():
        parts = _jerk_rounding(piece.motion, "modified")[piece.own] / limit
        sample, of = np.unravel_index(np.argmax(parts), parts.shape)
        if parts[sample, of] > part:
            part, worst, joint = float(parts[sample, of]), piece.first + int(sample), int(of)
    if part <= share:
        return ""
    step = float(np.min(motion.step[worst - 1 : worst + 1]))
    return (
        f"a step of {step:.3g} s, at t = {motion.t[worst]:g} s, is too short to hold the "
        f"{JOINTS[joint]}'s jerk in: rounding alone makes {part:.2g} of its limit there; sample "
        f"with steps of {step * math.sqrt(part / share):.2g} s or more"
    )


def find_occupant_violations(
    machine: Machine, seat: Seat, response: SeatResponse, motion: Motion, which: Which
) -> tuple[Violation, ...]:
    """Name every bound on what the occupant may get that a motion breaks.

    Parameters
    ----------
    machine : Machine
        Its ``occupant`` has the bounds.
    seat : Seat
    response : SeatResponse
        Of the motion.
    motion : Motion
    which : {"desired", "modified"}
        How the violations call the motion.

    Returns
    -------
    tuple of Violation
        Of the joint ``seat``; one for each component of the G-vector and end of its
        interval, one for each component's onset, one for the angular acceleration.
    """
    bounds = machine.occupant
    if not bounds.bounded:
        return ()
    found = list(_g_violations(machine, response, motion, which))
    if np.isfinite(bounds.angular_acceleration):
        magnitude = _at_samples(angular_acceleration_magnitude(machine, seat, motion))
        found += _beyond(
            which, "angular acceleration", magnitude, bounds.angular_acceleration, motion.t
        )
    return tuple(found)


def angular_acceleration_magnitude(machine: Machine, seat: Seat, motion: Motion) -> Floats:
    """Return |dW/dt| of the seat at both ends of every interval, (n - 1, 2) [rad/s^2]."""
    rates = motion.rate_sides
    accelerations = np.broadcast_to(motion.acceleration[:, None, :], rates.shape)
    parts = angular_acceleration_split(
        chain_of(machine, seat), motion.angle_sides, rates, accelerations, "seat"
    )
    return np.asarray(np.linalg.norm(parts[0] + parts[1], axis=-1))


def _g_violations(
    machine: Machine, response: SeatResponse, motion: Motion, which: Which
) -> Iterator[Violation]:
    """Yield what breaks a bound on the G-vector or on its onset."""
    bounds = machine.occupant
    components: tuple[_Component, ...] = (
        ("Gx", "Gx onset", bounds.gx),
        ("Gy", "Gy onset", bounds.gy),
        ("Gz", "Gz onset", bounds.gz),
    )
    for index, (component, onset, (least, most)) in enumerate(components):
        sides = response.seat_g[..., index]
        yield from _beyond(which, component, _at_samples(sides), most, motion.t)
        yield from _beyond(which, component, _at_samples(-sides), -least, motion.t, sign=-1.0)
        begin, rise = onsets(motion.t, sides[..., None])
        yield from _beyond(which, onset, rise[0], bounds.g_onset, begin)


def _beyond(
    which: Which,
    quantity: SeatQuantity,
    values: Floats,
    most: float,
    t: Floats,
    *,
    sign: float = 1.0,
) -> Iterator[Violation]:
    """Yield the violation of an upper bound, or with sign -1 of a lower one on -values."""
    broken = np.flatnonzero(values > most + TOLERANCE * max(1.0, abs(most)))
    if np.isfinite(most) and len(broken):
        yield Violation(
            motion=which,
            joint="seat",
            quantity=quantity,
            peak=sign * float(values.max()),
            limit=sign * most,
            from_s=float(t[broken[0]]),
            to_s=float(t[broken[-1]]),
        )


def _at_samples(sides: Floats) -> Floats:
    """Return the largest value at each sample, (n,), of values at both ends of intervals."""
    samples = np.full(len(sides) + 1, -np.inf)
    samples[:-1] = sides[:, 0]
    samples[1:] = np.maximum(samples[1:], sides[:, 1])
    return samples
