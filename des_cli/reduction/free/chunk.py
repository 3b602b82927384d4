"""Derivatives of a free motion's program on a span of intervals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from des_cli.kinematics.seat_turn import SeatTurn, mixed_force, mixed_force_slope
from des_cli.kinematics.twist import VARIABLES, SeatMotion
from des_cli.model.arrays import Floats
from des_cli.reduction.free.local_bounds import (
    AttitudeBound,
    ComponentBound,
    LocalBound,
    NormBound,
    OnsetBound,
)
from des_cli.reduction.free.system import MotionExpansion
from des_cli.reduction.free.terms import (
    JointBudget,
    Quantity,
    Term,
    curvature_of,
    slope_of,
    square,
    squares,
    value_of,
)
from des_cli.reduction.free.windows import JOINTS, POINTS

if TYPE_CHECKING:
    from des_cli.reduction.free.program import MotionProgram


class Chunk:
    """Derivatives on a span of intervals, collected until they go to the control points."""

    def __init__(
        self,
        program: MotionProgram,
        total: MotionExpansion,
        seat: SeatMotion,
        turns: Sequence[SeatTurn],
        share: float,
        first: int,
        last: int,
    ) -> None:
        self.program, self.total, self.seat, self.share = program, total, seat, share
        self.first, self.last = first, last
        self.at = slice(POINTS * first, POINTS * last)
        self.turns = turns
        self.turned = [turn.of(seat) for turn in turns]
        self.slopes: list[Floats] = []  # by the variables, scaled
        self.turned_slopes: list[Floats] = []  # the same by the seat's angles, (s, 3, m)
        self.multipliers: dict[Quantity, Floats] = {}
        m = seat.rate.shape[1]
        self.across = np.zeros((len(turns), VARIABLES, m))  # by the seat's angles and these

    def take(
        self, term: Term | JointBudget, factor: float, gradient: Floats, control: Floats
    ) -> float:
        """Add a term times a factor; return its value."""
        program, seat = self.program, self.seat
        if isinstance(term, JointBudget):  # its Hessian is constant, and added at the end
            off = program.off(term, control, self.first, self.last)
            into = program.control(gradient)
            program.angles.scatter(2.0 * term.scale * off, self.first, into)
            return term.scale * square(off)
        residual = term.residual(seat, self.at)
        slope = term.slope(seat)
        by_variable = np.zeros((VARIABLES, residual.shape[1]))
        np.einsum("krm,rm->km", slope, 2.0 * residual, out=by_variable[: len(slope)])
        program.windows.scatter(by_variable, self.first, program.control(gradient))
        root = np.sqrt(2.0 * factor)
        self.slopes.append(root * slope)
        self._push(term.quantity, (2.0 * factor * self.share) * term.multiplier(residual))
        if self.turns:
            by_seat = np.stack(
                [term.weigh(_turned_value(seat, t, term.quantity)) for t in self.turned]
            )
            program.seat_angles(gradient)[:] += np.einsum("srm,rm->s", by_seat, 2.0 * residual)
            self.turned_slopes.append(root * by_seat)
        return square(residual)

    def bind(
        self,
        bound: LocalBound,
        angles: Floats,
        rows: slice,
        multiplier: Floats,
        stiffness: Floats,
    ) -> Floats:
        """Add a local bound's share of the Hessian and keep its slopes; return its values."""
        program, total = self.program, self.total
        value = bound.value(self.seat, angles, self.at)
        slope = bound.slope(self.seat, angles, self.at)
        multiplier, stiffness = multiplier.reshape(value.shape), stiffness.reshape(value.shape)
        windows = program.angles if isinstance(bound, AttitudeBound) else program.windows
        by_seat = self._by_seat(bound, value.shape)
        total.keep(rows, windows, slope, by_seat, self.first)
        if isinstance(bound, AttitudeBound):
            hessian = np.stack(
                [
                    np.sum(stiffness * slope[k] * slope[n], axis=0)
                    for k in range(JOINTS)
                    for n in range(k, JOINTS)
                ]
            )
            if self.share > 0.0:
                hessian += self.share * bound.curvature(self.seat, angles, self.at, multiplier)
            program.angles.scatter_hessian(hessian, self.first, total.band)
            return value.reshape(-1)
        if isinstance(bound, OnsetBound):
            window = program.windows.to_window(slope)
            program.windows.scatter_squares(np.sqrt(stiffness) * window, self.first, total.band)
            if self.turns:
                stiff = slope * np.tile(stiffness, (1, POINTS))
                both = np.tile(by_seat, (1, 1, POINTS))
                self.across += np.einsum("krm,srm->skm", stiff, both)
                total.corner += np.einsum("srm,trm,rm->st", by_seat, by_seat, stiffness)
        else:
            self.slopes.append(np.sqrt(stiffness) * slope)
            if self.turns:
                self.turned_slopes.append(np.sqrt(stiffness) * by_seat)
        if self.share > 0.0:
            if isinstance(bound, ComponentBound | OnsetBound):
                self._push("force", self.share * bound.push(multiplier))
            elif isinstance(bound, NormBound):
                self._push_length(bound, self.share * multiplier[0])
        return value.reshape(-1)

    def _by_seat(self, bound: LocalBound, shape: tuple[int, ...]) -> Floats:
        """Return the derivatives of a bound's rows by the seat's angles, (s, r, m)."""
        by_seat = np.zeros((len(self.turns), *shape))
        for s, turned in enumerate(self.turned):
            if isinstance(bound, ComponentBound | OnsetBound):
                by_seat[s] = bound.along(mixed_force(self.seat, turned))
            elif isinstance(bound, NormBound):
                change = _turned_value(self.seat, turned, bound.quantity)
                along = np.sum(change * value_of(self.seat, bound.quantity), axis=0)
                by_seat[s] = 2.0 / bound.bound**2 * along
        return by_seat

    def _push_length(self, bound: NormBound, multiplier: Floats) -> None:
        """Add the curvature of a bound on a length: a square's, and the quantity's own."""
        weight = 2.0 * multiplier / bound.bound**2
        self._push(bound.quantity, weight * value_of(self.seat, bound.quantity))
        root = np.sqrt(weight)
        self.slopes.append(root * slope_of(self.seat, bound.quantity))
        if self.turns:
            self.turned_slopes.append(
                root * np.stack([_turned_value(self.seat, t, bound.quantity) for t in self.turned])
            )

    def finish(self) -> None:
        """Bring what was collected to the control points and the seat's angles."""
        pairs = VARIABLES * (VARIABLES + 1) // 2
        hessian = squares(self.slopes) if self.slopes else np.zeros((pairs, self.across.shape[2]))
        if self.share > 0.0:
            hessian += curvature_of(self.seat, self.multipliers)
        self.program.windows.scatter_hessian(hessian, self.first, self.total.band)
        if not self.turns:
            return
        count = len(self.turns)
        across = self.across
        for slope, by_seat in zip(self.slopes, self.turned_slopes, strict=True):
            across[:, : len(slope)] += np.einsum("krm,srm->skm", slope, by_seat)
            self.total.corner += np.einsum("srm,trm->st", by_seat, by_seat)
        for s, one in enumerate(self.turned):
            for quantity, push in self.multipliers.items():
                bent = _turned_slope(self.seat, one, quantity)
                across[s, : len(bent)] += np.einsum("kcm,cm->km", bent, push)
                for t in range(s, count):
                    # the outer turn acts on what the inner one has changed
                    twice = self.turns[t].of(one)
                    value = _turned_value(self.seat, twice, quantity)
                    if quantity == "force":
                        value = value + _both_turned(one, self.turned[t])
                    amount = float(np.sum(push * value))
                    self.total.corner[s, t] += amount
                    if s != t:
                        self.total.corner[t, s] += amount
        for s in range(count):
            column = self.total.border[s].reshape(-1, JOINTS)
            self.program.windows.scatter(across[s], self.first, column)

    def _push(self, quantity: Quantity, push: Floats) -> None:
        known = self.multipliers.get(quantity)
        self.multipliers[quantity] = push if known is None else known + push


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
