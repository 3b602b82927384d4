"""Bordered systems against dense algebra."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.model.machine import JointLimits
from des_cli.reduction.free.hessian import BorderedBand
from des_cli.reduction.free.limit_rows import LimitRows
from des_cli.reduction.free.system import factorise
from des_cli.solver.spline import Ends, SplineGrid
from tests.support.bands import dense

GRID = SplineGrid(0.0, 0.5, 6)
N = GRID.points
SIZE = 3 * N
LIMITS = (JointLimits(np.inf, 2.0, 3.0, 9.0),) * 3
NO, YES = np.zeros(3, dtype=bool), np.ones(3, dtype=bool)
ENDS = {
    "free": Ends(NO, NO, NO, NO, NO),
    "matched": Ends(YES, YES, NO, YES, NO),
    "held": Ends(YES, NO, NO, NO, np.array([False, True, False])),
}


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(17)


@pytest.fixture(params=list(ENDS.values()), ids=list(ENDS))
def ends(request: pytest.FixtureRequest) -> Ends:
    found: Ends = request.param
    return found


def hessian_of(angles: int, rng: np.random.Generator) -> BorderedBand:
    """A positive definite matrix whose border matters."""
    hessian = BorderedBand.zero(N, angles)
    for order in range(4):
        weight = 0.1 + rng.random((N - order, 3))
        hessian.band.add_differences(weight, order, GRID.step)
    hessian.border[:] = 0.3 * rng.normal(size=(angles, SIZE))
    hessian.corner[:] = 50.0 * np.eye(angles)
    return hessian


def rows_of(ends: Ends) -> LimitRows:
    return LimitRows(GRID, np.zeros((N, 3)), LIMITS, ends, 0.0, ())


def allowed(ends: Ends, angles: int) -> Floats:
    """A basis of what the ends leave, (3 n + s, free unknowns)."""
    columns = [ends.full(unit.reshape(N, 3)).ravel() for unit in np.eye(SIZE)]
    motion = np.stack([c for c in columns if c.any()], axis=1)
    basis = np.zeros((SIZE + angles, motion.shape[1] + angles))
    basis[:SIZE, : motion.shape[1]] = motion
    basis[SIZE:, motion.shape[1] :] = np.eye(angles)
    return basis


def whole(hessian: BorderedBand, rows: LimitRows, stiffness: Floats, shift: float) -> Floats:
    """The matrix of a system: rows are taken in, and the motion's diagonal grows."""
    change = np.stack([rows.change(unit.reshape(N, 3)) for unit in np.eye(SIZE)], axis=1)
    motion = dense(hessian.band) + change.T @ (stiffness[:, None] * change)
    motion += shift * np.diag(np.diag(motion))
    return np.block([[motion, hessian.border.T], [hessian.border, hessian.corner]])


@pytest.mark.parametrize("angles", [0, 1, 2])
@pytest.mark.parametrize("shift", [0.0, 0.1])
def test_solutions_are_those_of_the_whole_matrix_among_what_the_ends_leave(
    ends: Ends, angles: int, shift: float, rng: np.random.Generator
) -> None:
    hessian, rows = hessian_of(angles, rng), rows_of(ends)
    stiffness, right = rng.random(len(rows.bounds)), rng.normal(size=(SIZE + angles, 2))
    system = factorise(hessian, rows, ends, stiffness, shift)
    assert system is not None
    basis, matrix = allowed(ends, angles), whole(hessian, rows, stiffness, shift)
    expected = basis @ np.linalg.solve(basis.T @ matrix @ basis, basis.T @ right)
    scale = np.abs(expected).max()
    np.testing.assert_allclose(system.solve(right), expected, rtol=0, atol=1e-10 * scale)


def test_the_hessian_is_left_as_it_is(rng: np.random.Generator) -> None:
    hessian, rows = hessian_of(2, rng), rows_of(ENDS["matched"])
    arrays = (hessian.band.data, hessian.border, hessian.corner)
    before = [array.copy() for array in arrays]
    factorise(hessian, rows, ENDS["matched"], np.ones(len(rows.bounds)), 0.1)
    for array, copy in zip(
        (hessian.band.data, hessian.border, hessian.corner), before, strict=True
    ):
        np.testing.assert_array_equal(array, copy)


@pytest.mark.parametrize(("margin", "convex"), [(1e-3, True), (-1e-3, False)])
def test_a_band_that_is_not_convex_where_the_ends_are_free_has_no_system(
    ends: Ends, margin: float, convex: bool, rng: np.random.Generator
) -> None:
    hessian, rows = hessian_of(0, rng), rows_of(ends)
    unit = dense(hessian.band)
    basis = np.linalg.qr(allowed(ends, 0))[0]
    least = np.linalg.eigvalsh(basis.T @ unit @ basis)[0]
    hessian.band.data[:, :, 0] += margin - least
    found = factorise(hessian, rows, ends, np.zeros(len(rows.bounds)), 0.0)
    assert (found is not None) is convex


@pytest.mark.parametrize(("margin", "convex"), [(1e-3, True), (-1e-3, False)])
def test_a_border_may_make_it_indefinite_though_the_corner_is_not(
    ends: Ends, margin: float, convex: bool, rng: np.random.Generator
) -> None:
    hessian, rows = hessian_of(2, rng), rows_of(ends)
    stiffness = rng.random(len(rows.bounds))
    basis = allowed(ends, 2)
    matrix = basis.T @ whole(hessian, rows, stiffness, 0.0) @ basis
    motion, border = matrix[:-2, :-2], matrix[-2:, :-2]
    taken = border @ np.linalg.solve(motion, border.T)
    hessian.corner[:] = taken + margin * np.eye(2)
    assert np.all(np.linalg.eigvalsh(hessian.corner) > 0.0)
    found = factorise(hessian, rows, ends, stiffness, 0.0)
    assert (found is not None) is convex
