"""A command table on a regular clock, at another rate or to another end, inside all limits.

What the rows are between those of the table is chosen here, and measured as any table is before a
machine gets it: with the code of the verification, which knows nothing of how they were made.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from des_cli.errors import Complaint, UsageError
from des_cli.kinematics.row_curve import RowCurve, beside_rows, through_rows
from des_cli.kinematics.standstill import come_to_rest
from des_cli.model.arrays import Floats
from des_cli.model.command_table import CommandTable
from des_cli.model.joint_rows import JointRows
from des_cli.model.machine import JOINTS, Machine, Seat
from des_cli.model.run import Check
from des_cli.release.clocked import Clock, Clocked
from des_cli.verify.limits import LIMIT_TOLERANCE
from des_cli.verify.table import check_against

LEAST_ROWS = 2
"""Of a table on a clock, from which a rate follows."""

LAST_ROW = 1e-8
"""By how much [s] the last row may lie before a tick and is still fed at it."""

TRIES = ((2.0, 2.0), (2.0, 1.0), (3.0, 1.0))
"""Distance of the control points where rows are uneven, in median steps, and slack of the jerk at
an end at rest: what is tried of curves beside the rows, the nearest to them first."""

HELD_ROWS = 4
"""Rows of what is held that are measured: a jerk is one of four rows."""

RESTING_ROWS = 2
"""Rows after a ramp that stand still, so that they say so by themselves."""

SLOWEST = 0.01
"""Rate down to which one is looked for that keeps the limits."""

RATE_DIGITS = 3
"""Of the largest rate that keeps them."""

SAME_TIME, SAME_VALUE = 1e-12, 1e-11
"""Differences [s; rad or rad/s] that are rounding: there a row is the table's own, to the bit."""


@dataclass(frozen=True)
class Playback:
    """A table with the machine that plays it.

    Parameters
    ----------
    table : CommandTable
        That passed the checks of ``release.stored``.
    machine, seat : Machine, Seat
    arm_start : float
        Where the arm is at the first row [rad].
    label : str
        What messages call the table.
    """

    table: CommandTable
    machine: Machine
    seat: Seat
    arm_start: float = 0.0
    label: str = ""

    def on(self, clock: Clock) -> Clocked:
        """Return the rows on a clock, each joint through the table's rows where its limits allow.

        The others pass beside their rows (``kinematics.row_curve``). What the checks say of the
        last attempt is what they say.

        Raises
        ------
        UsageError
            If the table has no two rows on the clock.
        """
        table = self.table
        if self.count(clock) < LEAST_ROWS:
            length = f"{table.t[-1] - table.t[0]:g} s at rate {clock.rate:g}"
            what = f"it lasts {length}: less than two rows at {clock.hz:g} Hz"
            raise UsageError([Complaint(self.label, what)])
        columns = table.values[:, 1:]
        curves = [through_rows(table.t, columns[:, [j]]) for j in range(len(JOINTS))]
        tries = [0] * len(JOINTS)
        while True:
            clocked = self._rows(curves, clock)
            broken = {check.key.split(".")[1] for check in clocked.failed}
            worse = [
                j for j, joint in enumerate(JOINTS) if joint in broken and tries[j] < len(TRIES)
            ]
            if not worse:
                return clocked
            for j in worse:
                curves[j] = beside_rows(table.t, columns[:, [j]], *TRIES[tries[j]], rates=j == 0)
                tries[j] += 1

    def own_rows(self, *, bounded: bool = True) -> JointRows:
        """Return the rows of the table, with the rates and accelerations of a curve through them.

        Who joins rows by their positions, rates and accelerations joins them by that curve.

        Parameters
        ----------
        bounded : bool
            Whether these are not to tell more than the limits, which the rows keep: the curve
            through rows at a limit may pass it a little.
        """
        table = self.table
        columns = table.values[:, 1:]
        curves = [through_rows(table.t, columns[:, [j]]) for j in range(len(JOINTS))]
        angle, speed, acceleration = self._states(curves, table.t, 1.0)
        angle[:, 1:], speed[:, 0] = table.position, table.arm_rate
        if bounded:
            for values, quantity in ((speed, "rate"), (acceleration, "acceleration")):
                most = np.array([getattr(limit, quantity) for limit in self.machine.limits])
                values[:] = np.clip(values, -most, most)
        return JointRows(table.t, angle, speed, acceleration)

    def count(self, clock: Clock) -> int:
        """Return how many rows of the clock lie in the table."""
        length = float(self.table.t[-1] - self.table.t[0]) / clock.rate
        return math.floor((length + LAST_ROW) * clock.hz) + 1

    def largest_rate(self, clock: Clock) -> float | None:
        """Return the largest rate below a clock's that keeps all limits, or None."""

        def keeps(rate: float) -> bool:
            return not self.on(Clock(clock.hz, rate, clock.end)).failed

        high, low = clock.rate, 1.0 if clock.rate > 1.0 else 0.5 * clock.rate
        while not keeps(low):
            high, low = low, 0.5 * low
            if low < SLOWEST:
                return None
        while high / low > 1.0 + 10.0**-RATE_DIGITS:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if keeps(middle) else (low, middle)
        digits = RATE_DIGITS - 1 - math.floor(math.log10(low))
        return math.floor(low * 10.0**digits) / 10.0**digits

    def _rows(self, curves: Sequence[RowCurve], clock: Clock) -> Clocked:
        table, rate = self.table, clock.rate
        start, last = float(table.t[0]), float(table.t[-1])
        count = self.count(clock)
        t = start + np.arange(count) / clock.hz
        inside = np.minimum(start + rate * (np.arange(count) / clock.hz), last)
        states = self._states(curves, inside, rate)
        _meet(table, inside, states, rate)
        rows = JointRows(t, *states)
        ended = JointRows.joined([rows, *self._end(curves, clock, count)])
        on_rows = [curve.at(table.t)[:, 0] for curve in curves]
        checks = check_against(self.machine, self.seat, ended.commands, self.arm_start)
        broken = {check.key for check in checks if not check.ok}
        # What the differences of the rows say already is not said twice.
        told = [
            each
            for each in _told(self.machine, ended)
            if each.key.replace("rows.", "limits.") not in broken
        ]
        return Clocked(
            ended,
            count,
            (*checks, *told),
            np.max(np.abs(np.column_stack(on_rows) - table.values[:, 1:]), axis=0),
        )

    def _states(
        self, curves: Sequence[RowCurve], t: Floats, rate: float
    ) -> tuple[Floats, Floats, Floats]:
        """Return angle, rate and acceleration at times of the table, (k, 3) each."""
        turned = curves[0].at(t, -1) - curves[0].at(self.table.t[:1], -1)
        # The arm is given by its rate: all of its derivatives come one earlier.
        orders = [[curve.at(t, order)[:, 0] for order in range(3)] for curve in curves]
        arm, fork, cab = orders
        angle = np.column_stack([self.arm_start + turned[:, 0], fork[0], cab[0]])
        speed = np.column_stack([arm[0], fork[1], cab[1]])
        acceleration = np.column_stack([arm[1], fork[2], cab[2]])
        return angle, rate * speed, rate**2 * acceleration

    def _end(self, curves: Sequence[RowCurve], clock: Clock, count: int) -> Iterator[JointRows]:
        """Yield the rows that follow those of the table."""
        if clock.end == "stop":
            return
        table = self.table
        states = self._states(curves, table.t[-1:], clock.rate)
        _meet(table, table.t[-1:], states, clock.rate)
        angle, rate, acceleration = (each[0] for each in states)
        start, length = table.t[0], (table.t[-1] - table.t[0]) / clock.rate
        if clock.end == "hold":
            ticks = count + np.arange(HELD_ROWS)
            away = ticks / clock.hz - length
            held = np.tile(angle, (HELD_ROWS, 1))
            held[:, 0] += away * rate[0]
            speed = np.tile([rate[0], 0.0, 0.0], (HELD_ROWS, 1))
            yield JointRows(start + ticks / clock.hz, held, speed, np.zeros_like(held))
            return
        stops = [
            come_to_rest(float(x), float(v), float(a), limit)
            for x, v, a, limit in zip(angle, rate, acceleration, self.machine.limits, strict=True)
        ]
        longest = max(stop.duration for stop in stops)
        ticks = count + np.arange(math.ceil((length + longest) * clock.hz) - count + RESTING_ROWS)
        after = ticks / clock.hz - length
        ways = zip(*(stop.at(after) for stop in stops), strict=True)
        yield JointRows(start + ticks / clock.hz, *(np.column_stack(each) for each in ways))


def _told(machine: Machine, rows: JointRows) -> Iterator[Check]:
    """Measure the rates and accelerations that are told beside the rows."""
    for j, (joint, limit) in enumerate(zip(JOINTS, machine.limits, strict=True)):
        for quantity, values in (("rate", rows.rate), ("acceleration", rows.acceleration)):
            bound = getattr(limit, quantity)
            if math.isfinite(bound):
                yield Check(
                    f"rows.{joint}.{quantity}",
                    f"relative excess of the {joint}'s {quantity} at a row over its limit",
                    float(np.max(np.abs(values[:, j]))) / bound - 1.0,
                    LIMIT_TOLERANCE,
                )


def _meet(
    table: CommandTable, t: Floats, states: tuple[Floats, Floats, Floats], rate: float
) -> None:
    """Give rows that are the table's the very numbers of these, where the curve meets them."""
    row = np.clip(np.searchsorted(table.t, t - SAME_TIME), 0, len(table.t) - 1)
    same = np.abs(table.t[row] - t) <= SAME_TIME
    angle, speed, _ = states
    pairs = (
        (speed[:, 0], table.arm_rate, rate),
        (angle[:, 1], table.position[:, 0], 1.0),
        (angle[:, 2], table.position[:, 1], 1.0),
    )
    for values, theirs, factor in pairs:
        right = factor * theirs[row]
        close = same & (np.abs(values - right) <= SAME_VALUE)
        values[close] = right[close]
