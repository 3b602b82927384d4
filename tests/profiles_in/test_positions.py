"""Rates and middles of recorded samples, against polynomials and finer grids."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.profiles_in.positions import middles_of_samples, rates_of_positions

UNEVEN = np.array([0.0, 0.1, 0.4, 0.45, 1.0, 1.7, 1.75, 2.6])


def test_rates_of_a_parabola_are_exact_on_an_uneven_grid() -> None:
    t = UNEVEN + 100.0
    position = np.column_stack([3 * UNEVEN**2 - UNEVEN + 7, -0.5 * UNEVEN**2])
    want = np.column_stack([6 * UNEVEN - 1, -UNEVEN])
    np.testing.assert_allclose(rates_of_positions(t, position), want, rtol=0, atol=1e-10)


def test_rates_of_three_samples_are_those_of_their_parabola() -> None:
    t = np.array([0.0, 1.0, 3.0])
    np.testing.assert_allclose(rates_of_positions(t, (t**2)[:, None])[:, 0], 2 * t, atol=1e-14)


def test_rates_of_two_samples_are_those_of_the_chord() -> None:
    rates = rates_of_positions(np.array([1.0, 1.5]), np.array([[2.0], [4.0]]))
    np.testing.assert_array_equal(rates, [[4.0], [4.0]])


def error_of(function: str, count: int) -> float:
    # A smoothly uneven grid keeps its shape when it is refined.
    s = np.linspace(0, 1, count)
    t = s + 0.1 * np.sin(2 * np.pi * s)
    if function == "rates":
        found = rates_of_positions(t, np.sin(5 * t)[:, None])[:, 0]
        return float(np.abs(found - 5 * np.cos(5 * t)).max())
    found = middles_of_samples(t, np.sin(5 * t)[:, None])[:, 0]
    return float(np.abs(found - np.sin(2.5 * (t[:-1] + t[1:]))).max())


@pytest.mark.parametrize(("function", "order"), [("rates", 2), ("middles", 4)])
def test_the_error_falls_with_the_order_promised(function: str, order: int) -> None:
    halved = error_of(function, 201) / error_of(function, 401)
    assert 2 ** (order - 0.3) < halved < 2 ** (order + 0.6)


@pytest.mark.parametrize("count", [2, 3, 4, 8])
def test_middles_of_a_polynomial_of_the_degree_kept_are_exact(count: int) -> None:
    degree = min(3, count - 1)
    t = UNEVEN[:count]
    middle = 0.5 * (t[:-1] + t[1:])
    found = middles_of_samples(t + 1e3, ((t - 0.7) ** degree)[:, None])
    np.testing.assert_allclose(found[:, 0], (middle - 0.7) ** degree, rtol=0, atol=1e-9)
