"""From rest to a maneuver's start and from its end to rest, for the command table.

Each joint's rate leaves rest without acceleration, rises by a cubic, and in a last short
piece takes up the maneuver's acceleration, so that it arrives with rate and acceleration;
or the mirror image of that. The arm takes the whole lead, for its rate makes the G. Fork
and cab take no longer than they need at a quarter of their limits, lest they travel far.
Where the joints stand before is what follows from it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, JointLimits, Machine
from des_cli.model.motion import Motion
from des_cli.reduction.limits import find_violations

EASE = 0.25
"""Share of the acceleration and jerk limits that a lead uses where it has the time."""

UNLIMITED_JERK = 2.0
"""Jerk over the acceleration limit [1/s] that a joint without a jerk limit is led with."""

LONGEST = 600.0
"""Lead [s] beyond which no search for a sufficient one goes."""

HALVINGS = 12
"""Of the bracket of the shortest sufficient lead: to a few thousandths of it."""


@dataclass(frozen=True)
class Led:
    """A motion with its leads.

    Parameters
    ----------
    motion : Motion
        From rest to rest where both leads are there; the maneuver keeps its times.
    trouble : str
        Empty, or which lead breaks a limit, and which one does not.
    """

    motion: Motion
    trouble: str = ""


def add_leads(machine: Machine, motion: Motion, lead_in: float, lead_out: float) -> Led:
    """Put a lead before and after a motion.

    Parameters
    ----------
    machine : Machine
        Its limits hold for the leads too.
    motion : Motion
        Without rate steps.
    lead_in, lead_out : float
        [s]; 0 for none.
    """
    trouble = ""
    led = motion
    for name, duration, after in (("lead_in_s", lead_in, False), ("lead_out_s", lead_out, True)):
        if not duration:
            continue
        lead = _lead(machine, motion, duration, after=after)
        if broken := find_violations(machine, lead, "modified"):
            other = _shortest(machine, motion, after=after)
            joints = ", ".join(joint for joint in JOINTS if joint in {v.joint for v in broken})
            trouble = f"{name}: in {duration:g} s the {joints} cannot keep its limits ({broken[0]})"
            trouble += f"; in {_rounded_up(other)} s it can" if other else "; no lead does"
        led = _joined(led, lead) if after else _joined(lead, led)
    return Led(led, trouble)


def _rounded_up(duration: float) -> str:
    """Write a duration [s] with three digits, not below itself."""
    digits = 2 - int(np.floor(np.log10(duration)))
    return f"{np.ceil(duration * 10.0**digits) / 10.0**digits:g}"


def _lead(machine: Machine, motion: Motion, duration: float, *, after: bool) -> Motion:
    """Return the lead alone, from or to rest."""
    step = float(np.median(motion.step))
    count = max(int(np.ceil(duration / step - 1e-9)), 4)
    t = duration * np.linspace(0.0, 1.0, count + 1)
    if after:
        speed, gain, first = motion.rate_end[-1], -motion.acceleration[-1], motion.t[-1]
    else:
        speed, gain, first = motion.rate_start[0], motion.acceleration[0], motion.t[0] - duration
    rise = np.stack(
        [
            _rise(t, float(v), float(a), limit, whole=joint == "arm")
            for joint, limit, v, a in zip(JOINTS, machine.limits, speed, gain, strict=True)
        ],
        axis=1,
    )
    rate = rise[::-1] if after else rise
    turned = np.vstack(
        [np.zeros(3), np.cumsum(0.5 * np.diff(t)[:, None] * (rate[1:] + rate[:-1]), axis=0)]
    )
    offset = motion.angle[-1] if after else motion.angle[0] - turned[-1]
    t = first + t
    if after:
        t[0] = motion.t[-1]
    else:
        t[-1] = motion.t[0]
    return Motion(t, offset + turned, rate[:-1], rate[1:])


def _rise(t: Floats, speed: float, gain: float, limit: JointLimits, *, whole: bool) -> Floats:
    """Return a rate from rest at 0 to a speed with an acceleration (gain) at the last time.

    Parameters
    ----------
    t : (n,) array
        From 0 to the duration [s].
    speed, gain : float
        [rad/s], [rad/s^2]
    limit : JointLimits
    whole : bool
        Whether to take the whole duration.
    """
    duration = float(t[-1])
    jerk = limit.jerk if np.isfinite(limit.jerk) else UNLIMITED_JERK * limit.acceleration
    last = min(abs(gain) / (EASE * jerk), 0.5 * duration)
    plateau = speed - 0.5 * gain * last
    ramp = duration - last
    if not whole:
        eased = 1.5 * abs(plateau) / (EASE * limit.acceleration)
        ramp = min(ramp, max(eased, float(np.sqrt(6.0 * abs(plateau) / (EASE * jerk)))))
    u = np.clip((t - (duration - last - ramp)) / max(ramp, 1e-300), 0.0, 1.0)
    rate = plateau * u**2 * (3.0 - 2.0 * u)
    if last:
        rate += 0.5 * gain / last * np.maximum(t - (duration - last), 0.0) ** 2
    rate[-1] = speed
    return np.asarray(rate)


def _joined(first: Motion, second: Motion) -> Motion:
    return Motion(
        t=np.concatenate([first.t, second.t[1:]]),
        angle=np.concatenate([first.angle, second.angle[1:]]),
        rate_start=np.concatenate([first.rate_start, second.rate_start]),
        rate_end=np.concatenate([first.rate_end, second.rate_end]),
    )


def _shortest(machine: Machine, motion: Motion, *, after: bool) -> float | None:
    """Return the shortest lead that keeps the limits [s], or None."""

    def keeps(duration: float) -> bool:
        return not find_violations(
            machine, _lead(machine, motion, duration, after=after), "modified"
        )

    high = 0.5
    while not keeps(high):
        high *= 2.0
        if high > LONGEST:
            return None
    low = 0.5 * high
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if keeps(middle) else (middle, high)
    return high
