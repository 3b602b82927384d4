"""Rates of recorded positions, against polynomials and finer grids."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from des_cli.model.profile import JointCommands
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.rates_of_positions import rates_of_positions, rates_with_steps

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


@pytest.mark.parametrize("step", [1e-4, 1e-5, 1e-6])
def test_a_step_of_the_rate_stays_one_however_finely_it_is_sampled(step: float) -> None:
    t = np.arange(-200, 301) * step
    position = np.where(t < 0.0, 0.3 * t + 0.2 * t**2, -0.2 * t + 0.1 * t**2)
    start, end = rates_with_steps(t, position)
    rounding = 4e-16 / step
    np.testing.assert_allclose(end[199], 0.3, rtol=0, atol=rounding)
    np.testing.assert_allclose(start[200], -0.2, rtol=0, atol=rounding)
    want = np.where(t < 0.0, 0.3 + 0.4 * t, -0.2 + 0.2 * t)
    np.testing.assert_allclose(start[:200], want[:200], rtol=0, atol=rounding)
    np.testing.assert_allclose(end[200:], want[201:], rtol=0, atol=rounding)


@pytest.mark.parametrize("digits", [1, 2, 3, 4])
def test_noise_and_the_stairs_of_few_digits_are_no_steps(digits: int) -> None:
    t = np.linspace(0.0, 10.0, 10_001)
    rng = np.random.default_rng(digits)
    for position in (
        np.round(np.sin(t), digits),
        np.sin(t) + 10.0**-digits * rng.normal(size=len(t)),
        np.sin(t) + 0.1 * (np.arange(len(t)) == 5000),
    ):
        start, end = rates_with_steps(t, position)
        np.testing.assert_array_equal(start[1:], end[:-1])


def test_the_end_of_a_fast_ramp_over_several_rows_is_no_step() -> None:
    t = np.linspace(0.0, 1.0, 1001)
    rate = np.interp(t, [0.0, 0.5, 0.504, 1.0], [0.0, 0.0, 1.0, 1.0])
    position = np.concatenate([[0.0], np.cumsum(0.5e-3 * (rate[:-1] + rate[1:]))])
    start, end = rates_with_steps(t, position)
    np.testing.assert_array_equal(start[1:], end[:-1])


@pytest.mark.parametrize("intervals", [1000, 10_000])
def test_the_cobra_from_a_table_is_the_cobra(intervals: int, tmp_path: Path) -> None:
    """The cab's rate steps at 5 s by 5 deg/s, as the equations of the study say."""
    t = np.linspace(0.0, 10.0, intervals + 1)
    arm = np.where(t < 5, 8.8 - 0.66 * t, 5.5 + 0.66 * (t - 5))
    fork = -60.0 * (1.0 - np.cos(np.pi * t / 5))
    cab = np.where(t < 5, 30 - 2.5 * t, 17.5 + 2.5 * (t - 5))
    table = tmp_path / "cobra.csv"
    rows = zip(t.tolist(), arm.tolist(), fork.tolist(), cab.tolist(), strict=True)
    lines = [f"{a!r},{b!r},{c!r},{d!r}\n" for a, b, c, d in rows]
    table.write_text("t_s,arm_rpm,fork_deg,cab_deg\n" + "".join(lines))
    command = load_profile(table).command
    middle = intervals // 2
    assert isinstance(command, JointCommands)
    np.testing.assert_allclose(np.degrees(command.rate_end[:middle, 1]), -2.5, atol=1e-8)
    np.testing.assert_allclose(np.degrees(command.rate_start[middle:, 1]), 2.5, atol=1e-8)
    np.testing.assert_array_equal(command.rate_start[1:, 0], command.rate_end[:-1, 0])
