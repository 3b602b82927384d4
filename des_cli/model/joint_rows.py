"""Rows of all that the joints do, at instants of a clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from des_cli.model.arrays import Floats, freeze
from des_cli.model.command_table import CommandTable


@dataclass(frozen=True)
class JointRows:
    """Angle, rate and acceleration of arm, fork and cab at each row.

    Parameters
    ----------
    t : (n,) array
        [s]
    angle : (n, 3) array
        [rad]; the arm's from where it starts.
    rate : (n, 3) array
        [rad/s]
    acceleration : (n, 3) array
        [rad/s^2]
    """

    t: Floats
    angle: Floats
    rate: Floats
    acceleration: Floats

    def __post_init__(self) -> None:
        freeze(self, "t", (None,))
        for name in ("angle", "rate", "acceleration"):
            freeze(self, name, (len(self.t), 3))

    @property
    def commands(self) -> CommandTable:
        """The same as a machine gets it."""
        return CommandTable(self.t, self.rate[:, 0], self.angle[:, 1:])

    @classmethod
    def joined(cls, parts: Sequence[JointRows]) -> JointRows:
        """Return rows that follow one another."""
        return cls(
            np.concatenate([part.t for part in parts]),
            np.concatenate([part.angle for part in parts]),
            np.concatenate([part.rate for part in parts]),
            np.concatenate([part.acceleration for part in parts]),
        )
