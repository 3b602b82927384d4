"""Windows of control points against splines and dense matrices."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.reduction.free import windows
from des_cli.reduction.free.windows import JOINTS, POINTS, WINDOW, Windows
from des_cli.solver.band import SymmetricBand
from des_cli.solver.spline import SplineGrid
from tests.support.bands import dense

VARIABLES = ((0, 1), (1, 0), (1, 2), (2, 1))
GRID = SplineGrid(0.4, 0.3, 11)
SIZE = GRID.points * JOINTS


@pytest.fixture(params=[4, 512], ids=["chunks", "whole"])
def made(request, monkeypatch):
    """Windows whose grid is, or is not, longer than what is evaluated at a time."""
    monkeypatch.setattr(windows, "CHUNK", request.param)
    return Windows(GRID, VARIABLES)


@pytest.fixture
def rng():
    return np.random.default_rng(8)


def gather_all(made, control):
    return np.concatenate([made.gather(control, *span) for span in made.chunks()], axis=1)


def matrix_of(made):
    """The local variables at all points by the control points, (v, points, 3 n)."""
    columns = [gather_all(made, e.reshape(-1, JOINTS)) for e in np.eye(SIZE)]
    return np.stack(columns, axis=-1)


def at_of(made, span):
    return slice(POINTS * span[0], POINTS * span[1])


def test_what_is_gathered_is_the_splines(made, rng):
    control = rng.normal(size=(GRID.points, JOINTS))
    found, times = gather_all(made, control), made.times()
    assert times.shape == (POINTS * GRID.intervals,)
    for row, (order, joint) in zip(found, VARIABLES, strict=True):
        expected = GRID.values(control, times, order)[:, joint]
        np.testing.assert_allclose(row, expected, rtol=0, atol=1e-12)


def test_the_points_integrate_cubics(made):
    # two points an interval, of equal weights
    found = 0.5 * GRID.step * np.sum(made.times() ** 3)
    end = GRID.start + GRID.duration
    assert found == pytest.approx((end**4 - GRID.start**4) / 4.0, rel=1e-13)


def test_the_chunks_follow_each_other(made):
    spans = made.chunks()
    assert spans[0][0] == 0
    assert spans[-1][1] == GRID.intervals
    assert [first for first, _ in spans[1:]] == [last for _, last in spans[:-1]]
    assert max(last - first for first, last in spans) <= windows.CHUNK


def test_scattered_gradients(made, rng):
    gradient = rng.normal(size=(len(VARIABLES), POINTS * GRID.intervals))
    total = np.ones((GRID.points, JOINTS))
    for span in made.chunks():
        made.scatter(gradient[:, at_of(made, span)], span[0], total)
    expected = 1.0 + np.einsum("vps,vp->s", matrix_of(made), gradient)
    np.testing.assert_allclose(total.ravel(), expected, rtol=0, atol=1e-11)


def test_scattered_hessians(made, rng):
    count = POINTS * GRID.intervals
    hessian = rng.normal(size=(len(made.pairs), count))
    band = SymmetricBand(GRID.points, JOINTS)
    for span in made.chunks():
        made.scatter_hessian(hessian[:, at_of(made, span)], span[0], band)
    matrix, expected = matrix_of(made), np.zeros((SIZE, SIZE))
    for (k, n), weight in zip(made.pairs, hessian, strict=True):
        term = matrix[k].T @ (weight[:, None] * matrix[n])
        expected += term if k == n else term + term.T
    scale = np.abs(expected).max()
    np.testing.assert_allclose(dense(band), expected, rtol=0, atol=1e-13 * scale)


def test_squares_of_what_couples_the_points_of_an_interval(made, rng):
    """Rows that are sums over both points of an interval, as an onset is."""
    rows = 2
    slope = rng.normal(size=(len(VARIABLES), rows, POINTS * GRID.intervals))
    band, by_interval = SymmetricBand(GRID.points, JOINTS), []
    for span in made.chunks():
        window = made.to_window(slope[..., at_of(made, span)])
        assert window.shape == (WINDOW, rows, span[1] - span[0])
        made.scatter_squares(window, span[0], band)
        at = at_of(made, span)
        by_point = np.einsum("vrp,vps->rps", slope[..., at], matrix_of(made)[:, at])
        by_interval.append(by_point.reshape(rows, POINTS, -1, SIZE).sum(axis=1))
    jacobian = np.concatenate(by_interval, axis=1).reshape(-1, SIZE)
    expected = jacobian.T @ jacobian
    scale = np.abs(expected).max()
    np.testing.assert_allclose(dense(band), expected, rtol=0, atol=1e-13 * scale)
