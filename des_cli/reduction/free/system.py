"""Derivatives of a free motion's program, and the linear system of its Newton steps.

The Hessian is a band over the control points, bordered by a column for each free angle
of the seat::

    [ band    border ]
    [ border' corner ]
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.reduction.free.limit_rows import LimitRows
from des_cli.reduction.free.windows import JOINTS, POINTS, Windows
from des_cli.solver.band import BandCholesky, SymmetricBand
from des_cli.solver.spline import Ends

if TYPE_CHECKING:
    from des_cli.reduction.free.program import MotionProgram


class MotionExpansion:
    """Functions and derivatives at a point; see ``solver.barrier.Expansion``.

    Parameters
    ----------
    points : int
        Control points.
    angles : int
        Free angles of the seat, s.
    budgets : int
    """

    def __init__(self, points: int, angles: int, budgets: int) -> None:
        size = points * JOINTS + angles
        self.cost = 0.0
        self.budgets = np.zeros(budgets)
        self.local = np.zeros(0)
        self.gradient = np.zeros(size)
        self.by_budget = np.zeros((budgets, size))
        self.band = SymmetricBand(points, JOINTS)
        self.border = np.zeros((angles, points * JOINTS))
        self.corner = np.zeros((angles, angles))
        self._kept: list[_Rows] = []

    @classmethod
    def zero(cls, program: MotionProgram, budgets: int) -> MotionExpansion:
        """Return an expansion to add to."""
        return cls(program.problem.grid.points, program.free_angles, budgets)

    @property
    def budget_gradients(self) -> Floats:
        """The budgets' gradients as columns."""
        return self.by_budget.T

    def keep(
        self, rows: slice, windows: Windows, slope: Floats, by_seat: Floats, first: int
    ) -> None:
        """Keep the slopes of a local bound's rows on a span of intervals.

        Parameters
        ----------
        rows : slice
            Where they stand among all local rows.
        windows : Windows
        slope : (v, r, m) array
            By the local variables of the points.
        by_seat : (s, r, m) array
            By the seat's free angles.
        first : int
            The span's first interval.
        """
        self._kept.append(_Rows(rows, windows, slope, by_seat, first))

    def local_change(self, step: Floats) -> Floats:
        """Return the derivative of the local bounds along a step."""
        change = np.zeros_like(self.local)
        control = step[: self.border.shape[1]].reshape(-1, JOINTS)
        for kept in self._kept:
            moved = kept.windows.gather(control, kept.first, kept.last)
            by_point = np.einsum("vrm,vm->rm", kept.slope, moved)
            turned = np.einsum("srm,s->rm", kept.by_seat, step[self.border.shape[1] :])
            change[kept.rows] = (kept.sum_points(by_point) + turned).reshape(-1)
        return change

    def local_adjoint(self, multiplier: Floats) -> Floats:
        """Return the transposed derivative times multipliers."""
        adjoint = np.zeros_like(self.gradient)
        control = adjoint[: self.border.shape[1]].reshape(-1, JOINTS)
        for kept in self._kept:
            rows = multiplier[kept.rows].reshape(kept.slope.shape[1], -1)
            adjoint[self.border.shape[1] :] += np.einsum("srm,rm->s", kept.by_seat, rows)
            push = kept.at_points(rows)
            kept.windows.scatter(np.einsum("vrm,rm->vm", kept.slope, push), kept.first, control)
        return adjoint


@dataclass(frozen=True, eq=False)
class _Rows:
    """Rows of a local bound on a span of intervals."""

    rows: slice
    windows: Windows
    slope: Floats
    by_seat: Floats
    first: int

    @property
    def last(self) -> int:
        return self.first + int(self.slope.shape[-1]) // POINTS

    @property
    def _per_interval(self) -> bool:
        """Whether a row belongs to both points of an interval, and not to one."""
        points = self.slope.shape[-1]
        return bool(self.rows.stop - self.rows.start != self.slope.shape[1] * points)

    def sum_points(self, values: Floats) -> Floats:
        """Return the rows' values of values at points."""
        if not self._per_interval:
            return values
        return np.asarray(values.reshape(len(values), POINTS, -1).sum(axis=1))

    def at_points(self, values: Floats) -> Floats:
        """Return at each point what its row says."""
        return np.tile(values, (1, POINTS)) if self._per_interval else values


class MotionSystem:
    """The factorised bordered Hessian over the unknowns that the ends leave free.

    Parameters
    ----------
    factor : BandCholesky
    ends : Ends
    points : int
    border : (s, 3 n) array
        Reduced to the free unknowns.
    corner : (s, s) array
    """

    def __init__(
        self, factor: BandCholesky, ends: Ends, points: int, border: Floats, corner: Floats
    ) -> None:
        self._factor, self._ends, self._points = factor, ends, points
        self._border = border
        self._answers = factor.solve(border.T) if len(border) else border.T
        self._schur = corner - border @ self._answers

    @property
    def convex(self) -> bool:
        """Whether the border leaves the Hessian positive definite."""
        return bool(np.all(np.linalg.eigvalsh(self._schur) > 0.0))

    def solve(self, right: Floats) -> Floats:
        """Solve for columns of the full space, (3 n + s, r)."""
        size = self._points * JOINTS
        reduced = np.stack(
            [self._ends.reduce(c[:size].reshape(-1, JOINTS)).reshape(-1) for c in right.T], axis=1
        )
        motion = self._factor.solve(reduced)
        angles: Floats = np.zeros((len(self._border), right.shape[1]))
        if len(self._border):
            angles = np.asarray(np.linalg.solve(self._schur, right[size:] - self._border @ motion))
            motion = motion - self._answers @ angles
        full = [self._ends.full(c.reshape(-1, JOINTS)).reshape(-1) for c in motion.T]
        return np.concatenate([np.stack(full, axis=1), angles])


def factorise(
    expansion: MotionExpansion, rows: LimitRows, ends: Ends, stiffness: Floats, shift: float
) -> MotionSystem | None:
    """Factorise the Hessian with the rows' stiffness; None where it is not convex."""
    band = expansion.band.copy()
    rows.add_to(band, stiffness)
    if shift:
        band.data[:, :, 0] *= 1.0 + shift
    factor = BandCholesky.of(band.reduced(ends))
    if factor is None:
        return None
    points = len(band.data)
    border: Floats = np.array(
        [ends.reduce(row.reshape(-1, JOINTS)).reshape(-1) for row in expansion.border]
    ).reshape(len(expansion.border), points * JOINTS)
    system = MotionSystem(factor, ends, points, border, expansion.corner)
    return system if not len(border) or system.convex else None
