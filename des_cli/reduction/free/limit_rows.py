"""The machine's limits on a free motion, as linear rows over its control points.

Accelerations and jerks are exact: the knots' accelerations and the intervals' jerks are
differences of control points. Rates and angles are safe, inside the convex hull of
theirs; on the first and last interval the hull is that of the Bernstein polynomials, so
that a motion may begin exactly as fast as the machine may turn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from des_cli.model.arrays import Floats, Indices
from des_cli.model.machine import JointLimits
from des_cli.reduction.free.windows import JOINTS
from des_cli.solver.band import SymmetricBand
from des_cli.solver.spline import Ends, SplineGrid


@dataclass(frozen=True, slots=True)
class Tie:
    """A rate that stays where it is at one time.

    Parameters
    ----------
    time : float
        [s]
    joint : int
    bound : float
        Largest rate there [rad/s]: next to nothing.
    """

    time: float
    joint: int
    bound: float


@dataclass(frozen=True, eq=False)
class _Group:
    """Rows of one kind on some joints.

    Parameters
    ----------
    order : int
        Of the difference.
    joints : (k,) int array
    bound : (k,) array
    first, last : int
        The differences that are bounded, of those that there are.
    """

    order: int
    joints: Indices
    bound: Floats
    first: int
    last: int


class LimitRows:
    """Bounds on differences of control points.

    Parameters
    ----------
    grid : SplineGrid
    base : (n, 3) array
        Control points that deviations are added to [rad].
    limits : sequence of JointLimits
    ends : Ends
        Ends that are kept need no rows.
    margin : float
        Share of each limit that is left unused [1].
    ties : sequence of Tie
    """

    def __init__(
        self,
        grid: SplineGrid,
        base: Floats,
        limits: Sequence[JointLimits],
        ends: Ends,
        margin: float = 0.0,
        ties: Sequence[Tie] = (),
    ) -> None:
        self.grid = grid
        k = grid.intervals
        self._groups: list[_Group] = []
        # Rates and angles outside the first and last knot are no part of the motion.
        for order, name, first, last in (
            (0, "angle", 1, k + 2),
            (1, "rate", 1, k + 1),
            (2, "acceleration", 0, k + 1),
            (3, "jerk", 0, k),
        ):
            bound = np.array([getattr(limit, name) for limit in limits])
            joints = np.flatnonzero(np.isfinite(bound) & ~ends.held)
            if len(joints):
                self._groups.append(
                    _Group(order, joints, bound[joints] * (1.0 - margin), first, last)
                )
        self._tips = _Tips(grid, limits, ends, margin, ties)
        self._base = self._rows_of(base)
        self.bounds = np.concatenate(
            [
                *(np.tile(g.bound, g.last - g.first) for g in self._groups),
                self._tips.bounds,
                np.zeros(0),
            ]
        )

    def value(self, deviation: Floats) -> Floats:
        """Return the limited quantities of a deviation, (m,)."""
        return self._base + self._rows_of(deviation)

    def change(self, deviation: Floats) -> Floats:
        """Return their change by a deviation, (m,)."""
        return self._rows_of(deviation)

    def adjoint(self, multiplier: Floats) -> Floats:
        """Return the transposed rows times multipliers, (n, 3)."""
        total = np.zeros((self.grid.points, JOINTS))
        for group, values in zip(self._groups, self._split(multiplier), strict=True):
            part = self.grid.differences_adjoint(values, group.order)
            total[group.first : group.first + len(part), group.joints] += part
        self._tips.add_adjoint(multiplier[self._tip_slice], total)
        return total

    def add_to(self, band: SymmetricBand, stiffness: Floats) -> None:
        """Add ``rows' diag(stiffness) rows`` to a band."""
        n = self.grid.points
        for group, values in zip(self._groups, self._split(stiffness), strict=True):
            weight = np.zeros((n - group.order, JOINTS))
            weight[group.first : group.last, group.joints] = values
            band.add_differences(weight, group.order, self.grid.step)
        self._tips.add_to(band, stiffness[self._tip_slice])

    @property
    def _tip_slice(self) -> slice:
        return slice(len(self.bounds) - len(self._tips.bounds), len(self.bounds))

    def _rows_of(self, control: Floats) -> Floats:
        parts = []
        for group in self._groups:
            values = self.grid.differences(control[:, group.joints], group.order)
            parts.append(values[group.first : group.last].reshape(-1))
        return np.concatenate([*parts, self._tips.value(control), np.zeros(0)])

    def _split(self, rows: Floats) -> list[Floats]:
        parts, at = [], 0
        for group in self._groups:
            size = (group.last - group.first) * len(group.joints)
            parts.append(rows[at : at + size].reshape(-1, len(group.joints)))
            at += size
        return parts


class _Tips:
    """Rates and angles at single times: at the ends, where these are free, and at ties."""

    def __init__(
        self,
        grid: SplineGrid,
        limits: Sequence[JointLimits],
        ends: Ends,
        margin: float,
        ties: Sequence[Tie],
    ) -> None:
        self._rows: list[tuple[int, int, Floats]] = []  # first control point, joint, weights
        bounds: list[float] = []
        for order, name, kept_first, kept_last in (
            (0, "angle", ends.start_value, ends.end_value),
            (1, "rate", ends.start_rate, ends.end_rate),
        ):
            weight = grid.basis(np.zeros(1), order)[0, :3]
            for at, kept in ((0, kept_first), (grid.points - 3, kept_last)):
                for j, limit in enumerate(limits):
                    bound = getattr(limit, name)
                    if np.isfinite(bound) and not kept[j] and not ends.held[j]:
                        self._rows.append((at, j, weight))
                        bounds.append(bound * (1.0 - margin))
        for tie in ties:
            place = (tie.time - grid.start) / grid.step
            interval = min(max(int(place), 0), grid.intervals - 1)
            weight = grid.basis(np.array([place - interval]), 1)[0]
            self._rows.append((interval, tie.joint, weight))
            bounds.append(tie.bound)
        self.bounds = np.array(bounds)

    def value(self, control: Floats) -> Floats:
        return np.array([w @ control[at : at + len(w), j] for at, j, w in self._rows])

    def add_adjoint(self, multiplier: Floats, total: Floats) -> None:
        for value, (at, j, weight) in zip(multiplier, self._rows, strict=True):
            total[at : at + len(weight), j] += value * weight

    def add_to(self, band: SymmetricBand, stiffness: Floats) -> None:
        for value, (at, j, weight) in zip(stiffness, self._rows, strict=True):
            for b in range(len(weight)):
                for a in range(b, len(weight)):
                    band.data[at + b, j, JOINTS * (a - b)] += value * weight[a] * weight[b]
