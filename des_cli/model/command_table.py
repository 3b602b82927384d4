"""The command table, as a machine gets it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from des_cli.model.arrays import Floats, freeze
from des_cli.model.motion import Motion


@dataclass(frozen=True)
class CommandTable:
    """Rows of commands: a velocity for the arm, positions for the fork and the cab.

    Nothing else is known of it: not at what rate the fork and the cab are at a row, nor
    where the arm stands.

    Parameters
    ----------
    t : (n,) array
        [s]
    arm_rate : (n,) array
        [rad/s]
    position : (n, 2) array
        Of fork and cab [rad].
    """

    t: Floats
    arm_rate: Floats
    position: Floats

    def __post_init__(self) -> None:
        freeze(self, "t", (None,))
        freeze(self, "arm_rate", (len(self.t),))
        freeze(self, "position", (len(self.t), 2))

    @classmethod
    def of_motion(cls, motion: Motion) -> CommandTable:
        """Return the rows that play a motion."""
        return cls(motion.t, motion.rate[:, 0], motion.angle[:, 1:])

    @cached_property
    def step(self) -> Floats:
        """Time from each row to the next, (n - 1,) [s]."""
        return np.diff(self.t)

    def between(self, first: float, last: float) -> CommandTable:
        """Return the rows from one time to another, both included [s]."""
        inside = (self.t >= first) & (self.t <= last)
        return CommandTable(self.t[inside], self.arm_rate[inside], self.position[inside])

    @cached_property
    def values(self) -> Floats:
        """All its numbers, (n, 4): times, the arm's rate, and the two positions."""
        return np.column_stack([self.t, self.arm_rate, self.position])
