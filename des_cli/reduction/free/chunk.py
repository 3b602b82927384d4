"""Derivatives of a free motion's program on a span of intervals."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from des_cli.kinematics.seat_turn import SeatTurn, mixed_force, mixed_force_slope
from des_cli.kinematics.twist import VARIABLES, SeatMotion
from des_cli.model.arrays import Floats
from des_cli.reduction.free.expansion import MotionExpansion
from des_cli.reduction.free.hessian import (
    IntervalSquares,
    PointBlocks,
    ScaledSlope,
    SeatBlocks,
    SeatCurvature,
)
from des_cli.reduction.free.local_bounds import (
    AttitudeBound,
    ComponentBound,
    LocalBound,
    NormBound,
    OnsetBound,
)
from des_cli.reduction.free.terms import (
    JointBudget,
    Quantity,
    Term,
    curvature_of,
    slope_of,
    square,
    value_of,
)
from des_cli.reduction.free.windows import JOINTS, POINTS


class Chunk:
    """Derivatives on a span of intervals, collected until they go to the control points.

    Parameters
    ----------
    total : MotionExpansion
        What they are added to.
    seat : SeatMotion
        At the span's m points.
    turns : sequence of SeatTurn
        One for each free angle of the seat, s of them.
    first, last : int
        The span's intervals.
    """

    def __init__(
        self,
        total: MotionExpansion,
        seat: SeatMotion,
        turns: Sequence[SeatTurn],
        first: int,
        last: int,
    ) -> None:
        self.unknowns, self.total, self.seat = total.unknowns, total, seat
        self.first, self.last = first, last
        self.at = slice(POINTS * first, POINTS * last)
        self.turns = turns
        self.turned = [turn.of(seat) for turn in turns]
        self.slopes: list[ScaledSlope] = []
        self.multipliers: dict[Quantity, Floats] = {}

    def take(self, term: Term, factor: float, gradient: Floats) -> float:
        """Add a term's gradient, and its Hessian times a factor; return its value."""
        seat, windows = self.seat, self.unknowns.seat_windows
        residual = term.residual(seat, self.at)
        slope = term.slope(seat)
        by_variable = np.zeros((VARIABLES, residual.shape[1]))
        np.einsum("krm,rm->km", slope, 2.0 * residual, out=by_variable[: len(slope)])
        windows.scatter(by_variable, self.first, self.unknowns.control(gradient))
        root = np.sqrt(2.0 * factor)
        self._add_multiplier(term.quantity, (2.0 * factor) * term.multiplier(residual))
        by_seat = np.zeros((len(self.turns), *residual.shape))
        for s, turned in enumerate(self.turned):
            by_seat[s] = term.weigh(_turned_value(seat, turned, term.quantity))
        into = self.unknowns.seat_angles(gradient)
        into += np.einsum("srm,rm->s", by_seat, 2.0 * residual)
        self.slopes.append(ScaledSlope(root * slope, root * by_seat))
        return square(residual)

    def take_joints(self, budget: JointBudget, control: Floats, gradient: Floats) -> float:
        """Add a joint budget's gradient, whose Hessian is constant; return its value."""
        windows = self.unknowns.angle_windows
        off = budget.residual(windows.gather(control, self.first, self.last), self.at)
        windows.scatter(2.0 * budget.scale * off, self.first, self.unknowns.control(gradient))
        return budget.scale * square(off)

    def bind(
        self,
        bound: LocalBound,
        angles: Floats,
        rows: slice,
        multiplier: Floats,
        stiffness: Floats,
    ) -> Floats:
        """Add a local bound's share of the Hessian and keep its slopes; return its values.

        Parameters
        ----------
        bound : LocalBound
        angles : (3, m) array
            Of the joints [rad], where the bound needs them.
        rows : slice
            Where its rows of this span stand among all local rows.
        multiplier, stiffness : (rows,) array
            Of these rows.
        """
        value = bound.value(self.seat, angles, self.at)
        slope = bound.slope(self.seat, angles, self.at)
        multiplier, stiffness = multiplier.reshape(value.shape), stiffness.reshape(value.shape)
        if isinstance(bound, AttitudeBound):
            windows, by_seat = self.unknowns.angle_windows, self._by_seat(bound, value.shape)
            convex = [
                np.sum(stiffness * slope[k] * slope[n], axis=0)
                for k in range(JOINTS)
                for n in range(k, JOINTS)
            ]
            curvature = bound.curvature(self.seat, angles, self.at, multiplier)
            self.total.parts.append(PointBlocks(windows, self.first, np.stack(convex), curvature))
            self.total.keep(rows, windows, slope, by_seat, self.first)
            return value.reshape(-1)
        windows, by_seat = self.unknowns.seat_windows, self._by_seat(bound, value.shape)
        self.total.keep(rows, windows, slope, by_seat, self.first)
        if bound.per_interval:
            self._add_interval_squares(slope, by_seat, stiffness)
        else:
            root = np.sqrt(stiffness)
            self.slopes.append(ScaledSlope(root * slope, root * by_seat))
        if isinstance(bound, ComponentBound | OnsetBound):
            self._add_multiplier("force", bound.force_multiplier(multiplier))
        elif isinstance(bound, NormBound):
            self._add_length(bound, multiplier)
        return value.reshape(-1)

    def finish(self) -> None:
        """Hand on what was collected."""
        self.total.parts.append(
            SeatBlocks(
                self.unknowns.seat_windows,
                self.first,
                self.slopes,
                curvature_of(self.seat, self.multipliers),
                self._seat_curvature(),
            )
        )

    def _add_multiplier(self, quantity: Quantity, multiplier: Floats) -> None:
        known = self.multipliers.get(quantity)
        self.multipliers[quantity] = multiplier if known is None else known + multiplier

    def _add_interval_squares(
        self, slope: Floats, by_seat: Floats, weight: Floats, *, curvature: bool = False
    ) -> None:
        """Add weighted squares of rows that belong to both points of an interval."""
        windows = self.unknowns.seat_windows
        across = np.zeros((len(self.turns), VARIABLES, slope.shape[-1]))
        if self.turns:
            weighted = by_seat * weight
            both = np.tile(weighted, (1, 1, POINTS))
            across[:, : len(slope)] = np.einsum("krm,srm->skm", slope, both)
        corner = np.einsum("srm,trm,rm->st", by_seat, by_seat, weight)
        scaled = np.sqrt(weight) * windows.to_window(slope)
        self.total.parts.append(
            IntervalSquares(windows, self.first, scaled, across, corner, curvature)
        )

    def _add_length(self, bound: NormBound, multiplier: Floats) -> None:
        """Add the curvature of a bound on a length: a square's, and the quantity's own."""
        self._add_multiplier(bound.quantity, bound.multiplier(self.seat, multiplier))
        weight = np.repeat(bound.weight(multiplier), 3, axis=0)
        by_seat = np.zeros((len(self.turns), *weight.shape))
        for s, turned in enumerate(self.turned):
            by_seat[s] = bound.along(_turned_value(self.seat, turned, bound.quantity))
        self._add_interval_squares(bound.parts(self.seat), by_seat, weight, curvature=True)

    def _by_seat(self, bound: LocalBound, shape: tuple[int, ...]) -> Floats:
        """Return the derivatives of a bound's rows by the seat's angles, (s, r, m)."""
        by_seat = np.zeros((len(self.turns), *shape))
        for s, turned in enumerate(self.turned):
            if isinstance(bound, ComponentBound | OnsetBound):
                by_seat[s] = bound.along(mixed_force(self.seat, turned))
            elif isinstance(bound, NormBound):
                by_seat[s] = bound.turned(
                    self.seat, _turned_value(self.seat, turned, bound.quantity)
                )
        return by_seat

    def _seat_curvature(self) -> SeatCurvature:
        """Return the second derivatives by the seat's angles times the multipliers."""
        across: list[tuple[int, Floats]] = []
        corner: list[tuple[int, int, float]] = []
        for s, one in enumerate(self.turned):
            for quantity, multiplier in self.multipliers.items():
                slope = _turned_slope(self.seat, one, quantity)
                across.append((s, np.einsum("kcm,cm->km", slope, multiplier)))
                for t in range(s, len(self.turns)):
                    # the outer turn acts on what the inner one has changed
                    twice = self.turns[t].of(one)
                    value = _turned_value(self.seat, twice, quantity)
                    if quantity == "force":
                        value = value + _both_turned(one, self.turned[t])
                    corner.append((s, t, float(np.sum(multiplier * value))))
        return SeatCurvature(across, corner)


def _turned_value(seat: SeatMotion, turned: SeatMotion, quantity: Quantity) -> Floats:
    """Return the derivative of a quantity by a turn of the seat, (3, m)."""
    return mixed_force(seat, turned) if quantity == "force" else value_of(turned, quantity)


def _turned_slope(seat: SeatMotion, turned: SeatMotion, quantity: Quantity) -> Floats:
    """Return its derivatives by the variables, (5 or 8, 3, m)."""
    return mixed_force_slope(seat, turned) if quantity == "force" else slope_of(turned, quantity)


def _both_turned(one: SeatMotion, other: SeatMotion) -> Floats:
    """Return what two turns add to the force's second derivative, each in one factor."""
    a, b = one.twist, other.twist
    return np.cross(a[:3], b[3:], axis=0) + np.cross(b[:3], a[3:], axis=0)
