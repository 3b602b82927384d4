"""Uniform cubic B-splines against polynomials and SciPy's, and the conditions at ends."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from scipy.interpolate import BSpline

from des_cli.solver.spline import FEWEST_INTERVALS, GAUSS, Ends, SplineGrid

GRID = SplineGrid(start=-0.7, step=0.3, intervals=7)
KEPT = list(product([False, True], repeat=4))


def control_of(coefficients, grid=GRID):
    """Control points of c0 + c1 t + c2 t^2 + c3 t^3 by its blossom at three knots."""
    t, h = grid.greville[:, None], grid.step
    before, after = t - h, t + h
    pairs = before * t + before * after + t * after
    c0, c1, c2, c3 = coefficients
    return c0 + c1 * t + c2 * pairs / 3.0 + c3 * before * t * after


def scipy_spline(control, grid=GRID):
    knots = grid.start + grid.step * np.arange(-3, grid.intervals + 4)
    return BSpline(knots, control, 3)


@pytest.fixture
def rng():
    return np.random.default_rng(11)


def test_the_basis_adds_up_to_one_and_its_derivatives_to_nothing():
    u = np.linspace(0.0, 1.0, 11)
    np.testing.assert_allclose(GRID.basis(u, 0).sum(axis=1), 1.0, rtol=1e-15)
    assert np.all(GRID.basis(u, 0) >= 0.0)
    for order in (1, 2, 3):
        np.testing.assert_allclose(GRID.basis(u, order).sum(axis=1), 0.0, atol=1e-13)


@pytest.mark.parametrize("order", [0, 1, 2])
def test_each_order_is_the_derivative_of_the_one_before(order):
    u, h = np.linspace(0.1, 0.9, 5), 1e-5
    ahead, behind = GRID.basis(u + h, order), GRID.basis(u - h, order)
    expected = (ahead - behind) / (2.0 * h * GRID.step)
    np.testing.assert_allclose(GRID.basis(u, order + 1), expected, rtol=1e-7, atol=1e-7)


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_cubics_are_met_exactly(order, rng):
    coefficients = rng.normal(size=(4, 2))
    t = np.linspace(GRID.start, GRID.start + GRID.duration, 40)
    expected = np.stack(
        [np.polynomial.Polynomial(c).deriv(order)(t) for c in coefficients.T], axis=1
    )
    found = GRID.values(control_of(coefficients), t, order)
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-12)


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_any_spline_is_scipys(order, rng):
    control = rng.normal(size=(GRID.points, 3))
    t = GRID.start + GRID.duration * rng.random(50)
    expected = scipy_spline(control).derivative(order)(t) if order else scipy_spline(control)(t)
    np.testing.assert_allclose(GRID.values(control, t, order), expected, rtol=0, atol=1e-11)
    at = GRID.at_fractions(control, np.array(GAUSS), order)
    times = GRID.knots[:-1, None] + GRID.step * np.array(GAUSS)
    assert at.shape == (GRID.intervals, 2, 3)
    same = GRID.values(control, times.ravel(), order).reshape(at.shape)
    np.testing.assert_allclose(at, same, rtol=0, atol=1e-11)


def test_values_at_both_ends(rng):
    control = rng.normal(size=(GRID.points, 1))
    ends = GRID.values(control, GRID.knots[[0, -1]])
    weights = np.array([1.0, 4.0, 1.0]) / 6.0
    np.testing.assert_allclose(ends[:, 0], [weights @ control[:3, 0], weights @ control[-3:, 0]])


def test_differences_are_the_derivatives_at_knots(rng):
    control = rng.normal(size=(GRID.points, 2))
    acceleration = GRID.values(control, GRID.knots, 2)
    np.testing.assert_allclose(GRID.differences(control, 2), acceleration, atol=1e-12)
    jerk = GRID.values(control, GRID.knots[:-1] + 0.5 * GRID.step, 3)
    np.testing.assert_allclose(GRID.differences(control, 3), jerk, atol=1e-11)
    np.testing.assert_array_equal(GRID.differences(control, 0), control)
    middle = GRID.differences(control, 1)
    np.testing.assert_allclose(
        0.5 * (middle[1:] + middle[:-1]), GRID.values(control, GRID.knots, 1), atol=1e-12
    )


@pytest.mark.parametrize("order", [0, 1, 2, 3])
def test_the_adjoint_of_differences(order, rng):
    control = rng.normal(size=(GRID.points, 3))
    values = rng.normal(size=(GRID.points - order, 3))
    one = np.sum(values * GRID.differences(control, order))
    other = np.sum(GRID.differences_adjoint(values, order) * control)
    assert one == pytest.approx(other, rel=1e-12)


def test_a_refined_spline_is_the_same_curve(rng):
    control = rng.normal(size=(GRID.points, 3))
    finer, fine = GRID.refined(control)
    assert (finer.intervals, finer.start) == (2 * GRID.intervals, GRID.start)
    assert finer.duration == pytest.approx(GRID.duration)
    t = np.linspace(GRID.start, GRID.start + GRID.duration, 61)
    for order in range(3):
        np.testing.assert_allclose(
            finer.values(fine, t, order), GRID.values(control, t, order), rtol=0, atol=1e-11
        )


def test_a_straight_line_has_its_own_values_at_its_control_points():
    control = control_of(np.array([[0.4], [-1.5], [0.0], [0.0]]))
    np.testing.assert_allclose(control[:, 0], 0.4 - 1.5 * GRID.greville, atol=1e-14)


def test_too_few_intervals_are_refused():
    SplineGrid(0.0, 1.0, FEWEST_INTERVALS)
    with pytest.raises(ValueError, match="at least"):
        SplineGrid(0.0, 1.0, FEWEST_INTERVALS - 1)


def ends_of(kept, held=(False, False)):
    """The same conditions on both of two components."""
    return Ends(*(np.array([each, each]) for each in kept), held=np.array(held))


@pytest.mark.parametrize("intervals", [3, 7])
@pytest.mark.parametrize("kept", KEPT, ids=str)
def test_conditions_at_the_ends_hold(kept, intervals, rng):
    grid, ends = SplineGrid(0.0, 0.5, intervals), ends_of(kept)
    y = rng.normal(size=(grid.points, 2))
    deviation = ends.full(y)
    tips = grid.knots[[0, -1]]
    value, rate = grid.values(deviation, tips, 0), grid.values(deviation, tips, 1)
    for condition, off in zip(kept, (value[0], rate[0], value[1], rate[1]), strict=True):
        if condition:
            np.testing.assert_allclose(off, 0.0, atol=1e-13)
        else:
            assert np.all(np.abs(off) > 1e-6)


@pytest.mark.parametrize("held", [(False, False), (True, False), (True, True)], ids=str)
@pytest.mark.parametrize("kept", KEPT, ids=str)
def test_nothing_else_is_lost(kept, held, rng):
    grid, ends = SplineGrid(0.0, 0.5, 3), ends_of(kept, held)
    size = 2 * grid.points
    full = np.stack([ends.full(e.reshape(-1, 2)).ravel() for e in np.eye(size)], axis=1)
    reduced = np.stack([ends.reduce(e.reshape(-1, 2)).ravel() for e in np.eye(size)], axis=1)
    np.testing.assert_array_equal(reduced, full.T)
    free = 2 - sum(held)
    assert np.linalg.matrix_rank(full) == free * (grid.points - sum(kept))
    idle = ends.idle(grid.points).ravel()
    assert not full[:, idle].any()
    assert np.all(np.any(full[:, ~idle], axis=0))
    assert np.count_nonzero(~idle) == np.linalg.matrix_rank(full)


def test_a_held_component_does_not_move(rng):
    ends = ends_of((True, False, False, False), (False, True))
    deviation = ends.full(rng.normal(size=(9, 2)))
    assert not deviation[:, 1].any()
    assert deviation[:, 0].any()


def test_components_may_differ(rng):
    yes = np.array([True, False])
    ends = Ends(yes, ~yes, ~yes, yes, np.zeros(2, dtype=bool))
    grid = SplineGrid(0.0, 0.5, 4)
    deviation = ends.full(rng.normal(size=(grid.points, 2)))
    value, rate = (grid.values(deviation, grid.knots[[0, -1]], order) for order in (0, 1))
    kept = [value[0, 0], rate[0, 1], value[1, 1], rate[1, 0]]
    free = [value[0, 1], rate[0, 0], value[1, 0], rate[1, 1]]
    np.testing.assert_allclose(kept, 0.0, atol=1e-13)
    assert np.all(np.abs(free) > 1e-6)
