"""Integrals and sizes of vectors on sides, by plain sums over all at once."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.model.motion import integrate_sides
from des_cli.model.sides import in_pieces, integral_of, largest_of, sizes_of, square_of


@pytest.fixture(params=[1, 7, 64, 10_000])
def case(request, monkeypatch):
    """Steps and two fields of vectors, taken in pieces of some length."""
    monkeypatch.setattr("des_cli.model.sides.PIECE", request.param)
    draw = np.random.default_rng(2)
    return draw.uniform(0.1, 0.3, 64), draw.normal(size=(64, 2, 3)), draw.normal(size=(64, 2, 3))


def test_sizes(case):
    step, sides, _ = case
    found = sizes_of(step, sides)
    values = np.concatenate([sides, np.linalg.norm(sides, axis=-1, keepdims=True)], axis=-1)
    square = integrate_sides(step, values**2)
    np.testing.assert_allclose(found.square, square, rtol=1e-13)
    np.testing.assert_allclose(found.rms, np.sqrt(square / step.sum()), rtol=1e-13)
    np.testing.assert_allclose(found.peak, np.abs(values).max(axis=(0, 1)), rtol=1e-15)


def test_integrals(case):
    step, sides, other = case
    for vectors, found in (
        (sides, square_of(step, sides)),
        (sides - other, square_of(step, sides, other)),
    ):
        expected = integrate_sides(step, np.sum(vectors**2, axis=-1))
        assert found == pytest.approx(expected, rel=1e-13)
    both = sides[:, 0, 0] + sides[:, 1, 0]
    expected = integrate_sides(step, sides[..., 0])
    assert integral_of(step, both) == pytest.approx(expected, rel=1e-12)


def test_the_largest_length(case):
    _, sides, _ = case
    assert largest_of(sides) == pytest.approx(np.linalg.norm(sides, axis=-1).max(), rel=1e-15)


def test_pieces_are_all_of_them(case):
    covered = np.concatenate([np.arange(200)[part] for part in in_pieces(200)])
    np.testing.assert_array_equal(covered, np.arange(200))
