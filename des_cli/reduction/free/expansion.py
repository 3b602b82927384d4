"""A free motion's program at a point: its functions, and their derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.reduction.free.hessian import BorderedBand, HessianPart
from des_cli.reduction.free.unknowns import Unknowns
from des_cli.reduction.free.windows import POINTS, Windows


class MotionExpansion:
    """Functions and derivatives at a point; see ``solver.feasible_program.Expansion``.

    Parameters
    ----------
    unknowns : Unknowns
    budgets : int
        Their number, j.

    Attributes
    ----------
    cost, budgets, local : float, (j,), (k,) array
        Values of the cost, the budgets and the local bounds.
    gradient, by_budget : (N,), (j, N) array
        Derivatives of the cost and of the budgets.
    parts : list of HessianPart
        Of the Hessian of the Lagrangian with what the local bounds' barrier adds to it.
    """

    def __init__(self, unknowns: Unknowns, budgets: int) -> None:
        self.unknowns = unknowns
        self.cost = 0.0
        self.budgets = np.zeros(budgets)
        self.local = np.zeros(0)
        self.gradient = np.zeros(unknowns.size)
        self.by_budget = np.zeros((budgets, unknowns.size))
        self.parts: list[HessianPart] = []
        self._kept: list[_LocalRows] = []
        self._assembled: tuple[float, BorderedBand] | None = None

    def hessian(self, share: float) -> BorderedBand:
        """Return the Hessian with a share of its curvature, 0 to 1.

        The last one is kept: where it is not convex, shifts of it are tried next.
        """
        if self._assembled is None or self._assembled[0] != share:
            total = BorderedBand.zero(self.unknowns.grid.points, self.unknowns.angles)
            for part in self.parts:
                part.add_to(total, share)
            self._assembled = share, total
        return self._assembled[1]

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
        self._kept.append(_LocalRows(rows, windows, slope, by_seat, first))

    def local_change(self, step: Floats) -> Floats:
        """Return the derivative of the local bounds along a step."""
        change = np.zeros_like(self.local)
        control, angles = self.unknowns.control(step), self.unknowns.seat_angles(step)
        for kept in self._kept:
            moved = kept.windows.gather(control, kept.first, kept.last)
            by_point = np.einsum("vrm,vm->rm", kept.slope, moved)
            turned = np.einsum("srm,s->rm", kept.by_seat, angles)
            change[kept.rows] = (kept.sum_points(by_point) + turned).reshape(-1)
        return change

    def local_adjoint(self, multiplier: Floats) -> Floats:
        """Return the transposed derivative times multipliers."""
        adjoint = np.zeros_like(self.gradient)
        control, angles = self.unknowns.control(adjoint), self.unknowns.seat_angles(adjoint)
        for kept in self._kept:
            rows = multiplier[kept.rows].reshape(kept.slope.shape[1], -1)
            angles += np.einsum("srm,rm->s", kept.by_seat, rows)
            by_variable = np.einsum("vrm,rm->vm", kept.slope, kept.at_points(rows))
            kept.windows.scatter(by_variable, kept.first, control)
        return adjoint


@dataclass(frozen=True, eq=False)
class _LocalRows:
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
