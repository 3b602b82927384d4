"""Vector-valued uniform cubic B-splines: a motion as control points.

On interval i, with u from 0 to 1 across it, the motion is ``sum_a B_a(u) P[i + a]``,
a = 0 to 3. Its derivatives in time are B-splines too, whose control points are the
differences of P over the step: the acceleration is linear between knots and its knot
values are the second differences, the jerk is constant over each interval and is the
third difference. Bounds on these are exact. Rates and angles lie in the convex hull of
theirs.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from des_cli.model.arrays import Flags, Floats

ORDER = 4
"""Control points that an interval of a cubic depends on."""

FEWEST_INTERVALS = 3
"""So that conditions at the two ends do not share control points."""

PIECE = 8192
"""Times at which a spline is evaluated at once: what is made of them stays in a cache."""

STENCILS = tuple(
    np.array(stencil) for stencil in ((1.0,), (-1.0, 1.0), (1.0, -2.0, 1.0), (-1.0, 3.0, -3.0, 1.0))
)
"""Finite differences of order 0 to 3."""

GAUSS = (0.5 - np.sqrt(3.0) / 6.0, 0.5 + np.sqrt(3.0) / 6.0)
"""The two points of Gauss's rule on [0, 1], of equal weights."""


@dataclass(frozen=True)
class SplineGrid:
    """A uniform grid of knots.

    Parameters
    ----------
    start : float
        Time of the first knot [s].
    step : float
        Between knots [s].
    intervals : int
        K; a spline has K + 3 control points.
    """

    start: float
    step: float
    intervals: int

    def __post_init__(self) -> None:
        if self.intervals < FEWEST_INTERVALS:
            raise ValueError(f"{self.intervals} intervals, at least {FEWEST_INTERVALS} needed")

    @property
    def points(self) -> int:
        """Number of control points, n = K + 3."""
        return self.intervals + ORDER - 1

    @property
    def duration(self) -> float:
        """From the first to the last knot [s]."""
        return self.intervals * self.step

    @cached_property
    def knots(self) -> Floats:
        """Times of the knots, (K + 1,) [s]."""
        return np.asarray(self.start + self.step * np.arange(self.intervals + 1.0))

    @property
    def greville(self) -> Floats:
        """The time that each control point belongs to, (n,): a straight line's own values."""
        return np.asarray(self.start + self.step * (np.arange(self.points) - 1.0))

    def basis(self, u: Floats, order: int) -> Floats:
        """Return the basis, or a derivative of it in time, at fractions of an interval.

        Parameters
        ----------
        u : (q,) array
            0 to 1.
        order : int
            Of the derivative, 0 to 3.

        Returns
        -------
        (q, 4) array
            [1/s^order]
        """
        u = np.asarray(u, dtype=np.float64)
        one = np.ones_like(u)
        columns: tuple[Floats, ...]
        if order == 0:
            columns = (
                (1 - u) ** 3 / 6,
                (3 * u**3 - 6 * u**2 + 4) / 6,
                (-3 * u**3 + 3 * u**2 + 3 * u + 1) / 6,
                u**3 / 6,
            )
        elif order == 1:
            columns = (
                -((1 - u) ** 2) / 2,
                (3 * u**2 - 4 * u) / 2,
                (-3 * u**2 + 2 * u + 1) / 2,
                u**2 / 2,
            )
        elif order == 2:
            columns = (1 - u, 3 * u - 2, 1 - 3 * u, u)
        else:
            columns = (-one, 3 * one, -3 * one, one)
        return np.stack(columns, axis=-1) / self.step**order

    def values(self, control: Floats, t: Floats, order: int = 0) -> Floats:
        """Evaluate a spline, or its derivative, at times inside the grid.

        Parameters
        ----------
        control : (n, d) array
        t : (q,) array
            [s]
        order : int

        Returns
        -------
        (q, d) array
        """
        t = np.asarray(t)
        if len(t) > PIECE:
            pieces = (t[first : first + PIECE] for first in range(0, len(t), PIECE))
            return np.concatenate([self.values(control, piece, order) for piece in pieces])
        at = (t - self.start) / self.step
        interval = np.clip(at.astype(np.intp), 0, self.intervals - 1)
        if order == 1:
            # From differences, which are small: where steps are microseconds, a jerk would
            # else be made of the rounding of the values themselves.
            u = (at - interval)[:, None]
            slope = self.differences(control, 1)
            before, here, after = (slope[interval + a] for a in range(ORDER - 1))
            return np.asarray(
                here + 0.5 * ((1.0 - u) ** 2 * (before - here) + u**2 * (after - here))
            )
        weight = self.basis(at - interval, order)
        return sum(
            (weight[:, a : a + 1] * control[interval + a] for a in range(ORDER)),
            start=np.zeros((len(at), control.shape[1])),
        )

    def at_fractions(self, control: Floats, u: Floats, order: int) -> Floats:
        """Evaluate at the same fractions of every interval, (K, q, d)."""
        weight = self.basis(u, order)
        k = self.intervals
        return sum(
            (weight[:, a, None] * control[a : a + k, None, :] for a in range(ORDER)),
            start=np.zeros((k, len(weight), control.shape[1])),
        )

    def differences(self, control: Floats, order: int) -> Floats:
        """Return the control points of a derivative, (n - order, d)."""
        if order == 0:
            return control
        return np.asarray(np.diff(control, order, axis=0) / self.step**order)

    def differences_adjoint(self, values: Floats, order: int) -> Floats:
        """Return the transposed ``differences`` of values (n - order, d), (n, d)."""
        total = np.zeros((len(values) + order, values.shape[1]))
        for a, weight in enumerate(STENCILS[order] / self.step**order):
            total[a : a + len(values)] += weight * values
        return total

    def refined(self, control: Floats) -> tuple[SplineGrid, Floats]:
        """Return the same spline on a grid of half the step (knot insertion)."""
        k = self.intervals
        finer = SplineGrid(self.start, 0.5 * self.step, 2 * k)
        fine = np.empty((finer.points, control.shape[1]))
        middle = 0.5 * (control[:-1] + control[1:])
        fine[0::2] = middle[: k + 2]
        fine[1::2] = (control[:-2] + 6.0 * control[1:-1] + control[2:]) / 8.0
        return finer, fine


@dataclass(frozen=True)
class Ends:
    """Which deviations from a base spline vanish at its ends, for each of d components.

    Parameters
    ----------
    start_value, start_rate, end_value, end_rate : (d,) array of bool
        Whether value or rate stay as they are at the first or last knot.
    held : (d,) array of bool
        Components that do not move at all.

    Notes
    -----
    The conditions involve the outermost three control points of a component, and are
    eliminated: the unknowns y keep the shape (n, d), and those that a condition takes
    away are idle. ``full`` makes the deviation of unknowns, ``reduce`` is its transpose.
    """

    start_value: Flags
    start_rate: Flags
    end_value: Flags
    end_rate: Flags
    held: Flags

    @cached_property
    def first(self) -> Floats:
        """Deviation of the first three control points per unknown, (d, 3, 3)."""
        return np.stack(
            [_elimination(v, r) for v, r in zip(self.start_value, self.start_rate, strict=True)]
        )

    @cached_property
    def last(self) -> Floats:
        """The same of the last three."""
        return np.stack(
            [
                _elimination(v, r)[::-1, ::-1]
                for v, r in zip(self.end_value, self.end_rate, strict=True)
            ]
        )

    def idle(self, points: int) -> Flags:
        """Return the unknowns that nothing depends on, (points, d)."""
        idle = np.zeros((points, len(self.held)), dtype=bool)
        idle[:3] = ~np.any(self.first, axis=1).T
        idle[-3:] = ~np.any(self.last, axis=1).T
        idle[:, self.held] = True
        return idle

    def full(self, unknowns: Floats) -> Floats:
        """Return the deviation (n, d) of unknowns."""
        deviation = unknowns.copy()
        deviation[:3] = np.einsum("jab,bj->aj", self.first, unknowns[:3])
        deviation[-3:] = np.einsum("jab,bj->aj", self.last, unknowns[-3:])
        deviation[:, self.held] = 0.0
        return deviation

    def reduce(self, gradient: Floats) -> Floats:
        """Return the gradient by the unknowns of one by the deviation, (n, d)."""
        reduced = gradient.copy()
        reduced[:3] = np.einsum("jab,aj->bj", self.first, gradient[:3])
        reduced[-3:] = np.einsum("jab,aj->bj", self.last, gradient[-3:])
        reduced[:, self.held] = 0.0
        return reduced


def _elimination(value: bool, rate: bool) -> Floats:
    """Return what the first three control points are per unknown, (3, 3).

    ``P0 + 4 P1 + P2 = 0`` keeps the value at the first knot, ``P2 - P0 = 0`` the rate.
    """
    if value and rate:
        return np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -0.5], [0.0, 0.0, 1.0]])
    if value:
        return np.array([[0.0, -4.0, -1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    if rate:
        return np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    return np.eye(3)
