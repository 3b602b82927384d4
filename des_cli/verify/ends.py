"""Times, ends and held joints: where a modified motion must equal another one."""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Flags, Floats
from des_cli.model.machine import JOINTS
from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.verify.claim import Claim

END_TOLERANCE = 1e-9
"""Largest difference of an angle [rad] or a rate [rad/s] that is to be the same."""

INTEGRAL_TOLERANCE = 16.0 * float(np.finfo(np.float64).eps)
"""Gap between the rise of an angle over an interval and the integral of its rate, relative
to the largest angle or one: a few roundings of a sum."""

STANDSTILL = 1e-6
"""Rate relative to a joint's largest at which no factor on it means anything."""


def check_times(claim: Claim) -> Check:
    """Compare the sample times with those that were asked for."""
    t, asked = claim.modified.t, claim.asked.t
    apart = float(np.max(np.abs(t - asked))) if len(t) == len(asked) else float("inf")
    return Check("samples.times", "difference of the sample times [s]", apart, 0.0)


def check_integral(claim: Claim) -> Check:
    """Compare the angles of the table with the integrals of its rates.

    Where the motion asked for is passed through, or a joint of it held, its angles are
    its own.
    """
    motion, asked = claim.table, claim.asked
    rise = 0.5 * motion.step[:, None] * (motion.rate_start + motion.rate_end)
    off = np.abs(np.diff(motion.angle, axis=0) - rise)
    inside = (motion.t[:-1] >= asked.t[0]) & (motion.t[1:] <= asked.t[-1])
    if _same_motion(claim.modified, asked):
        off[inside] = 0.0
    off[np.ix_(inside, _held(claim))] = 0.0
    gap = np.max(off)
    size = max(1.0, float(np.max(np.abs(motion.angle))))
    return Check(
        "dynamics.angles",
        "gap between angles and integrated rates, relative",
        float(gap) / size,
        INTEGRAL_TOLERANCE,
    )


def _same_motion(one: Motion, other: Motion) -> bool:
    names = ("t", "angle", "rate_start", "rate_end")
    return all(np.array_equal(getattr(one, name), getattr(other, name)) for name in names)


def check_ends(claim: Claim) -> list[Check]:
    """Compare both ends with what they are to match.

    A free motion matches the motion that was asked for, as conditioned; factors act on
    the desired motion and match its rates. The study's sweep matches the first angles
    alone.
    """
    ends, modified = claim.reduction.ends, claim.modified
    begins = claim.target or claim.asked
    target = begins if claim.posed is None else claim.desired
    kept = [f"{joint}_start" not in claim.reduction.optimise for joint in JOINTS]
    start = (modified.angle - begins.angle)[0, kept]
    checks = [_same("start.angle", "change of the angles at the start [rad]", start)]
    if claim.reduction.algorithm == "report-sweep":
        return checks
    if ends != "free":
        rate = modified.rate_start[0] - target.rate_start[0]
        checks.append(_same("start.rate", "change of the rates at the start [rad/s]", rate))
    if ends in ("match-rates", "match-both"):
        rate = modified.rate_end[-1] - target.rate_end[-1]
        checks.append(_same("ends.rate", "change of the rates at the end [rad/s]", rate))
    if ends == "match-both":
        angle = modified.angle[-1] - target.angle[-1]
        name = "change of the angles at the end [rad]"
        checks.append(_same("ends.angle", name, angle, END_TOLERANCE + _step_error(modified)))
    return checks


def check_hold(claim: Claim) -> list[Check]:
    """Compare the joints that are held with the desired motion."""
    held = _held(claim)
    if not np.any(held):
        return []
    modified, desired = claim.modified, claim.desired
    angle = (modified.angle - desired.angle)[:, held]
    rate = (modified.rate_sides - desired.rate_sides)[..., held]
    return [
        _same("hold", "change of the angles of held joints [rad]", angle),
        _same("hold.rate", "change of the rates of held joints [rad/s]", rate),
    ]


def _held(claim: Claim) -> Flags:
    """Return which joints are to play the desired motion, (3,)."""
    return np.array([joint in claim.reduction.hold for joint in JOINTS])


def check_factors(claim: Claim) -> list[Check]:
    """Compare the rates of a free motion with its factors, where it tells factors.

    Where a desired joint stands still there is no factor to compare.
    """
    control = claim.solution.control
    if not control.shape[1]:
        return []
    rate = claim.desired.rate
    moving = np.abs(rate) > STANDSTILL * np.max(np.abs(rate), axis=0)
    off = (claim.modified.rate - control * rate)[moving]
    return [_same("dynamics.rates", "gap between rates and factors [rad/s]", off)]


def _step_error(motion: Motion) -> float:
    """Return how far a table may end from the smooth motion that it samples [rad].

    By the trapezoidal rule its rates miss h^2 / 12 times the difference of the
    accelerations at the ends, and less where they turn between samples: twice that of
    the largest difference is an error of the steps, and more is not.
    """
    varied = np.max(np.ptp(motion.acceleration, axis=0))
    return float(np.max(motion.step) ** 2 / 6.0 * varied)


def _same(key: str, name: str, off: Floats, tolerance: float = END_TOLERANCE) -> Check:
    return Check(key, name, float(np.max(np.abs(off), initial=0.0)), tolerance)
