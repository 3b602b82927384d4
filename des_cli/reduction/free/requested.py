"""What is asked of the seat, at the points of a grid.

A record that the grid resolves is taken at the points. A rough one, of noise or of corners
faster than the knots, is not what its values at a few points are: there its samples are
projected on functions that are linear over each interval of the grid. For a W that is
linear over the intervals, and points at which Gauss's rule is exact,

    sum_i w_i |W(t_i) - f_i|^2 = sum_points w |W - T|^2 + floor

with f_i at the samples' sides, w_i half of their intervals, T the projection and a floor
that no motion takes away. So a budget on a rough record is what its table will be measured
by, and its gradient is that of all samples.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import get_args

import numpy as np

from des_cli.kinematics.seat import PILOT_SIGNS
from des_cli.kinematics.twist import SeatMotion
from des_cli.model.arrays import Floats
from des_cli.model.motion import Motion, Shortfall
from des_cli.model.response import SeatResponse
from des_cli.model.sides import in_pieces
from des_cli.reduction.free.terms import Quantity, value_of
from des_cli.reduction.free.windows import Windows
from des_cli.reduction.reference import sample_sides
from des_cli.solver.spline import GAUSS
from des_cli.units import STANDARD_GRAVITY_M_S2

ROUGH = 1e-3
"""Share of a quantity's square that samples have beside the mean of their neighbours, from
which a record is rough: of the built-in maneuvers it is 4e-6 at the most, of two logs of
gyros 6e-3 and 0.1."""

CLOSE = 0.01
"""Relative difference of steps that counts as none: a grid divides its time evenly."""

QUANTITIES: tuple[Quantity, ...] = get_args(Quantity)


@dataclass(frozen=True)
class Requested:
    """The quantities of terms, as they are asked for.

    Parameters
    ----------
    values : mapping of str to (3, p) array
        At the points.
    square : mapping of str to float
        ``int |f|^2 dt`` over the half step of the grid, that points weigh.
    floor : mapping of str to float
        What is left of it whatever the motion does, over the same.
    """

    values: Mapping[Quantity, Floats]
    square: Mapping[Quantity, float]
    floor: Mapping[Quantity, float]

    @classmethod
    def at_points(
        cls, seat: SeatMotion, reference: Motion, shortfall: Shortfall | None, times: Floats
    ) -> Requested:
        """Take a record that is resolved at the points.

        Parameters
        ----------
        seat : SeatMotion
            Of the reference's joint motion at the points.
        reference : Motion
        shortfall : Shortfall or None
        times : (p,) array
            Of the points [s].
        """
        values = {quantity: value_of(seat, quantity) for quantity in QUANTITIES}
        if shortfall is not None:
            for quantity, sides in _missing(shortfall).items():
                values[quantity] = values[quantity] + sample_sides(reference.t, sides, times).T
        square = {quantity: float(np.sum(values[quantity] ** 2)) for quantity in QUANTITIES}
        return cls(values, square, dict.fromkeys(QUANTITIES, 0.0))

    @classmethod
    def projected(cls, response: SeatResponse, t: Floats, windows: Windows) -> Requested:
        """Project a record's samples.

        Parameters
        ----------
        response : SeatResponse
            As asked for, at both ends of every interval of the record.
        t : (n,) array
            The record's times [s].
        windows : Windows
            Of the grid.
        """
        grid = windows.grid
        t, sides = _divided(t, np.stack(list(_sides(response).values())), grid.step)
        weight = np.tile(0.5 * np.diff(t), 2)
        times = np.concatenate([t[:-1], t[1:]])
        # a sample on a knot belongs to the interval that its side is in
        inside = times + np.repeat([1e-9, -1e-9], len(t) - 1) * grid.step
        at = np.clip(((inside - grid.start) / grid.step).astype(np.intp), 0, grid.intervals - 1)
        off = times - grid.start - (at + 0.5) * grid.step
        nodes = (np.array(GAUSS) - 0.5)[:, None] * grid.step
        values: dict[Quantity, Floats] = {}
        square: dict[Quantity, float] = {}
        floor: dict[Quantity, float] = {}
        for quantity, each in zip(QUANTITIES, sides, strict=True):
            f = np.concatenate([each[:, 0], each[:, 1]]).T
            mean, slope = (
                np.stack([np.bincount(at, row, grid.intervals) for row in f * moment])
                for moment in (weight / grid.step, 12.0 * weight * off / grid.step**3)
            )
            target = mean[:, None] + slope[:, None] * nodes  # (3, point, interval)
            values[quantity] = np.concatenate(
                [target[:, :, first:last].reshape(3, -1) for first, last in windows.chunks()],
                axis=1,
            )
            square[quantity] = float(weight @ np.sum(f**2, axis=0)) / (0.5 * grid.step)
            floor[quantity] = square[quantity] - float(np.sum(target**2))
        return cls(values, square, floor)


def is_rough(response: SeatResponse, t: Floats, step: float) -> bool:
    """Whether the rate or the G of a record jumps from sample to sample, faster than knots.

    Parameters
    ----------
    response : SeatResponse
        As asked for, at both ends of every interval of the record.
    t : (n,) array
        The record's times [s].
    step : float
        Of the grid [s]: samples that are farther apart it holds.
    """
    for sides in (response.seat_rate, response.seat_g):
        kinks = size = 0.0
        for part in in_pieces(len(t) - 1):
            size += float(np.sum(sides[part, 0] ** 2))
            after = slice(part.start + 1, min(part.stop + 1, len(t) - 1))
            before = slice(part.start, after.stop - 1)
            kink = sides[after, 0] - 0.5 * (sides[before, 0] + sides[after, 1])
            apart = t[after.start + 1 : after.stop + 1] - t[before]
            close = apart <= 2.0 * step * (1.0 + CLOSE)
            kinks += float(close @ np.sum(kink**2, axis=1))
        if kinks > ROUGH * size:
            return True
    return False


def _missing(shortfall: Shortfall) -> dict[Quantity, Floats]:
    """Return what is asked for beyond a joint motion, by the quantities of terms."""
    return {
        "rate": shortfall.seat_rate,
        "acceleration": shortfall.seat_angular_acceleration,
        "force": shortfall.seat_g * (PILOT_SIGNS * STANDARD_GRAVITY_M_S2),
    }


def _sides(response: SeatResponse) -> dict[Quantity, Floats]:
    """Return a response by the quantities of terms, in their order."""
    return {
        "rate": response.seat_rate,
        "cross": response.coriolis_seat,
        "acceleration": response.seat_angular_acceleration,
        "force": response.seat_g * (PILOT_SIGNS * STANDARD_GRAVITY_M_S2),
    }


def _divided(t: Floats, sides: Floats, longest: float) -> tuple[Floats, Floats]:
    """Divide intervals that are longer than the grid's, at straight lines between their sides.

    Parameters
    ----------
    t : (n,) array
        [s]
    sides : (q, n - 1, 2, 3) array
    longest : float
        [s]
    """
    step = np.diff(t)
    pieces = np.maximum(np.ceil(step / longest * (1.0 - 1e-9)), 1.0).astype(np.intp)
    if np.all(pieces == 1):
        return t, sides
    parent = np.repeat(np.arange(len(step)), pieces)
    number = np.arange(len(parent)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    part = np.stack([number, number + 1], axis=1) / pieces[parent][:, None]
    fine = np.append(t[parent] + part[:, 0] * step[parent], t[-1])
    first, last = sides[:, parent, :1], sides[:, parent, 1:]
    return fine, first + part[:, :, None] * (last - first)
