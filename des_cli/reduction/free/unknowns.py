"""The unknowns of a free motion, and the maps from them to the points of its grid.

A vector of the full space is flat: the control points' deviations, (n, 3), then the
angles of the seat that are free, (s,).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from des_cli.model.arrays import Floats
from des_cli.reduction.free.windows import JOINTS, Windows
from des_cli.solver.spline import SplineGrid

SEAT_VARIABLES = ((0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2))
"""Order and joint of the variables of ``kinematics.twist``, in their order."""

ANGLE_VARIABLES = tuple((0, joint) for joint in range(JOINTS))
"""The joint angles themselves."""


@dataclass(frozen=True, eq=False)
class Unknowns:
    """What the unknowns are.

    Parameters
    ----------
    grid : SplineGrid
        With n control points.
    angles : int
        Free angles of the seat, s.
    """

    grid: SplineGrid
    angles: int

    @property
    def size(self) -> int:
        """Length of a vector of the full space, 3 n + s."""
        return self.grid.points * JOINTS + self.angles

    def control(self, x: Floats) -> Floats:
        """Return the part of a vector that is control points, (n, 3) [rad], as a view."""
        return x[: self.grid.points * JOINTS].reshape(-1, JOINTS)

    def seat_angles(self, x: Floats) -> Floats:
        """Return the part of a vector that is the seat's angles, (s,) [rad], as a view."""
        return x[self.grid.points * JOINTS :]

    @cached_property
    def seat_windows(self) -> Windows:
        """The map to what the seat's motion depends on."""
        return Windows(self.grid, SEAT_VARIABLES)

    @cached_property
    def angle_windows(self) -> Windows:
        """The map to the joint angles."""
        return Windows(self.grid, ANGLE_VARIABLES)
