"""Rates between recorded samples, against scipy's PCHIP and the samples themselves."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from des_cli.model.arrays import Floats
from des_cli.profiles_in.interpolant import body_rates_of_samples, monotone_slopes

PARTS = np.linspace(0.0, 1.0, 21)


def record(seed: int, count: int) -> tuple[Floats, Floats]:
    """An uneven record in which some rates stay, as a coarse quantisation makes them."""
    rng = np.random.default_rng(seed)
    t = 100.0 + np.cumsum(rng.exponential(0.1, count) + 1e-3)
    return t, np.round(rng.normal(0.0, 1.0, (count, 3)), 1 if seed % 2 else 12)


@pytest.mark.parametrize("count", [2, 3, 4, 60])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_it_is_the_monotone_cubic_of_scipy(seed: int, count: int) -> None:
    t, rates = record(seed, count)
    found = body_rates_of_samples(t, rates)
    known = PchipInterpolator(t, rates)
    np.testing.assert_allclose(monotone_slopes(t, rates), known(t, 1), rtol=1e-9, atol=1e-12)
    for s in PARTS:
        want = known(t[:-1] + s * np.diff(t))
        np.testing.assert_allclose(found.at(s), want, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.middle, found.at(0.5), rtol=0, atol=1e-14)


@settings(max_examples=200)
@given(
    steps=st.lists(st.floats(1e-3, 10.0), min_size=1, max_size=8),
    values=st.lists(st.floats(-5.0, 5.0), min_size=27, max_size=27),
)
def test_between_samples_a_rate_stays_between_them(steps: list[float], values: list[float]) -> None:
    t = np.concatenate([[0.0], np.cumsum(steps)])
    rates = np.reshape(values, (9, 3))[: len(t)]
    found = body_rates_of_samples(t, rates)
    low, high = np.minimum(rates[:-1], rates[1:]), np.maximum(rates[:-1], rates[1:])
    for s in PARTS:
        assert (found.at(s) >= low - 1e-13).all()
        assert (found.at(s) <= high + 1e-13).all()


def test_over_a_gap_a_constant_rate_stays_constant() -> None:
    t = np.array([0.0, 0.01, 0.02, 5.02, 5.03, 5.04])
    rates = np.outer([0.0, 0.0, 0.02, 0.02, 0.0, 0.0], [0.0, 0.0, 1.0])
    found = body_rates_of_samples(t, rates)
    for s in PARTS:
        np.testing.assert_allclose(found.at(s)[2], [0.0, 0.0, 0.02], rtol=0, atol=1e-16)
