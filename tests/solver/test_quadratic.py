"""Quadratic programs over control points against a dense method."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest

from des_cli.solver.band import SymmetricBand
from des_cli.solver.quadratic import minimise_quadratic
from des_cli.solver.spline import Ends, SplineGrid

GRID = SplineGrid(0.0, 0.25, 8)
COMPONENTS = 2


class DifferenceRows:
    """Bounds on differences of some orders of a base plus a deviation."""

    def __init__(self, base, bounds):
        self.base, self.orders = base, tuple(bounds)
        self.bounds = np.concatenate(
            [
                np.full((GRID.points - order) * COMPONENTS, bounds[order], dtype=float)
                for order in self.orders
            ]
        )

    def change(self, deviation):
        return np.concatenate([GRID.differences(deviation, o).ravel() for o in self.orders])

    def value(self, deviation):
        return self.change(self.base + deviation)

    def _parts(self, rows):
        sizes = np.cumsum([(GRID.points - order) * COMPONENTS for order in self.orders])
        return [part.reshape(-1, COMPONENTS) for part in np.split(rows, sizes[:-1])]

    def adjoint(self, multiplier):
        parts = zip(self.orders, self._parts(multiplier), strict=True)
        return sum(GRID.differences_adjoint(part, order) for order, part in parts)

    def add_to(self, band, stiffness):
        for order, part in zip(self.orders, self._parts(stiffness), strict=True):
            band.add_differences(part, order, GRID.step)


def ends_of(start_value=False, start_rate=False, end_value=False, held=(False, False)):
    no = np.zeros(COMPONENTS, dtype=bool)
    return Ends(no | start_value, no | start_rate, no | end_value, no, np.array(held))


@pytest.fixture
def target():
    """Control points that step: differences far beyond the bounds."""
    t = GRID.greville
    return np.stack([np.where(t > 1.0, 1.0, -1.0), np.sin(6.0 * t)], axis=1)


def near(target):
    """1/2 |x - target|^2 and a little on the third differences."""
    hessian = SymmetricBand(GRID.points, COMPONENTS)
    hessian.data[:, :, 0] = 1.0
    hessian.add_differences(np.full((GRID.points - 3, COMPONENTS), 1e-6), 3, GRID.step)
    return hessian, target.copy()


def dense_optimum(hessian, linear, rows, ends):
    """The same by IPOPT over the unknowns that the ends leave."""
    free = np.flatnonzero(~ends.idle(GRID.points).ravel())

    def spread(y):
        full = np.zeros(GRID.points * COMPONENTS)
        full[free] = y
        return ends.full(full.reshape(-1, COMPONENTS))

    matrix = np.stack([spread(e).ravel() for e in np.eye(len(free))], axis=1)
    jacobian = np.stack([rows.change(spread(e)) for e in np.eye(len(free))], axis=1)
    at_zero = rows.value(np.zeros_like(linear))
    full = np.stack([hessian.times(c.reshape(-1, COMPONENTS)).ravel() for c in matrix.T], axis=1)
    y = ca.MX.sym("y", len(free))
    square, slope = matrix.T @ full, matrix.T @ linear.ravel()
    solver = ca.nlpsol(
        "solver",
        "ipopt",
        {"x": y, "f": 0.5 * ca.dot(y, square @ y) - ca.dot(slope, y), "g": jacobian @ y},
        {"print_time": False, "ipopt.print_level": 0, "ipopt.sb": "yes", "ipopt.tol": 1e-12},
    )
    found = solver(x0=0.0, lbg=-rows.bounds - at_zero, ubg=rows.bounds - at_zero)
    assert solver.stats()["success"]
    return float(found["f"]), spread(np.array(found["x"]).ravel())


def cost(hessian, linear, x):
    return float(np.sum(x * (0.5 * hessian.times(x) - linear)))


@pytest.mark.parametrize(
    "ends",
    [
        ends_of(),
        ends_of(start_value=True),
        ends_of(start_value=True, start_rate=True),
        ends_of(start_value=True, end_value=True, held=(False, True)),
    ],
    ids=["free", "value", "value-rate", "held"],
)
@pytest.mark.parametrize(
    "bounds", [{0: 0.8}, {1: 2.0}, {1: 3.0, 2: 12.0}, {2: 9.0, 3: 40.0}], ids=str
)
def test_against_a_dense_method(target, bounds, ends):
    hessian, linear = near(target)
    rows = DifferenceRows(np.zeros_like(target), bounds)
    outcome = minimise_quadratic(hessian, linear, rows, ends)
    assert outcome.feasible
    assert outcome.iterations > 0
    assert np.all(np.abs(rows.value(outcome.x)) <= rows.bounds * (1.0 + 1e-9))
    np.testing.assert_allclose(ends.full(outcome.x * ~ends.idle(GRID.points)), outcome.x, atol=1e-9)
    least, x = dense_optimum(hessian, linear, rows, ends)
    assert cost(hessian, linear, outcome.x) == pytest.approx(least, abs=2e-6 * abs(least))
    np.testing.assert_allclose(outcome.x, x, atol=3e-3)


def test_the_unlimited_optimum_is_taken_where_it_keeps_the_limits(target):
    hessian, linear = near(target)
    rows = DifferenceRows(np.zeros_like(target), {0: 2.0})
    outcome = minimise_quadratic(hessian, linear, rows, ends_of())
    assert (outcome.iterations, outcome.feasible, outcome.infeasibility) == (0, True, 0.0)
    np.testing.assert_allclose(hessian.times(outcome.x), linear, atol=1e-12)


def test_a_base_counts(target):
    hessian, linear = near(target)
    rows = DifferenceRows(np.full_like(target, 0.7), {0: 0.8})
    outcome = minimise_quadratic(hessian, linear, rows, ends_of())
    assert outcome.feasible
    assert np.max(outcome.x) == pytest.approx(0.1, abs=1e-6)


@pytest.mark.parametrize("value", [1.01, 1.5, 2.0])
def test_limits_that_exclude_each_other_are_reported(target, value):
    # the value at the start stays where it is, and may be 1 at most
    hessian, linear = near(target)
    rows = DifferenceRows(np.full_like(target, value), {0: 1.0, 2: 3.0})
    outcome = minimise_quadratic(hessian, linear, rows, ends_of(start_value=True))
    assert not outcome.feasible
    worst = np.max(np.abs(rows.value(outcome.x)) / rows.bounds) - 1.0
    assert outcome.infeasibility == pytest.approx(worst)
    assert outcome.infeasibility > 1e-3


def test_a_cost_that_is_not_convex_is_refused(target):
    hessian, linear = near(target)
    hessian.data[:, :, 0] -= 2.0
    rows = DifferenceRows(np.zeros_like(target), {0: 1.0})
    with pytest.raises(ValueError, match="not convex"):
        minimise_quadratic(hessian, linear, rows, ends_of())
