"""Banded systems over control points against dense ones."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from des_cli.solver.band import BandCholesky, SymmetricBand
from des_cli.solver.spline import STENCILS, Ends
from tests.support.bands import dense

KEPT = list(product([False, True], repeat=4))
HELD = list(product([False, True], repeat=2))


@pytest.fixture
def rng():
    return np.random.default_rng(3)


def difference_matrix(n, order, step):
    """Differences of n control points, (n - order, n)."""
    return np.diff(np.eye(n), order, axis=0) / step**order


def random_band(rng, n, d):
    """A positive definite matrix of full bandwidth inside windows of four points."""
    band = SymmetricBand(n, d)
    for first in range(n - 3):
        root = rng.normal(size=(4 * d, 4 * d))
        square = root @ root.T
        for q in range(4 * d):
            i, j = divmod(q, d)
            band.data[first + i, j, : 4 * d - q] += square[q, q:]
    return band


@pytest.mark.parametrize("order", range(len(STENCILS)))
@pytest.mark.parametrize("components", [slice(None), slice(1, 3)], ids=["all", "some"])
def test_differences_are_added(order, components, rng):
    n, d, step = 8, 3, 0.2
    band = random_band(rng, n, d)
    before = dense(band)
    weight = np.zeros((n - order, d))
    weight[:, components] = rng.random((n - order, len(range(d)[components])))
    band.add_differences(weight[:, components], order, step, components)
    matrix = difference_matrix(n, order, step)
    added = np.zeros((n, d, n, d))
    for j in range(d):
        added[:, j, :, j] = matrix.T @ np.diag(weight[:, j]) @ matrix
    np.testing.assert_allclose(dense(band) - before, added.reshape(n * d, n * d), rtol=1e-12)


@pytest.mark.parametrize("d", [1, 2, 3])
def test_the_product_with_a_vector(d, rng):
    band, x = random_band(rng, 9, d), rng.normal(size=(9, d))
    np.testing.assert_allclose(band.times(x).ravel(), dense(band) @ x.ravel(), rtol=1e-12)


def test_a_copy_is_its_own(rng):
    band = random_band(rng, 6, 2)
    twin = band.copy()
    twin.data[0] += 1.0
    assert not np.array_equal(twin.data, band.data)


@pytest.mark.parametrize("n", [6, 7, 11])
@pytest.mark.parametrize("held", HELD, ids=str)
@pytest.mark.parametrize("kept", KEPT, ids=str)
def test_reduced_to_what_the_ends_leave(kept, held, n, rng):
    # the second component has the conditions of the first the other way round
    ends = Ends(*(np.array([k, not k]) for k in kept), held=np.array(held))
    band = random_band(rng, n, 2)
    full = np.stack([ends.full(e.reshape(n, 2)).ravel() for e in np.eye(2 * n)], axis=1)
    expected = full.T @ dense(band) @ full
    idle = ends.idle(n).ravel()
    expected[idle, idle] = 1.0
    scale = np.abs(expected).max()
    np.testing.assert_allclose(dense(band.reduced(ends)), expected, rtol=0, atol=1e-13 * scale)


@pytest.mark.parametrize("n", [6, 20])
def test_systems_are_solved(n, rng):
    band, right = random_band(rng, n, 3), rng.normal(size=(3 * n, 2))
    factor = BandCholesky.of(band)
    expected = np.linalg.solve(dense(band), right)
    np.testing.assert_allclose(factor.solve(right), expected, rtol=1e-7, atol=1e-9)


def test_reduced_systems_minimise_among_what_the_ends_leave(rng):
    no, yes = np.zeros(2, dtype=bool), np.ones(2, dtype=bool)
    ends = Ends(yes, yes, no, yes, np.array([False, True]))
    band, slope = random_band(rng, 10, 2), rng.normal(size=(10, 2))
    factor = BandCholesky.of(band.reduced(ends))
    y = factor.solve(ends.reduce(slope).reshape(-1, 1))
    x = ends.full(y.reshape(10, 2))
    assert not x[:, 1].any()
    # stationary: what is left of the gradient is that of the conditions alone
    np.testing.assert_allclose(ends.reduce(band.times(x) - slope), 0.0, atol=1e-10)


def test_what_is_not_positive_definite_has_no_factor(rng):
    band = random_band(rng, 8, 2)
    least = np.linalg.eigvalsh(dense(band))[0]
    band.data[:, :, 0] -= 1.01 * least
    assert BandCholesky.of(band) is None
    band.data[:, :, 0] += 0.02 * least
    assert BandCholesky.of(band) is not None
