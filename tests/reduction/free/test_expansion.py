"""An expansion's Hessian and its local rows against dense matrices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.reduction.free.expansion import MotionExpansion
from des_cli.reduction.free.hessian import BorderedBand, SeatWeight
from des_cli.reduction.free.unknowns import Unknowns
from des_cli.reduction.free.windows import POINTS
from des_cli.solver.spline import SplineGrid

GRID = SplineGrid(0.0, 0.3, 7)
ANGLES = 2
UNKNOWNS = Unknowns(GRID, ANGLES)
SPANS = ((0, 4), (4, 7))
ROWS = 3


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(14)


@dataclass
class Shares:
    """A part that remembers which shares of it were asked for."""

    asked: list[float]

    def add_to(self, hessian: BorderedBand, share: float) -> None:
        self.asked.append(share)
        hessian.corner[0, 1] += share


def test_nothing_is_there_before_anything_is_added() -> None:
    expansion = MotionExpansion(UNKNOWNS, 3)
    assert (expansion.cost, expansion.budgets.tolist()) == (0.0, [0.0] * 3)
    assert expansion.gradient.shape == (UNKNOWNS.size,)
    assert expansion.budget_gradients.shape == (UNKNOWNS.size, 3)
    assert not expansion.hessian(1.0).band.data.any()
    assert expansion.local_change(np.ones(UNKNOWNS.size)).shape == (0,)
    assert not expansion.local_adjoint(np.zeros(0)).any()


def test_budgets_have_their_gradients_as_columns(rng: np.random.Generator) -> None:
    expansion = MotionExpansion(UNKNOWNS, 3)
    expansion.by_budget[1] = np.arange(UNKNOWNS.size)
    np.testing.assert_array_equal(expansion.budget_gradients[:, 1], np.arange(UNKNOWNS.size))


def test_a_hessian_is_the_sum_of_its_parts_and_made_once_for_each_share() -> None:
    expansion, part = MotionExpansion(UNKNOWNS, 0), Shares([])
    expansion.parts += [SeatWeight(2.0), part]
    first = expansion.hessian(0.5)
    np.testing.assert_array_equal(first.corner, [[2.0, 0.5], [0.0, 2.0]])
    assert expansion.hessian(0.5) is first
    assert part.asked == [0.5]
    np.testing.assert_array_equal(expansion.hessian(1.0).corner, [[2.0, 1.0], [0.0, 2.0]])
    np.testing.assert_array_equal(expansion.hessian(0.5).corner, first.corner)
    assert part.asked == [0.5, 1.0, 0.5]


def kept_rows(rng: np.random.Generator, *, onset: bool) -> tuple[MotionExpansion, Floats]:
    """Rows at points, or between both points of an interval, and their dense Jacobian."""
    expansion, windows = MotionExpansion(UNKNOWNS, 0), UNKNOWNS.seat_windows
    jacobians, start = [], 0
    for first, last in SPANS:
        count, points = last - first, POINTS * (last - first)
        each = count if onset else points
        slope, by_seat = rng.normal(size=(8, ROWS, points)), rng.normal(size=(ANGLES, ROWS, each))
        rows = slice(start, start + ROWS * each)
        start = rows.stop
        expansion.keep(rows, windows, slope, by_seat, first)
        units = np.eye(UNKNOWNS.size - ANGLES)
        local = np.stack([windows.gather(u.reshape(-1, 3), first, last) for u in units], axis=-1)
        by_motion = np.einsum("vrp,vps->rps", slope, local)
        if onset:  # the span's first points, then its second ones
            by_motion = by_motion[:, :count] + by_motion[:, count:]
        both = np.concatenate([by_motion, by_seat.transpose(1, 2, 0)], axis=2)
        jacobians.append(both.reshape(-1, UNKNOWNS.size))
    expansion.local = np.zeros(start)
    return expansion, np.concatenate(jacobians)


@pytest.mark.parametrize("onset", [False, True], ids=["at points", "between points"])
def test_local_rows_on_several_spans(onset: bool, rng: np.random.Generator) -> None:
    expansion, jacobian = kept_rows(rng, onset=onset)
    step, multiplier = rng.normal(size=UNKNOWNS.size), rng.normal(size=len(jacobian))
    found = expansion.local_change(step)
    np.testing.assert_allclose(found, jacobian @ step, rtol=0, atol=1e-10)
    found = expansion.local_adjoint(multiplier)
    expected = jacobian.T @ multiplier
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * np.abs(expected).max())


def test_rows_may_differ_in_what_they_depend_on(rng: np.random.Generator) -> None:
    """One on the joint angles alone, which the seat does not move."""
    expansion, windows = MotionExpansion(UNKNOWNS, 0), UNKNOWNS.angle_windows
    points = POINTS * GRID.intervals
    slope = np.zeros((3, 1, points))
    slope[1] = 2.0  # twice the fork's angle
    nothing = np.zeros((ANGLES, 1, points))
    expansion.keep(slice(0, points), windows, slope, nothing, 0)
    expansion.local = np.zeros(points)
    step = rng.normal(size=UNKNOWNS.size)
    fork = GRID.values(UNKNOWNS.control(step), windows.times())[:, 1]
    np.testing.assert_allclose(expansion.local_change(step), 2.0 * fork, rtol=0, atol=1e-12)
    assert not UNKNOWNS.seat_angles(expansion.local_adjoint(np.ones(points))).any()
