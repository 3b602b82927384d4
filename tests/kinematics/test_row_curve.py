"""Curves along the rows of a table: through them, and beside them inside their differences."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.row_curve import beside_rows, through_rows


def rows(seed: int = 0, count: int = 30) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(seed)
    return 2.0 + 0.1 * np.arange(count), random.normal(size=(count, 2))


def test_the_curve_through_the_rows_meets_each_of_them() -> None:
    t, values = rows()
    np.testing.assert_allclose(through_rows(t, values).at(t), values, atol=1e-12)


@pytest.mark.parametrize("degree", [0, 1, 2])
def test_both_curves_keep_a_parabola(degree: int) -> None:
    t, _ = rows()
    values = ((t - 2.5) ** degree)[:, None]
    fine = np.linspace(t[0], t[-1], 301)
    exact = ((fine - 2.5) ** degree)[:, None]
    np.testing.assert_allclose(through_rows(t, values).at(fine), exact, atol=1e-10)
    beside = beside_rows(t, values).at(fine) - exact
    # The B-spline of a parabola is the parabola, moved by a sixth of f'' times the step squared.
    np.testing.assert_allclose(beside, 2.0 * 0.1**2 / 6.0 if degree == 2 else 0.0, atol=1e-10)


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_beside_even_rows_every_derivative_is_a_mean_of_their_differences(
    seed: int, order: int
) -> None:
    t, values = rows(seed)
    values[[0, 1, -2, -1]] = 0.0  # at the ends the acceleration goes on, and may leave the rows
    values[[2, -3]] = 0.0
    curve = beside_rows(t, values).at(np.linspace(t[0], t[-1], 4001), order)
    most = np.max(np.abs(np.diff(values, order, axis=0)), axis=0) / 0.1**order
    assert np.all(np.max(np.abs(curve), axis=0) <= most * (1 + 1e-9))


def test_the_curve_through_rows_that_ride_a_limit_overshoots_it() -> None:
    t, values = rows()
    values[:, 0] = np.cumsum(np.cumsum(np.cumsum(np.sign(np.sin(t * 3.0)))))
    third = np.max(np.abs(np.diff(values[:, 0], 3))) / 0.1**3
    fine = np.linspace(t[0], t[-1], 4001)
    assert np.max(np.abs(through_rows(t, values).at(fine, 3)[:, 0])) > 1.1 * third
    assert np.max(np.abs(beside_rows(t, values).at(fine, 3)[:, 0])) <= third * (1 + 1e-9)


def test_beside_rows_at_rest_it_begins_and_ends_at_them() -> None:
    t = 0.1 * np.arange(41)
    u = t / t[-1]
    values = np.column_stack([u**3 * (10.0 - 15.0 * u + 6.0 * u**2), np.sin(t)])
    ends = beside_rows(t, values, slack=2.0).at(t[[0, -1]])
    np.testing.assert_allclose(ends[:, 0], values[[0, -1], 0], atol=1e-15)
    # The other column moves on at its end, and is passed beside there as elsewhere.
    assert ends[0, 1] == pytest.approx(0.0, abs=1e-15)
    assert abs(ends[1, 1] - values[-1, 1]) == pytest.approx(
        0.1**2 / 6.0 * abs(np.sin(3.9)), rel=0.1
    )


def test_a_shorter_last_step_changes_nothing_before_it() -> None:
    t, values = rows()
    whole = beside_rows(t, values)
    cut = beside_rows(np.append(t[:-1], t[-2] + 0.03), values)
    inside = np.linspace(t[0], t[-4], 100)
    np.testing.assert_allclose(cut.at(inside), whole.at(inside), atol=1e-12)


@pytest.mark.parametrize("rates", [False, True])
def test_uneven_rows_of_a_smooth_motion_are_followed(rates: bool) -> None:
    random = np.random.default_rng(1)
    t = np.sort(random.uniform(0.0, 5.0, 400))
    values = np.sin(t)[:, None]
    fine = np.linspace(t[0], t[-1], 1000)
    off = beside_rows(t, values, rates=rates).at(fine) - np.sin(fine)[:, None]
    assert np.max(np.abs(off)) < 2e-3


@pytest.mark.parametrize("count", [2, 3, 4])
def test_few_rows_are_enough(count: int) -> None:
    t, values = rows(count=count)
    for curve in (through_rows(t, values), beside_rows(t, values)):
        assert np.all(np.isfinite(curve.at(np.linspace(t[0], t[-1], 50))))


def test_the_integral_begins_at_the_first_row() -> None:
    t, values = rows()
    for curve in (through_rows(t, values), beside_rows(t, values)):
        fine = np.linspace(t[0], t[-1], 20_001)
        course = curve.at(fine)
        sums = np.sum(0.5 * (course[1:] + course[:-1]), axis=0) * (fine[1] - fine[0])
        ends = curve.at(t[[0, -1]], -1)
        np.testing.assert_allclose(ends[1] - ends[0], sums, atol=1e-6)
