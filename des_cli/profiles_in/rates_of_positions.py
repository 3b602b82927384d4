"""Rates between recorded samples: what a table says about the motion between its rows."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.profile import JointCommands

LEAST_SAMPLES = 4
"""Samples up to which a piecewise parabola is not determined by its smoothness."""

ROUGHEST = 4.0
"""Total variation of the acceleration, relative to the three-point formula's, up to which
positions count as those of a piecewise parabola. Noise, and a small step of the rate, leave a
sawtooth in its rates that is far rougher."""


STEP_ACCELERATION = 100.0
"""Acceleration [rad/s^2] from row to row beyond which the rate of a joint without a limit steps:
twenty times what the drives of a centrifuge do."""

STEP_ALONE, ROWS_AROUND = 20.0, 8
"""How many times the accelerations at so many rows before and after it that of a step is, at the
least. Noise has others like it around it."""


def joint_commands_of_samples(
    t: Floats,
    arm: Floats,
    position: Floats,
    *,
    arm_by_angle: bool = False,
    fastest: tuple[float, float] = (STEP_ACCELERATION, STEP_ACCELERATION),
) -> JointCommands:
    """Make commands of recorded joints.

    Parameters
    ----------
    t : (n,) array
        Increasing times, n >= 2 [s].
    arm : (n,) array
        The arm's rate [rad/s], or its angle [rad].
    position : (n, 2) array
        Fork and cab angles [rad].
    arm_by_angle : bool
        Whether the arm is given by its angle.
    fastest : (float, float)
        Accelerations of fork and cab beyond which a rate steps [rad/s^2].
    """
    sides = [rates_with_steps(t, *each) for each in zip(position.T, fastest, strict=True)]
    start, end = (np.column_stack(each) for each in zip(*sides, strict=True))
    if not arm_by_angle:
        return JointCommands(arm, position, start, end)
    arm_rate = rates_of_positions(t, arm[:, None])[:, 0]
    return JointCommands(arm_rate, position, start, end, arm_start=float(arm[0]))


def rates_with_steps(
    t: Floats, position: Floats, fastest: float = STEP_ACCELERATION
) -> tuple[Floats, Floats]:
    """Return the rates of a column of positions at both ends of every interval.

    Where its rate steps, as where two segments of a maneuver join, each side has a rate of
    its own, so that a maneuver is the same however finely it is sampled: a step that is
    smeared over two rows makes the larger an acceleration the closer they are.

    Parameters
    ----------
    t : (n,) array
        Increasing times, n >= 2 [s].
    position : (n,) array
        [rad]
    fastest : float
        Acceleration that the joint is capable of [rad/s^2]: a step asks for more.

    Returns
    -------
    start, end : (n - 1,) array
        [rad/s]
    """
    start, end = np.empty(len(t) - 1), np.empty(len(t) - 1)
    edges = [0, *_steps(t, position, fastest), len(t) - 1]
    for first, last in pairwise(edges):
        piece = slice(first, last + 1)
        rate = rates_of_positions(t[piece], position[piece, None])[:, 0]
        start[first:last], end[first:last] = rate[:-1], rate[1:]
    return start, end


def _steps(t: Floats, position: Floats, fastest: float) -> list[int]:
    """Return the rows at which the rate steps."""
    step = np.diff(t)
    chord = np.diff(position) / step
    size = np.abs(np.diff(chord)) / (0.5 * (step[1:] + step[:-1]))
    around = np.pad(size, ROWS_AROUND)
    beside = np.zeros_like(size)
    for off in range(1, ROWS_AROUND + 1):
        for at in (ROWS_AROUND - off, ROWS_AROUND + off):
            np.maximum(beside, around[at : at + len(size)], out=beside)
    found = np.flatnonzero((size > fastest) & (size > STEP_ALONE * beside))
    return [int(row) + 1 for row in found]


def rates_of_positions(t: Floats, position: Floats) -> Floats:
    """Return the rates at samples of a table of positions.

    A column whose positions are those of a motion with constant acceleration
    over each interval, as a command table's are, gets that motion's rates. Any
    other column is differentiated by the three-point formula: the slope of the
    parabola through a sample and its two neighbours, second order on any grid.

    Parameters
    ----------
    t : (n,) array
        Increasing times, n >= 2 [s].
    position : (n, k) array

    Returns
    -------
    (n, k) array
        Rate at each sample; of two samples, the rate of the chord.
    """
    step = np.diff(t)[:, None]
    chord = np.diff(position, axis=0) / step
    if len(t) == 2:
        return np.repeat(chord, 2, axis=0)
    rate = _three_point(step, chord)
    if len(t) > LEAST_SAMPLES:
        spline = _spline(step, chord, rate[0])
        smooth = _variation(step, spline) <= ROUGHEST * _variation(step, rate)
        rate[:, smooth] = spline[:, smooth]
    return rate


def _three_point(step: Floats, chord: Floats) -> Floats:
    """Return the slopes of parabolas through three samples each."""
    rate = np.empty((len(chord) + 1, chord.shape[1]))
    before, after = step[:-1], step[1:]
    rate[1:-1] = (after * chord[:-1] + before * chord[1:]) / (before + after)
    # The parabola's slope is linear: a chord is its slope in the middle of the interval.
    rate[0] = 2.0 * chord[0] - rate[1]
    rate[-1] = 2.0 * chord[-1] - rate[-2]
    return rate


def _spline(step: Floats, chord: Floats, first: Floats) -> Floats:
    """Return the rates of the piecewise parabola through the samples, (n, k).

    Its rate is linear over each interval and has the chord for its mean, which
    leaves one number open: a sawtooth +a, -a, +a, ... in the rates. It is the one
    with which the acceleration varies least in all, a weighted median.
    """
    sign = np.where(np.arange(len(chord) + 1) % 2, -1.0, 1.0)[:, None]
    folded = first + np.concatenate([0.0 * chord[:1], np.cumsum(2.0 * sign[1:] * chord, axis=0)])
    rate = sign * folded
    jump = np.diff(np.diff(rate, axis=0) / step, axis=0)
    per_tooth = 2.0 * sign[:-2] * (1.0 / step[1:] + 1.0 / step[:-1])
    tooth = _weighted_median(-jump / per_tooth, np.abs(per_tooth[:, 0]))
    return np.asarray(rate + tooth * sign)


def _weighted_median(values: Floats, weights: Floats) -> Floats:
    """Return the weighted median of each column."""
    order = np.argsort(values, axis=0)
    below = np.cumsum(weights[order], axis=0)
    middle = np.argmax(below >= 0.5 * below[-1], axis=0)
    columns = np.arange(values.shape[1])
    return np.asarray(values[order[middle, columns], columns])


def _variation(step: Floats, rate: Floats) -> Floats:
    """Return the total variation of the acceleration of rates at samples, (k,)."""
    return np.sum(np.abs(np.diff(np.diff(rate, axis=0) / step, axis=0)), axis=0)
