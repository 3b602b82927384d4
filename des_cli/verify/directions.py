"""Smooth local changes of one joint, along which first-order conditions are tested.

A direction changes the rates at the samples of a window and the angles by their
integral, exactly as a table would play it; outside of the window it changes nothing. Its
angle is a bump, or, where the motion's end is free, a rise to the end or a fall from the
start. They stay clear of every limit that may hold the motion.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from des_cli.model.arrays import Flags, Floats
from des_cli.model.machine import JOINTS
from des_cli.model.metric import PEAK_METRICS
from des_cli.verify.budgets import at_states
from des_cli.verify.claim import Claim
from des_cli.verify.ends import STANDSTILL
from des_cli.verify.limits import magnitudes
from des_cli.verify.occupant import excesses, steepness

TIGHT = 1e-2
"""Distance from a limit, relative, within which it may hold the motion. A limit acts on
control points and between them: at the samples a little is left of one that holds."""

COARSE_STEP, MOST_TIGHT = 0.01, 0.3
"""Mean step [s] from which a table differs from the smooth motion that it samples, with the
step squared; so does the distance from a bound at samples within which it may hold."""

GUARD = 0.04
"""Time [s] by which a window keeps away from a limit that may hold: a limit on a control
point of a spline holds what is beside it."""

SHORTEST, FEWEST = 0.3, 14
"""Shortest window [s] and the least number of its intervals: a bump must be smooth for
whoever has knots of 40 ms, or none between the samples."""

SHARES = (1 / 5, 1 / 12)
"""Longest windows of the two kinds, as shares of the motion."""

EACH = 4
"""Windows of each kind and joint, at the most."""

SAMPLED = 256
"""Intervals of a window that are evaluated, at the most: of a longer one every second,
third, and so on. What is integrated over it is smooth, unless the record is rough: then all."""


@dataclass(frozen=True, eq=False)
class Direction:
    """A change of one joint in a window of samples.

    Parameters
    ----------
    joint : int
    first : int
        Sample at which the window begins.
    rate : (k,) array
        Change of the rate at its samples, largest magnitude one [rad/s].
    angle : (k,) array
        Change of the angle, the integral of the rate's [rad].
    most : int
        Intervals that are evaluated, at the most.
    """

    joint: int
    first: int
    rate: Floats
    angle: Floats
    most: int = SAMPLED

    @property
    def sampled(self) -> NDArray[np.intp]:
        """Intervals that are evaluated, as indices into the window."""
        count = len(self.rate) - 1
        return np.arange(0, count, max(1, -(-count // self.most)))


def find_directions(claim: Claim) -> list[Direction]:
    """Return the directions in which a free motion can go both ways."""
    t, reduction = claim.modified.t, claim.reduction
    free = _free(claim)
    last = len(t) - 1
    found: list[Direction] = []
    for j, joint in enumerate(JOINTS):
        if joint in reduction.hold:
            continue
        runs = list(_runs(free[:, j]))
        for share in SHARES:
            windows = [w for run in runs for w in _windows(t, run, share)]
            windows.sort(key=lambda w: t[w[0]] - t[w[1]])
            found += [_direction(t, j, "bump", *window) for window in windows[:EACH]]
        at_start = [w for run in runs for w in _windows(t, run, SHARES[0]) if w[0] == 0]
        at_end = [w for run in runs for w in _windows(t, run, SHARES[0]) if w[1] == last]
        for window in at_start:
            if reduction.ends == "free":
                found.append(_direction(t, j, "leave", *window))
            if f"{joint}_start" in reduction.optimise:
                found.append(_direction(t, j, "fall", *window))
        for window in at_end:
            if reduction.ends in ("free", "match-start"):
                found.append(_direction(t, j, "arrive", *window))
            if reduction.ends != "match-both":
                found.append(_direction(t, j, "rise", *window))
    return [replace(each, most=len(t)) for each in found] if claim.rough else found


def coarseness(claim: Claim) -> float:
    """Return the square of the mean step over one that is coarse, or one."""
    return max(1.0, (float(np.mean(claim.modified.step)) / COARSE_STEP) ** 2)


def _direction(t: Floats, joint: int, shape: str, first: int, last: int) -> Direction:
    """Return a direction over the samples first to last."""
    time = t[first : last + 1]
    x = (time - time[0]) / (time[-1] - time[0])
    rest = x * (1.0 - x)
    shapes = {
        "bump": rest**2 * (1.0 - 2.0 * x),  # angle x^3 (1 - x)^3
        "leave": (1.0 - x) ** 2 * (1.0 - 4.0 * x),  # x (1 - x)^3
        "arrive": x**2,  # x^3
        "rise": rest**2,
        "fall": -(rest**2),
    }
    rate = shapes[shape]
    if shape in ("bump", "leave"):
        # the trapezoidal rule of the table leaves a little of the angle, which goes back
        back = shapes["rise"]
        rate = rate - back * (_integral(time, rate)[-1] / _integral(time, back)[-1])
    rate = rate / np.max(np.abs(rate))
    angle = _integral(time, rate)
    if shape == "fall":
        angle = angle - angle[-1]
    return Direction(joint, first, rate, angle)


def _integral(t: Floats, rate: Floats) -> Floats:
    return np.concatenate([[0.0], np.cumsum(0.5 * np.diff(t) * (rate[:-1] + rate[1:]))])


def _free(claim: Claim) -> Flags:
    """Return the samples at which nothing holds a joint, (n, 3)."""
    n = len(claim.modified.t)
    near = min(TIGHT * coarseness(claim), MOST_TIGHT)
    free = np.ones((n, len(JOINTS)), dtype=bool)
    if claim.enforced:
        limits = claim.profile.machine.limits
        for piece in claim.modified.pieces():
            own = free[piece.first : piece.first + piece.own.stop - piece.own.start]
            for quantity, values in magnitudes(piece.motion).items():
                bound = np.array([getattr(limit, quantity) for limit in limits])
                own &= values[piece.own] < (1.0 - TIGHT) * bound
        occupant = claim.profile.machine.occupant
        for _, _, excess in excesses(occupant, claim.modified, claim.after):
            free &= _at_samples(excess < -near)[:, None]
        if np.isfinite(occupant.g_onset):
            steep = steepness(occupant, claim.modified, claim.after)
            free &= _at_samples(np.tile(steep < -near, 2))[:, None]
    for budget in claim.reduction.budget:
        if budget.metric in PEAK_METRICS:
            values = at_states(claim, budget.metric, claim.after)
            free &= _at_samples(values < (1.0 - near) * budget.most)[:, None]
    if claim.reduction.control == "per-joint":
        free &= _moving(claim.desired.rate)
    return _guarded(claim.modified.t, free)


def _moving(rate: Floats) -> Flags:
    """Return where a desired joint moves on: a factor on its rate can change the motion."""
    moving = np.abs(rate) > STANDSTILL * np.max(np.abs(rate), axis=0)
    turns = rate[:-1] * rate[1:] <= 0.0
    moving[:-1] &= ~turns
    moving[1:] &= ~turns
    return np.asarray(moving)


def _at_samples(states: Flags) -> Flags:
    """Return whether both sides of each sample have a flag, (n,)."""
    count = len(states) // 2
    samples = np.ones(count + 1, dtype=bool)
    samples[:-1] = states[:count]
    samples[1:] &= states[count:]
    return samples


def _guarded(t: Floats, free: Flags) -> Flags:
    """Take away what is too near to a sample that is held."""
    guard = max(GUARD, 2.0 * float(np.max(np.diff(t))))
    for joint in range(free.shape[1]):
        held = np.append(t[~free[:, joint]], np.inf)
        free[:, joint] &= held[np.searchsorted(held, t - guard)] > t + guard
    return free


def _runs(free: Flags) -> Iterator[tuple[int, int]]:
    """Yield first and last sample of each stretch that is free."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], free, [False]]).astype(int)))
    for first, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        yield first, end - 1


def _windows(t: Floats, run: tuple[int, int], share: float) -> Iterator[tuple[int, int]]:
    """Yield windows inside a stretch: its whole length, or evenly spread over it."""
    first, last = run
    span, length = float(t[last] - t[first]), max(share * float(np.ptp(t)), SHORTEST)
    count = min(EACH, max(1, int(1.5 * span / length)))
    if count == 1:
        length = span
    middles = 0.5 * (t[1:] + t[:-1])
    for at in np.linspace(0.0, span - length, count):
        begin, end = np.searchsorted(middles, t[first] + np.array([at, at + length])).tolist()
        if end - begin >= FEWEST and t[end] - t[begin] >= 0.99 * SHORTEST:
            yield begin, end
