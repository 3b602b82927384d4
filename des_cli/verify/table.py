"""What a machine can be told by the rows of a command table alone.

A table gives positions of the fork and the cab and the rate of the arm; what happens between
two rows it does not say. So rates, accelerations and jerks of the fork and the cab are those
of divided differences, which are means of the true ones over two to four rows: a motion that
keeps its limits never seems to break one, and one wrong row stands out by the step's second
and third power. Doubles are exact to ``ROUNDING``, and so are differences of them over the
step, its square and its cube: with steps of microseconds a jerk can no longer be told.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.command_table import CommandTable
from des_cli.model.felt import G_AXES, Felt
from des_cli.model.machine import JOINTS, JointLimits, Machine, Seat
from des_cli.model.motion import Motion
from des_cli.model.run import Check
from des_cli.verify.felt import SeatChain
from des_cli.verify.limits import LIMIT_TOLERANCE
from des_cli.verify.occupant import excesses
from des_cli.verify.stopping import State, stopping_checks

ROUNDING = 4.0 * float(np.finfo(np.float64).eps)
"""Relative error of a number in a table: two conversions of units and the text."""

STOPPING_TOLERANCE = 1e-2
"""Excess over a limit, relative, that a stop may have whose first rate and acceleration are
divided differences of the last rows."""

OCCUPANT_TOLERANCE = 1e-2
"""The same over a bound for the occupant: the accelerations that make G are means over rows."""

RIDE_TOLERANCE = 0.05
"""Relative excess over a number that was told of the ride."""

LEAST_ROWS = 3
"""Of a table, from which an acceleration follows."""

LEAST_TOLD = 0.05
"""Of a number of the ride, in rad/s^2 or g, below which its excess is not relative to it."""


@dataclass(frozen=True)
class Course:
    """What a joint does along the rows.

    Parameters
    ----------
    step : (n - 1,) array
        [s]
    angle : (n,) array
        [rad]
    rate : (k,) array
        [rad/s], at rows or between them.
    acceleration, jerk : arrays
        [rad/s^2], [rad/s^3], of divided differences.
    rounding : mapping
        How much of each may be rounding of doubles, by quantity.
    """

    step: Floats
    angle: Floats
    rate: Floats
    acceleration: Floats
    jerk: Floats
    rounding: Mapping[str, float]

    @classmethod
    def of_rates(cls, step: Floats, rate: Floats, start: float) -> Course:
        """Return the course of the arm, whose rate is commanded."""
        acceleration = np.diff(rate) / step
        jerk = np.diff(acceleration) / (0.5 * (step[1:] + step[:-1]))
        rise = 0.5 * step * (rate[1:] + rate[:-1])
        angle = start + np.concatenate([[0.0], np.cumsum(rise)])
        fuzz, h = ROUNDING * float(np.max(np.abs(rate))), float(np.min(step))
        rounding = {"rate": fuzz, "acceleration": 2.0 * fuzz / h, "jerk": 4.0 * fuzz / h**2}
        return cls(step, angle, rate, acceleration, jerk, rounding)

    @classmethod
    def of_positions(cls, step: Floats, angle: Floats) -> Course:
        """Return the course of a joint whose position is commanded."""
        rate = np.diff(angle) / step
        acceleration = np.diff(rate) / (0.5 * (step[1:] + step[:-1]))
        # Over the longer of the row's step and its neighbours' mean: a mean of true jerks
        # then, however uneven the steps are.
        beside = np.maximum(step[1:-1], 0.5 * (step[:-2] + step[2:]))
        jerk = np.diff(acceleration) / beside
        fuzz, h = ROUNDING * float(np.max(np.abs(angle))), float(np.min(step))
        rounding = {
            "rate": 2.0 * fuzz / h,
            "acceleration": 4.0 * fuzz / h**2,
            "jerk": 8.0 * fuzz / h**3,
        }
        return cls(step, angle, rate, acceleration, jerk, rounding)

    def end(self, last: bool) -> State:
        """Return the state at the last row, or at the first."""
        row, before = (-1, 1.0) if last else (0, -1.0)
        acceleration = float(self.acceleration[row]) if len(self.acceleration) else 0.0
        # A rate at the row itself, or of the middle of the last interval.
        half = 0.5 * self.step[row] if len(self.rate) == len(self.step) else 0.0
        rate = float(self.rate[row]) + before * acceleration * float(half)
        return State(float(self.angle[row]), rate, acceleration)


@dataclass(frozen=True)
class Played:
    """A command table with what follows from its rows."""

    table: CommandTable
    arm_start: float = 0.0

    @cached_property
    def courses(self) -> tuple[Course, Course, Course]:
        """Of arm, fork and cab."""
        table = self.table
        return (
            Course.of_rates(table.step, table.arm_rate, self.arm_start),
            Course.of_positions(table.step, table.position[:, 0]),
            Course.of_positions(table.step, table.position[:, 1]),
        )

    @cached_property
    def middles(self) -> Motion:
        """Its motion through the middles of the steps, between which rates are linear."""
        table, step = self.table, self.table.step
        middle = table.t[:-1] + 0.5 * step
        arm = 0.5 * (table.arm_rate[1:] + table.arm_rate[:-1])
        rate = np.column_stack([arm, self.courses[1].rate, self.courses[2].rate])
        angle = np.column_stack([course.angle for course in self.courses])
        between = 0.5 * (angle[1:] + angle[:-1])
        return Motion(middle, between, rate[:-1], rate[1:])


@dataclass(frozen=True)
class Ride:
    """What the seat does along the rows, as far as they tell.

    Parameters
    ----------
    t : (m,) array
        Middles of the intervals between the rows' middles, m = n - 2 [s].
    turning_rms, turning_peak : float
        Of the total angular acceleration dW/dt [rad/s^2].
    g : (3, 2 m) array
        G-vector at the start of every interval, then at the end of every one [g].
    """

    t: Floats
    turning_rms: float
    turning_peak: float
    g: Floats

    @property
    def mean_g(self) -> Floats:
        """Of each interval, (3, m) [g]."""
        m = len(self.t)
        return 0.5 * (self.g[:, :m] + self.g[:, m:])


def ride_of(table: CommandTable, machine: Machine, seat: Seat) -> Ride:
    """Return what the seat does along a table of at least ``LEAST_ROWS`` rows."""
    motion = Played(table).middles
    m = len(motion.step)
    total, largest, g = 0.0, np.zeros(1), np.empty((3, 2 * m))
    for part, (start, end) in SeatChain(machine, seat).blocks(motion):
        for shift, (_, _, turning, here) in ((0, start), (m, end)):
            square = np.sum(turning**2, axis=0)
            total += float(motion.step[part] @ square)
            largest = np.maximum(largest, np.max(square))
            g[:, shift + part.start : shift + part.stop] = here
    return Ride(
        motion.t[:-1] + 0.5 * motion.step,
        float(np.sqrt(0.5 * total / np.sum(motion.step))),
        float(np.sqrt(largest[0])),
        g,
    )


def check_times(table: CommandTable) -> Check:
    """Count the rows whose time does not rise."""
    back = float(np.sum(~(table.step > 0.0)))
    return Check("table.times", "count of rows whose time does not rise", back, 0.0)


def check_rows(table: CommandTable, right: CommandTable) -> list[Check]:
    """Compare a table with what it is to be, to the last bits.

    Parameters
    ----------
    table, right : CommandTable
    """
    off = abs(len(table.t) - len(right.t))
    checks = [Check("table.rows", "rows too many or too few", float(off), 0.0)]
    if off:
        return checks
    names = {"t": "times [s]", "arm": "arm [rad/s]", "fork": "fork [rad]", "cab": "cab [rad]"}
    columns = zip(names.items(), table.values.T, right.values.T, strict=True)
    for (key, name), found, expected in columns:
        size = float(np.max(np.abs(expected)))
        apart = float(np.max(np.abs(found - expected)))
        tolerance = 0.0 if key == "t" else ROUNDING * size
        checks.append(
            Check(f"table.{key}", f"gap between rows and solution, {name}", apart, tolerance)
        )
    return checks


def check_against(
    machine: Machine, seat: Seat, table: CommandTable, arm_start: float = 0.0
) -> list[Check]:
    """Measure a table against the limits of a machine and the bounds for its occupant.

    Parameters
    ----------
    machine : Machine
        A limit that is not a positive number fails; an infinite one is none.
    seat : Seat
        How it is fixed in the cab.
    table : CommandTable
        Of times that rise.
    arm_start : float
        Where the arm is at the first row [rad]; the table does not say.
    """
    played = Played(table, arm_start)
    checks: list[Check] = []
    for joint, limit, course in zip(JOINTS, machine.limits, played.courses, strict=True):
        checks += _limits(joint, limit, course)
        first, last = course.end(last=False), course.end(last=True)
        checks += stopping_checks(joint, limit, first, last, STOPPING_TOLERANCE)
    motion = played.middles
    if machine.occupant.bounded and len(table.t) >= LEAST_ROWS:
        felt = SeatChain(machine, seat).along(motion)
        checks += [
            Check(
                f"occupant.{key}",
                f"relative excess of the occupant's {name}",
                float(np.max(values)),
                OCCUPANT_TOLERANCE,
            )
            for key, name, values in excesses(machine.occupant, motion, felt)
        ]
    return checks


def check_ride(told: Felt, table: CommandTable, machine: Machine, seat: Seat) -> list[Check]:
    """Measure by how much a ride is harder than it is told to be.

    What is felt at the middles of the steps is a mean over rows: it is no larger than what
    was told of the rows, but for rounding and for what the rows do not resolve.

    Parameters
    ----------
    told : Felt
        The metrics; what is not known of them is not compared.
    table : CommandTable
        Of the maneuver, without leads.
    machine, seat : Machine, Seat
    """
    if len(table.t) < LEAST_ROWS:
        return []
    ride, sizes = ride_of(table, machine, seat), told.turning
    pairs = [
        ("turning_rms", "angular acceleration, rms", sizes.rms.after, ride.turning_rms),
        ("turning_peak", "angular acceleration, peak", sizes.peak.after, ride.turning_peak),
        *(
            (f"{axis}_peak", f"peak {axis.capitalize()}", told.seat_g[axis].peak.after, np.max(g))
            for axis, g in zip(G_AXES, np.abs(ride.g), strict=True)
        ),
    ]
    return [
        Check(
            f"ride.{key}",
            f"relative excess of the {name} over what the metrics tell",
            float(found) / max(value, LEAST_TOLD) - 1.0,
            RIDE_TOLERANCE,
        )
        for key, name, value, found in pairs
        if value is not None
    ]


def _limits(joint: str, limit: JointLimits, course: Course) -> Iterator[Check]:
    for quantity in ("angle", "rate", "acceleration", "jerk"):
        bound = getattr(limit, quantity)
        if bound == np.inf:
            continue
        values = getattr(course, quantity)
        largest = float(np.max(np.abs(values), initial=0.0))
        # What is no positive number is no limit that anything keeps.
        over = max(largest - course.rounding.get(quantity, 0.0), 0.0)
        share = over / bound - 1.0 if bound > 0.0 else np.nan
        yield Check(
            f"limits.{joint}.{quantity}",
            f"relative excess of the {joint}'s {quantity} over its limit",
            share,
            LIMIT_TOLERANCE,
        )
