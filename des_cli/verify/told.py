"""Whether the metrics of a run tell what its motions do.

The numbers that a user reads are computed by the code that solved. Here they are computed
anew from the motions, by the seat's second chain; costs are checked elsewhere, and what a
method says of itself is compared with what it handed over. What simpler means would get
(``baseline``), and what single steps of conditioning changed (``changes``, ``executable``),
are not: their motions are not claimed.
"""

from __future__ import annotations

import math
from typing import NamedTuple, get_args

import numpy as np

from des_cli.model.arrays import Flags, Floats
from des_cli.model.coriolis import COMPONENTS
from des_cli.model.felt import G_AXES, Felt, RateAxis, RateSizes, TurningAxis, TurningSizes
from des_cli.model.loads import Driven
from des_cli.model.machine import JOINTS, Machine
from des_cli.model.metric import METRICS
from des_cli.model.metrics import Metrics, SolverFacts
from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.verify.budgets import measure
from des_cli.verify.claim import Claim
from des_cli.verify.integrals import Sizes, angle_changes, ground_sizes, sizes, state_blocks
from des_cli.verify.limits import STEP_TOLERANCE, magnitudes
from des_cli.verify.occupant import largest_onsets
from des_cli.verify.singularity import Numbers, singularity_numbers

TOLD_TOLERANCE = 1e-8
"""Relative gap between a number and its twin: sums in another order, and cancellations of
what is felt over what changes."""

SMALL = 1e-3
"""Magnitude, in the number's unit, below which a gap is relative to this: a rate of
0.001 rad/s or 0.001 g is not felt."""

WEIGHTLESS = 0.1
"""Length of a G-vector [g] below which it has no direction that is told."""

AT_LIMIT = 0.99
"""Share of an acceleration limit from which a joint is told to be at it."""

UNCOUPLED = 1e-6
"""RMS of a part of the cross-coupling [rad/s^2] below which its reduction is rounding."""

ATTITUDE_TOLERANCE = 1e-6
"""The same of ``singularity``: an attitude is a product of as many turns as there are rows."""

OF_SOLUTION = ("status", "converged", "message")
OF_REDUCTION = (
    *("method", "algorithm", "control", "axes", "jacobian", "r1", "r2", "tracking"),
    *("limits", "ends", "objective", "optimise", "allow_change"),
)
"""Words and weights that are told as they are."""


def check_told(claim: Claim, told: Metrics) -> list[Check]:
    """Compare the metrics of a run with its motions, section by section.

    Parameters
    ----------
    claim : Claim
    told : Metrics

    Returns
    -------
    list of Check
        One a section, of the number that is farthest off, which its sentence names.
    """
    sections = {
        "profile": _profile(claim, told),
        "solver": _solver(claim, told.solver),
        "fidelity": _fidelity(claim, told),
        "coriolis": _coriolis(claim, told),
        "felt": _felt(claim, told.felt),
        "limits": _limits(claim, told),
    }
    return [
        *(_worst(section, numbers) for section, numbers in sections.items()),
        _worst("singularity", singularity_numbers(claim, told.singularity), ATTITUDE_TOLERANCE),
    ]


def _worst(section: str, numbers: Numbers, tolerance: float = TOLD_TOLERANCE) -> Check:
    gaps = {name: _gap(told, found) for name, told, found in numbers}
    # A gap that is not a number is the worst there is.
    name = max(gaps, key=lambda each: math.inf if math.isnan(gaps[each]) else gaps[each])
    return Check(
        f"told.{section}",
        f"relative gap between the metrics and the motion, largest of {name}",
        gaps[name],
        tolerance,
    )


def _gap(told: float | None, found: float) -> float:
    """Return how far a number is off, relative; what is not told is infinitely far off."""
    if told is None:
        return math.inf
    return abs(told - found) / max(abs(found), SMALL)


def _profile(claim: Claim, told: Metrics) -> Numbers:
    yield "duration_s", told.profile.duration_s, claim.duration


def _solver(claim: Claim, told: SolverFacts) -> Numbers:
    solution, asked = claim.solution, claim.reduction
    for name in ("iterations", "cost", "cost_unreduced", "optimality"):
        yield name, getattr(told, name), float(getattr(solution, name))
    budget = {each.metric: each.most for each in asked.budget}
    yield "budget", float((told.budget or {}) == budget), 1.0
    for source, names in ((solution, OF_SOLUTION), (asked, OF_REDUCTION)):
        for name in names:
            same = np.array_equal(getattr(told, name), getattr(source, name))
            yield name, float(same), 1.0


def _fidelity(claim: Claim, told: Metrics) -> Numbers:
    fidelity = told.fidelity
    for metric in METRICS:
        value = fidelity.value(metric)
        # A motion that has no factors has none that deviate.
        if value is not None or claim.solution.control.shape[1]:
            yield metric, value, measure(claim, metric, claim.after)
    if tilt := _tilts(claim):
        yield "tilt_error_max_deg", fidelity.tilt_error_max_deg, tilt[0]
        yield "tilt_error_rms_deg", fidelity.tilt_error_rms_deg, tilt[1]
    modified, requested = claim.modified, claim.requested
    off = angle_changes(claim, claim.after, claim.made)
    for j, joint in enumerate(JOINTS):
        yield f"joint_rms_rad.{joint}", fidelity.joint_rms_rad.get(joint), off.rms[j]
        start, end = fidelity.offset("start"), fidelity.offset("end")
        for name, offset, row in (("start", start, 0), ("end", end, -1)):
            angle = modified.angle[row, j] - requested.angle[row, j]
            yield f"{name}_error.{joint}", offset.angle.get(joint), float(angle)
        rate = modified.rate_start[0, j] - requested.rate_start[0, j]
        yield f"start_error.{joint}_rate", start.rate.get(joint), float(rate)
        rate = modified.rate_end[-1, j] - requested.rate_end[-1, j]
        yield f"end_error.{joint}_rate", end.rate.get(joint), float(rate)


def _tilts(claim: Claim) -> tuple[float, float] | None:
    """Return the largest angle between the G-vectors and its root mean square [deg].

    Over the time in which neither is too short; None where there is none.
    """
    most, square, time = np.zeros(1), 0.0, 0.0
    for states in state_blocks(len(claim.weight)):
        tilt, clear = _tilt(claim.before.g[:, states], claim.after.g[:, states])
        most = np.maximum(most, np.max(tilt))
        square += float(claim.weight[states] @ tilt**2)
        time += float(claim.weight[states] @ clear)
    return (float(most[0]), math.sqrt(square / time)) if time else None


def _tilt(before: Floats, after: Floats) -> tuple[Floats, Flags]:
    """Return the angle between two G-vectors [deg], zero where one is too short, and where not.

    By the chord between their directions, whose half is the sine of half the angle.
    """
    lengths = _length(before), _length(after)
    clear = np.minimum(*lengths) >= WEIGHTLESS
    one, other = (
        each / np.where(clear, length, 1.0)
        for each, length in zip((before, after), lengths, strict=True)
    )
    half = np.where(clear, 0.5 * _length(one - other), 0.0)
    return np.asarray(np.degrees(2.0 * np.arcsin(np.minimum(half, 1.0)))), clear


def _coriolis(claim: Claim, told: Metrics) -> Numbers:
    by_axes = {
        "seat": [sizes(claim, felt.cross) for felt in (claim.made, claim.after)],
        "report": [ground_sizes(claim, felt) for felt in (claim.made, claim.after)],
    }
    for component in COMPONENTS:
        key, part = component.key, told.coriolis.parts[component.key]
        old, new = by_axes[component.axes or "seat"]
        # The length, which has no axes, comes last.
        i = -1 if component.axes is None else component.index
        yield from _sizes(key, part.sizes, old, new, i)
        if old.rms[i] > UNCOUPLED:
            yield f"{key}.reduction", part.reduction, 1.0 - (new.rms[i] / old.rms[i]) ** 2


def _sizes(
    name: str, told: RateSizes | TurningSizes, old: Sizes, new: Sizes, component: int
) -> Numbers:
    """Yield root mean square and peak of a component, before and after."""
    yield f"{name}.rms_before", told.rms.before, old.rms[component]
    yield f"{name}.rms_after", told.rms.after, new.rms[component]
    yield f"{name}.peak_before", told.peak.before, old.peak[component]
    yield f"{name}.peak_after", told.peak.after, new.peak[component]


def _felt(claim: Claim, told: Felt) -> Numbers:
    before, after = claim.before, claim.after
    turning = told.seat_angular_acceleration
    old, new = (sizes(claim, felt.rate) for felt in (before, after))
    for i, rate_axis in enumerate(get_args(RateAxis)):
        yield from _sizes(f"seat_rate.{rate_axis}", told.seat_rate[rate_axis], old, new, i)
    old, new = (sizes(claim, felt.turning) for felt in (before, after))
    for i, turning_axis in enumerate(get_args(TurningAxis)):
        yield from _sizes(f"turning.{turning_axis}", turning[turning_axis], old, new, i)
    onsets = [
        largest_onsets(motion, each)
        for motion, each in ((claim.requested, before), (claim.modified, after))
    ]
    off = sizes(claim, after.g, before.g)
    for i, axis in enumerate(G_AXES):
        g, was, now = told.seat_g[axis], before.g[i], after.g[i]
        least = float(np.min(was)), float(np.min(now))
        most = float(np.max(was)), float(np.max(now))
        yield f"seat_g.{axis}.peak_before", g.peak.before, max(-least[0], most[0])
        yield f"seat_g.{axis}.peak_after", g.peak.after, max(-least[1], most[1])
        yield f"seat_g.{axis}.min_before", g.least.before, least[0]
        yield f"seat_g.{axis}.min_after", g.least.after, least[1]
        yield f"seat_g.{axis}.max_before", g.largest.before, most[0]
        yield f"seat_g.{axis}.max_after", g.largest.after, most[1]
        yield f"seat_g.{axis}.onset_before", g.onset.before, float(onsets[0][i])
        yield f"seat_g.{axis}.onset_after", g.onset.after, float(onsets[1][i])
        yield f"seat_g.{axis}.jump_before", g.jump.before, _jump(was)
        yield f"seat_g.{axis}.jump_after", g.jump.after, _jump(now)
        yield f"seat_g.{axis}.rms_error", g.rms_error_g, off.rms[i]


def _limits(claim: Claim, told: Metrics) -> Numbers:
    for which, motion, loads in (
        ("desired", claim.requested, told.limits.desired),
        ("modified", claim.modified, told.limits.modified),
    ):
        found = _drive(motion, claim.profile.machine)
        for j, (joint, limit) in enumerate(zip(JOINTS, claim.profile.machine.limits, strict=True)):
            load, name = loads[joint], f"{which}.{joint}"
            yield f"{name}.rate", load.rate_peak_rad_s, float(found.rate[j])
            acceleration = float(found.acceleration[j])
            yield f"{name}.acceleration", load.acceleration_peak_rad_s2, acceleration
            yield f"{name}.jerk", load.jerk_peak_rad_s3, float(found.jerk[j])
            share = float(found.at_limit[j])
            yield f"{name}.at_acceleration_limit", load.at_acceleration_limit, share
            yield f"{name}.rate_step", load.rate_step_rad_s, float(found.rate_step[j])
            for driven in get_args(Driven):
                own = getattr(limit, driven)
                if math.isfinite(own):
                    yield f"{name}.{driven}_limit", load.limit(driven), own


class _Drive(NamedTuple):
    """Largest magnitudes of a motion, and the share of time at an acceleration limit, (3,)."""

    rate: Floats
    acceleration: Floats
    jerk: Floats
    rate_step: Floats
    at_limit: Floats


def _drive(motion: Motion, machine: Machine) -> _Drive:
    limit = np.array([each.acceleration for each in machine.limits])
    most, full = np.zeros((4, len(JOINTS))), np.zeros(len(JOINTS))
    for piece in motion.pieces():
        part, own = piece.motion, piece.own_intervals
        found, step = magnitudes(part), np.abs(part.rate_step)
        smooth = step <= STEP_TOLERANCE
        for at, values in (
            (0, found["rate"]),
            (1, found["acceleration"]),
            (1, _by_position(part, smooth)),
            (2, np.where(smooth, np.abs(part.jerk), 0.0)),
            (3, step),
        ):
            most[at] = np.maximum(most[at], np.max(values, axis=0, initial=0.0))
        full += part.step[own] @ (np.abs(part.acceleration[own]) >= AT_LIMIT * limit)
    rate, acceleration, jerk, rate_step = most
    return _Drive(rate, acceleration, jerk, rate_step, full / np.sum(motion.step))


def _by_position(motion: Motion, smooth: Flags) -> Floats:
    """Return the second differences of commanded positions, (n - 2, 3) [rad/s^2].

    The arm is commanded by its rate, and where a rate steps a difference means nothing.
    """
    rate = np.diff(motion.angle, axis=0) / motion.step[:, None]
    apart = 0.5 * (motion.step[1:] + motion.step[:-1])
    second = np.where(smooth, np.abs(np.diff(rate, axis=0) / apart[:, None]), 0.0)
    second[:, 0] = 0.0
    return np.asarray(second)


def _jump(values: Floats) -> float:
    """Return the largest difference of the two sides of a sample."""
    count = len(values) // 2
    return float(np.max(np.abs(values[1:count] - values[count:-1]), initial=0.0))


def _length(vectors: Floats) -> Floats:
    return np.asarray(np.sqrt(np.sum(vectors**2, axis=0)))
