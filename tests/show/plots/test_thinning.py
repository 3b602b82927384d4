"""Fewer points of a curve, and every peak at its height."""

from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from des_cli.show.plots.thinning import thin


@given(n=st.integers(2, 3000), columns=st.integers(1, 60), seed=st.integers(0, 2**32 - 1))
def test_thinning_keeps_every_peak(n: int, columns: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    t = np.cumsum(random.exponential(size=n) ** 4 + 1e-9)
    values = random.standard_normal(n)
    thin_t, thin_values = thin(t, values, columns)
    assert len(thin_t) <= max(4 * columns, 4)
    assert np.all(np.diff(thin_t) > 0)
    np.testing.assert_array_equal(values[np.searchsorted(t, thin_t)], thin_values)
    assert (thin_t[0], thin_t[-1]) == (t[0], t[-1])
    edges = np.linspace(t[0], t[-1], columns + 1)
    edges[-1] = np.inf  # the last column has its right end
    for low, high in pairwise(edges):
        there, kept = (t >= low) & (t < high), (thin_t >= low) & (thin_t < high)
        if there.any():
            assert thin_values[kept].max() == values[there].max()
            assert thin_values[kept].min() == values[there].min()
