"""More rows where the rows of a record are too far apart to hold its turning.

A table of joint motion has rates that are linear between its rows. The seat's rate is not
linear in them: while the fork and the cab turn, the joint rates that keep a steady seat rate
change all the time. Rows that are far apart are therefore divided, at values of the
interpolant; the recorded rows stay, and so do those of a record that resolves its motion.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from des_cli.kinematics.joint_integration import integrate_joints
from des_cli.kinematics.orientation import body_jacobian
from des_cli.kinematics.rate_field import RateField
from des_cli.model.arrays import Flags, Floats
from des_cli.model.gaps import longest_step
from des_cli.model.metric import UNFELT_ANGULAR_ACCELERATION
from des_cli.model.motion import Motion
from des_cli.model.profile import BodyRates

TOLERANCE = 1e-3
"""Largest error of the seat's rate between rows, over the root mean square of the record."""

SHAPE_TURN = 1e-3
"""Angle [rad], of the seat over one recorded step, up to which the straight line between two
samples says as much as the interpolant: 0.06 degrees, and from step to step of changing sign.
Without it every row of a noisy record would be divided, to follow curves that are noise."""

TURNING_TURN = 3e-5
"""The same for what the turning of the joints makes of a step, which adds up from step to
step: over ten seconds of a record at 100 Hz to less than two degrees at the very worst."""

FELT_SLOPE = 0.5 * UNFELT_ANGULAR_ACCELERATION
"""Error of the seat's angular acceleration [rad/s^2] up to which the rows that are added hold
it: a budget on it would else be spent by the steps of the table."""

MOST_PIECES = 16
"""Pieces that an interval is divided into at a time, before its error is measured again."""

MOST_ROUNDS = 8
"""Times that the rows are divided, at the most."""

SHORTEST_PIECE = 0.01
"""Time between rows [s] that is not divided: at 5 rad/s, which no joint holds for long, the
seat's rate is off by 0.05 * 0.05 / 8 of itself. What is left then are the corners of joint
rates that are held at a limit, which no row resolves."""

MOST_ROWS = 1_000_000
"""Rows from which nothing is divided any more."""

_WITHIN = (0.25, 0.5, 0.75)
"""Parts of an interval at which errors are measured."""


Indices: TypeAlias = NDArray[np.intp]


@dataclass(frozen=True)
class Demand:
    """Body rates on rows that resolve them, and the joint angles there.

    Parameters
    ----------
    t : (n,) array
        [s]
    command : BodyRates
    angle : (n, 3) array
        [rad]
    remark : str
        A sentence on the rows that were added; empty without any.
    """

    t: Floats
    command: BodyRates
    angle: Floats
    remark: str = ""

    @property
    def step(self) -> Floats:
        """Length of each interval, (n - 1,) [s]."""
        return np.diff(self.t)


def as_they_are(field: RateField, t: Floats, command: BodyRates, initial: Floats) -> Demand:
    """Integrate body rates to joint angles on their own rows; see `resolve`."""
    return Demand(t, command, integrate_joints(field, np.diff(t), command, initial))


def resolve(field: RateField, t: Floats, command: BodyRates, initial: Floats) -> Demand:
    """Integrate body rates to joint angles, on as many rows as their turning needs.

    Parameters
    ----------
    field : RateField
    t : (n,) array
        Recorded times [s].
    command : BodyRates
    initial : (3,) array
        Joint angles at the first sample [rad].
    """
    demand = as_they_are(field, t, command, initial)
    sides = np.stack([command.start, command.end])
    tolerance = TOLERANCE * float(np.sqrt(np.mean(np.sum(sides**2, axis=-1))))
    divided = np.zeros(len(t) - 1, dtype=bool)
    for _ in range(MOST_ROUNDS):
        pieces = _pieces(field, demand, divided, tolerance)
        if np.all(pieces == 1) or int(np.sum(pieces)) >= MOST_ROWS:
            break
        fine_t, fine = _divide(demand, pieces)
        angle = integrate_joints(field, np.diff(fine_t), fine, initial)
        divided = np.repeat(divided | (pieces > 1), pieces)
        demand = Demand(fine_t, fine, angle)
    return replace(demand, remark=_remark(t, demand)) if divided.any() else demand


def _remark(t: Floats, demand: Demand) -> str:
    """Say which rows were divided, and into how short pieces."""
    parent = np.searchsorted(t, demand.t[:-1], side="right") - 1
    divided = np.bincount(parent)[parent] > 1
    return (
        f"rows up to {np.diff(t)[parent[divided]].max():.4g} s apart were refined to "
        f"{demand.step[divided].min():.3g} s, to hold the turning between them: "
        f"{len(t):,} rows became {len(demand.t):,}"
    )


def _pieces(field: RateField, demand: Demand, divided: Flags, tolerance: float) -> Indices:
    """Return into how many pieces each interval goes, (n - 1,) whole numbers."""
    error, turn = _errors(field, demand, divided)
    error[~divided & (error * demand.step <= TURNING_TURN)] = 0.0
    ratio = error / max(tolerance, np.finfo(np.float64).tiny)
    # The error falls with the square of the step.
    wanted = np.where(ratio > 1.0, np.exp2(np.ceil(0.5 * np.log2(np.maximum(ratio, 1.0)))), 1.0)
    # Its slope, which the seat's angular acceleration is off by, falls with the step.
    steep = np.maximum(4.0 * error / (demand.step * FELT_SLOPE), 1.0)
    wanted[divided] = np.maximum(wanted, np.exp2(np.ceil(np.log2(steep))))[divided]
    wanted[(turn > SHAPE_TURN) & (wanted == 1.0)] = 2.0
    # Reading calls longer steps a gap, and a command table is to be read again.
    over = demand.step / (longest_step(demand.t) * (1.0 + 1e-9))
    wanted = np.maximum(wanted, np.exp2(np.ceil(np.log2(np.maximum(over, 1.0)))))
    most = np.exp2(np.floor(np.log2(np.maximum(demand.step / SHORTEST_PIECE, 1.0))))
    return np.minimum(np.minimum(wanted, MOST_PIECES), most).astype(np.intp)


def _errors(field: RateField, demand: Demand, divided: Flags) -> tuple[Floats, Floats]:
    """Return how well linear joint rates make the seat's rates on each interval.

    Returns
    -------
    error : (n - 1,) array
        Largest error of the seat's rate [rad/s]: against the interpolant in intervals
        that were divided, and against the straight line between two samples in others.
    turn : (n - 1,) array
        By how much the seat turns otherwise with the line than with the interpolant
        [rad]; 0 in intervals that were divided.
    """
    command, chain = demand.command, field.chain
    rates = [
        field.rates(body_jacobian(chain, angle), wanted)[0]
        for angle, wanted in ((demand.angle[:-1], command.start), (demand.angle[1:], command.end))
    ]
    motion = Motion(demand.t, demand.angle, rates[0], rates[1])
    error = np.zeros(len(divided))
    for s in _WITHIN:
        line = command.start + s * (command.end - command.start)
        wanted = np.where(divided[:, None], command.at(s), line)
        jacobian = body_jacobian(chain, _angles_within(motion, s))
        linear = rates[0] + s * (rates[1] - rates[0])
        missing = linear - field.rates(jacobian, wanted)[0]
        seat = np.asarray((jacobian @ missing[..., None])[..., 0])
        error = np.maximum(error, np.linalg.norm(seat, axis=1))
    # Simpson's rule, which is exact for both.
    bow = 2.0 / 3.0 * (command.middle - 0.5 * (command.start + command.end))
    turn = np.where(divided, 0.0, demand.step * np.linalg.norm(bow, axis=1))
    return error, turn


def _angles_within(motion: Motion, s: float) -> Floats:
    """Return the joint angles at a part of every interval, by the cubic of its ends, (n - 1, 3)."""
    h, rise = motion.step[:, None], np.diff(motion.angle, axis=0)
    first, last = h * motion.rate_start, h * motion.rate_end
    square, cube = 3.0 * rise - 2.0 * first - last, first + last - 2.0 * rise
    return np.asarray(motion.angle[:-1] + s * (first + s * (square + s * cube)))


def _divide(demand: Demand, pieces: Indices) -> tuple[Floats, BodyRates]:
    """Divide intervals into equal pieces, on which the interpolant stays what it was."""
    command, parent = demand.command, np.repeat(np.arange(len(pieces)), pieces)
    number = np.arange(len(parent)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    width = 1.0 / pieces[parent]
    a, b = (number * width)[:, None], ((number + 1) * width)[:, None]
    t = np.append(demand.t[parent] + a[:, 0] * demand.step[parent], demand.t[-1])
    powers = command.powers[parent]

    def at(s: Floats) -> Floats:
        c, line, square, cube = np.moveaxis(powers, 1, 0)
        return np.asarray(c + s * (line + s * (square + s * cube)))

    start, end = at(a), at(b)
    last = number + 1 == pieces[parent]
    end[last] = command.end[parent[last]]
    attitude = None
    if command.attitude is not None:
        attitude = np.full((len(t), 4), np.nan)
        attitude[np.append(np.cumsum(pieces) - pieces, len(parent))] = command.attitude
    skew = None if command.skew is None else command.skew[parent] * width[:, None] ** 3
    return t, BodyRates(start, at(0.5 * (a + b)), end, attitude, skew)
