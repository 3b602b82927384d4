"""Rates of recorded positions, against polynomials and finer grids."""

from __future__ import annotations

import numpy as np

from des_cli.profiles_in.rates_of_positions import rates_of_positions

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


def error_of(count: int) -> float:
    # A smoothly uneven grid keeps its shape when it is refined.
    s = np.linspace(0, 1, count)
    t = s + 0.1 * np.sin(2 * np.pi * s)
    found = rates_of_positions(t, np.sin(5 * t)[:, None])[:, 0]
    return float(np.abs(found - 5 * np.cos(5 * t)).max())


def test_the_error_falls_with_the_second_order() -> None:
    assert 2**1.7 < error_of(201) / error_of(401) < 2**2.6
