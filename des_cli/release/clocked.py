"""Rows on a regular clock: of a command table, and of what follows its end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.joint_rows import JointRows
from des_cli.model.run import Check

End: TypeAlias = Literal["hold", "ramp", "stop"]

HELD_BLOCK = 64
"""Further rows of it that are made at a time."""


@dataclass(frozen=True)
class Clock:
    """When rows are.

    Parameters
    ----------
    hz : float
        Rows a second.
    rate : float
        Seconds of the table in a second.
    end : {"hold", "ramp", "stop"}
        What follows its last row: that row for ever, a ramp to rest, or nothing.
    """

    hz: float
    rate: float = 1.0
    end: End = "stop"


@dataclass(frozen=True)
class Clocked:
    """Rows on a clock, and what was found of them.

    Parameters
    ----------
    rows : JointRows
        Of the table and of its end; of what is held the first few rows.
    table_rows : int
        How many of them are the table's.
    checks : tuple of Check
    off : (3,) array
        How far the rows pass those of the table: the arm [rad/s], fork and cab [rad].
    """

    rows: JointRows
    table_rows: int
    checks: tuple[Check, ...]
    off: Floats

    @property
    def failed(self) -> tuple[Check, ...]:
        """The checks that do not hold."""
        return tuple(check for check in self.checks if not check.ok)

    def held(self, clock: Clock, rows: int) -> JointRows:
        """Return more rows of what is held, after those that are here.

        Parameters
        ----------
        clock : Clock
        rows : int
            How many of them there are already, of the clock.
        """
        last = self.rows
        ticks = rows + np.arange(HELD_BLOCK)
        rate = np.tile(last.rate[-1], (HELD_BLOCK, 1))
        away = (ticks - (len(last.t) - 1)) / clock.hz
        angle = last.angle[-1] + away[:, None] * rate
        return JointRows(last.t[0] + ticks / clock.hz, angle, rate, np.zeros_like(angle))
