"""Nonnegative least squares, against scipy's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import nnls

from des_cli.verify.multipliers import least_residual


@pytest.mark.parametrize("budgets", [0, 1, 2, 4])
def test_the_residual_is_that_of_nnls(budgets):
    draw = np.random.default_rng(budgets)
    for _ in range(20):
        slope, by_budget = draw.normal(size=12), draw.normal(size=(12, budgets))
        norm = np.linalg.norm(slope)
        if budgets:
            norm = nnls(by_budget, -slope)[1]
        assert np.linalg.norm(least_residual(slope, by_budget)) == pytest.approx(norm, rel=1e-10)


def test_a_negative_multiplier_is_none():
    slope = np.array([1.0, 2.0])
    np.testing.assert_array_equal(least_residual(slope, slope[:, None]), slope)
    np.testing.assert_allclose(least_residual(slope, -3.0 * slope[:, None]), 0.0, atol=1e-15)


def test_slopes_of_other_sizes_count_as_much():
    draw = np.random.default_rng(9)
    by_budget = draw.normal(size=(12, 2))
    slope = -by_budget @ [1.0, 2.0]
    np.testing.assert_allclose(least_residual(slope, by_budget * [1.0, 1e-18]), 0.0, atol=1e-12)
