"""The interior-point method on problems whose optima are known in closed form."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.optimize

from des_cli.solver.interior import minimise
from des_cli.solver.program import Expansion, Measure, Rows


class Program:
    """1/2 int |u - goal|^2 over unit time; the states stand still unless told otherwise."""

    rows = ()
    budgets = ()
    scale = 1.0
    goal = 0.0

    def __init__(self, intervals, controls=1):
        self.n, self.h = intervals + 1, 1.0 / intervals
        self.weight = np.full(self.n, self.h)
        self.weight[[0, -1]] *= 0.5
        self.pinned = np.zeros((self.n, 3 + controls), dtype=bool)
        self.pinned[0, :3] = True

    def cost(self, x):
        return 0.5 * float(self.weight @ np.sum((x[:, 3:] - self.goal) ** 2, axis=1))

    def expand(self, x):
        gradient, hessian = np.zeros_like(x), np.zeros((*x.shape, x.shape[1]))
        gradient[:, 3:] = self.weight[:, None] * (x[:, 3:] - self.goal)
        free = np.arange(3, x.shape[1])
        hessian[:, free, free] = self.weight[:, None]
        return Expansion(self.cost(x), gradient, hessian)

    def slope(self, x):
        """Time derivative of the states, (n, 3), and its Jacobian, (n, 3, 3 + m)."""
        return np.zeros((len(x), 3)), np.zeros((len(x), 3, x.shape[1]))

    def defect(self, x):
        slope = self.slope(x)[0]
        return np.diff(x[:, :3], axis=0) - 0.5 * self.h * (slope[:-1] + slope[1:])

    def defect_jacobian(self, x):
        second = 0.5 * self.h * self.slope(x)[1]
        unit = np.eye(3, x.shape[1])
        return -unit - second[:-1], unit - second[1:]

    def defect_curvature(self, x, multiplier):
        return None


class DoubleIntegrator(Program):
    """Position, velocity (the third state rests); the control is the acceleration."""

    def __init__(self, intervals, first, last):
        super().__init__(intervals)
        self.pinned[-1, :2] = True
        self.start = np.zeros((self.n, 4))
        self.start[0, :2], self.start[-1, :2] = first, last

    def slope(self, x):
        slope, jacobian = super().slope(x)
        slope[:, 0], slope[:, 1] = x[:, 1], x[:, 3]
        jacobian[:, 0, 1] = jacobian[:, 1, 3] = 1.0
        return slope, jacobian


class Growth(Program):
    """y' = y u from 1 to e: with log y as the state the optimum is u = 1, at 1/2."""

    def __init__(self, intervals):
        super().__init__(intervals)
        self.pinned[-1, 0] = True
        self.start = np.ones((self.n, 4))
        self.start[:, 3] = 0.0
        self.start[-1, 0] = np.e

    def slope(self, x):
        slope, jacobian = super().slope(x)
        slope[:, 0] = x[:, 0] * x[:, 3]
        jacobian[:, 0, 0], jacobian[:, 0, 3] = x[:, 3], x[:, 0]
        return slope, jacobian

    def defect_curvature(self, x, multiplier):
        curvature = np.zeros((self.n, 4, 4))
        for part in (curvature[:-1], curvature[1:]):
            part[:, 0, 3] -= 0.5 * self.h * multiplier[:, 0]
            part[:, 3, 0] -= 0.5 * self.h * multiplier[:, 0]
        return curvature


class Valley(Program):
    """1/2 int (1 - cos u): from u = 3, where it bends down, Newton's step leads uphill."""

    def cost(self, x):
        return float(self.weight @ np.sum(1.0 - np.cos(x[:, 3:]), axis=1))

    def expand(self, x):
        expansion = super().expand(x)
        gradient, curvature = 0.0 * x, 0.0 * expansion.hessian
        gradient[:, 3] = self.weight * np.sin(x[:, 3])
        curvature[:, 3, 3] = self.weight * (np.cos(x[:, 3]) - 1.0)
        return Expansion(self.cost(x), gradient, expansion.hessian, curvature=curvature)


class Position(Rows):
    """|position| <= bound."""

    def __init__(self, n, bound):
        super().__init__(np.arange(n))
        self.bound = bound

    def value(self, x):
        return x[:, :1] / self.bound

    def jacobian(self, x):
        return (np.tile(np.eye(4)[:1] / self.bound, (len(x), 1, 1)),)


class Disc(Rows):
    """|u|^2 <= 1 for two controls: not linear."""

    def __init__(self, n):
        super().__init__(np.arange(n))

    def value(self, x):
        return np.sum(x[:, 3:] ** 2, axis=1, keepdims=True)

    def jacobian(self, x):
        jacobian = np.zeros((len(x), 1, 5))
        jacobian[:, 0, 3:] = 2.0 * x[:, 3:]
        return (jacobian,)

    def curvature(self, x, multiplier):
        curvature = np.zeros((len(x), 5, 5))
        curvature[:, [3, 4], [3, 4]] = 2.0 * multiplier
        return curvature


class Climb(Rows):
    """The control changes by at most so much an interval."""

    def __init__(self, n, bound):
        super().__init__(np.arange(n - 1))
        self.bound = bound

    def value(self, x):
        return np.diff(x[:, 3:], axis=0) / self.bound

    def jacobian(self, x):
        at_next = np.zeros((len(x) - 1, 1, 4))
        at_next[:, 0, 3] = 1.0 / self.bound
        return -at_next, at_next


class Curve(Rows):
    """The control's second difference is at most so much: three samples in a row."""

    def __init__(self, n, bound):
        super().__init__(np.arange(n - 2))
        self.bound = bound

    def value(self, x):
        return np.diff(x[:, 3:], 2, axis=0) / self.bound

    def jacobian(self, x):
        unit = np.zeros((len(x) - 2, 1, 4))
        unit[:, 0, 3] = 1.0 / self.bound
        return unit, -2.0 * unit, unit


class Effort(Measure):
    """int (u - rest)^2 over unit time, over its budget."""

    def __init__(self, program, rest, budget):
        self.weight, self.rest = program.weight / budget, rest

    def value(self, x):
        return float(self.weight @ np.sum((x[:, 3:] - self.rest) ** 2, axis=1))

    def expand(self, x):
        gradient, hessian = np.zeros_like(x), np.zeros((*x.shape, x.shape[1]))
        gradient[:, 3:] = 2.0 * self.weight[:, None] * (x[:, 3:] - self.rest)
        free = np.arange(3, x.shape[1])
        hessian[:, free, free] = 2.0 * self.weight[:, None]
        return Expansion(self.value(x), gradient, hessian)


def test_a_budget_on_the_whole_motion():
    # min 1/2 (u - 2.5)^2 with u^2 <= 1: u = 1, and the price z of u - 2.5 + 2 z u = 0.
    program = Program(10)
    program.goal = 2.5
    program.budgets = (Effort(program, 0.0, 1.0),)
    outcome = minimise(program, np.zeros((11, 4)))
    assert outcome.status == "converged"
    np.testing.assert_allclose(outcome.x[:, 3], 1.0, atol=1e-8)
    np.testing.assert_allclose(outcome.prices, 0.75, rtol=1e-7)


def test_several_budgets_of_which_two_bind():
    # Nearest to (3, -1) in two discs about (0, 0) and (1, 1) of radius 1: where they meet.
    program = Program(10, controls=2)
    program.goal = np.array([3.0, -1.0])
    rests = ([0.0, 0.0], [1.0, 1.0], [2.0, -1.0])
    most = (1.0, 1.0, 9.0)
    program.budgets = tuple(
        Effort(program, np.array(r), m) for r, m in zip(rests, most, strict=True)
    )
    outcome = minimise(program, np.zeros((11, 5)))
    assert outcome.status == "converged"
    np.testing.assert_allclose(outcome.x[:, 3:], np.tile([1.0, 0.0], (11, 1)), atol=1e-7)
    # u - goal + 2 z1 u + 2 z2 (u - 1) = 0
    np.testing.assert_allclose(outcome.prices, [1.0, 0.5, 0.0], atol=1e-6)


def test_a_budget_beside_local_inequalities_that_reach_over_three_samples():
    n = 9
    program = Program(n - 1)
    program.goal = np.sin(np.arange(n) ** 2.0)[:, None]
    program.rows = (Curve(n, 0.4),)
    program.budgets = (Effort(program, 0.0, 0.05),)
    outcome = minimise(program, np.zeros((n, 4)))
    assert outcome.status == "converged"

    def cost(u):
        return 0.5 * float(program.weight @ (u - program.goal[:, 0]) ** 2)

    bounds = [
        {"type": "ineq", "fun": lambda u: 0.05 - program.weight @ u**2},
        {"type": "ineq", "fun": lambda u: 0.4 - np.diff(u, 2)},
        {"type": "ineq", "fun": lambda u: 0.4 + np.diff(u, 2)},
    ]
    peer = scipy.optimize.minimize(
        cost, np.zeros(n), constraints=bounds, method="SLSQP", options={"ftol": 1e-14}
    )
    assert peer.success
    assert outcome.cost == pytest.approx(peer.fun, rel=1e-7)
    np.testing.assert_allclose(outcome.x[:, 3], peer.x, atol=1e-4)
    assert np.abs(np.diff(outcome.x[:, 3], 2)).max() == pytest.approx(0.4, abs=1e-6)


def test_an_unconstrained_quadratic_takes_one_step():
    program = Program(10)
    program.goal = 2.5
    outcome = minimise(program, np.zeros((11, 4)))
    assert outcome.status == "converged"
    assert [line.number for line in outcome.log] == [0, 1]
    assert [line.step for line in outcome.log] == [0.0, 1.0]
    np.testing.assert_allclose(outcome.x[:, 3], 2.5, atol=1e-12)
    assert outcome.cost == pytest.approx(0.0, abs=1e-20)


def test_rest_to_rest_over_unit_time_and_distance():
    # x = 3 t^2 - 2 t^3, a = 6 - 12 t, J = 1/2 int a^2 = 6; the start breaks the dynamics.
    program = DoubleIntegrator(1000, (0.0, 0.0), (1.0, 0.0))
    outcome = minimise(program, program.start)
    t = np.linspace(0.0, 1.0, 1001)
    assert outcome.status == "converged"
    assert outcome.log[0].infeasibility == pytest.approx(1.0)
    assert len(outcome.log) == 2
    assert outcome.infeasibility < 1e-12
    assert outcome.cost == pytest.approx(6.0, abs=1e-4)
    np.testing.assert_allclose(outcome.x[:, 0], 3 * t**2 - 2 * t**3, atol=1e-5)
    # (half a sample's weight at the ends: there the trapezoidal rule is of first order)
    np.testing.assert_allclose(outcome.x[1:-1, 3], (6 - 12 * t)[1:-1], atol=1e-4)


def test_multipliers_are_the_costates():
    # For the double integrator the costate of the velocity is minus the acceleration,
    # and that of the position is constant; between samples, in the sign of the defect.
    program = DoubleIntegrator(400, (0.0, 0.0), (1.0, 0.0))
    outcome = minimise(program, program.start)
    middle = (np.arange(400) + 0.5) / 400
    np.testing.assert_allclose(np.abs(outcome.multiplier[:, 0]), 12.0, rtol=1e-4)
    np.testing.assert_allclose(outcome.multiplier[:, 1], 6.0 - 12.0 * middle, atol=1e-3)


@pytest.mark.parametrize(
    ("bound", "expected"),
    # 4 / (9 l) up to l = 1/6, then 2 + 6 (1 - 4 l)^2 up to 1/4 (Bryson and Ho, section 3.11).
    [(1 / 9, 4.0), (1 / 6, 8 / 3), (0.2, 2.24), (0.3, 2.0)],
)
def test_bryson_and_denham(bound, expected):
    program = DoubleIntegrator(1000, (0.0, 1.0), (0.0, -1.0))
    program.rows = (Position(1001, bound),)
    outcome = minimise(program, program.start)
    assert outcome.status == "converged"
    assert outcome.cost == pytest.approx(expected, abs=1e-4)
    assert outcome.x[:, 0].max() <= bound * (1.0 + 1e-9)
    if bound < 0.25:
        assert outcome.x[:, 0].max() == pytest.approx(bound, rel=1e-6)


def test_a_convex_problem_has_one_optimum_from_any_start():
    program = DoubleIntegrator(200, (0.0, 1.0), (0.0, -1.0))
    program.rows = (Position(201, 1 / 9),)
    costs = []
    for barrier in (1.0, 1e-3):
        for seed in (1, 2):
            start = program.start + np.random.default_rng(seed).normal(size=(201, 4))
            start[program.pinned] = program.start[program.pinned]
            outcome = minimise(program, start, barrier=barrier)
            assert outcome.status == "converged"
            costs.append(outcome.cost)
    assert np.ptp(costs) < 1e-7


def test_dynamics_that_are_not_linear():
    program = Growth(500)
    outcome = minimise(program, program.start)
    assert outcome.status == "converged"
    assert outcome.cost == pytest.approx(0.5, abs=1e-5)
    np.testing.assert_allclose(outcome.x[1:-1, 3], 1.0, atol=1e-5)
    np.testing.assert_allclose(outcome.x[:, 0], np.exp(np.linspace(0, 1, 501)), rtol=1e-5)
    assert len(outcome.log) < 12  # Newton's rate, which needs the curvature of the dynamics


def test_inequalities_that_are_not_linear():
    # Nearest point of the unit disc to (1, 1), at every sample.
    program = Program(20, controls=2)
    program.goal = 1.0
    program.rows = (Disc(21),)
    outcome = minimise(program, np.zeros((21, 5)))
    assert outcome.status == "converged"
    np.testing.assert_allclose(outcome.x[:, 3:], np.sqrt(0.5), atol=1e-6)
    assert outcome.cost == pytest.approx(0.5 * (np.sqrt(2.0) - 1.0) ** 2, rel=1e-6)


def test_inequalities_between_neighbours():
    # From u = 0, pinned, to 0.95 as fast as 0.1 an interval: a ramp, then the goal.
    program = Program(20)
    program.goal = 0.95
    program.pinned[0, 3] = True
    program.rows = (Climb(21, 0.1),)
    outcome = minimise(program, np.zeros((21, 4)))
    expected = np.minimum(0.1 * np.arange(21), 0.95)
    assert outcome.status == "converged"
    np.testing.assert_allclose(outcome.x[:, 3], expected, atol=1e-6)


def test_negative_curvature_is_left_downhill():
    outcome = minimise(Valley(5), np.hstack([np.zeros((6, 3)), np.full((6, 1), 3.0)]))
    assert outcome.status == "converged"
    np.testing.assert_allclose(np.cos(outcome.x[:, 3]), 1.0, atol=1e-12)
    costs = [line.cost for line in outcome.log]
    assert costs == sorted(costs, reverse=True)


def test_bounds_that_cannot_be_kept_are_not_called_converged():
    # From 0 to 1 with |position| <= 1/2.
    program = DoubleIntegrator(50, (0.0, 0.0), (1.0, 0.0))
    program.rows = (Position(51, 0.5),)
    outcome = minimise(program, program.start, max_iterations=100)
    assert outcome.status in ("diverged", "iteration-limit")
    assert outcome.infeasibility > 1e-3


def test_too_few_iterations():
    program = DoubleIntegrator(100, (0.0, 1.0), (0.0, -1.0))
    program.rows = (Position(101, 1 / 9),)
    outcome = minimise(program, program.start, max_iterations=3)
    assert outcome.status == "iteration-limit"
    assert len(outcome.log) <= 4
    assert max(outcome.optimality, outcome.infeasibility) > 1e-9


def test_the_log_is_numbered_on_and_reported_as_it_grows():
    program = DoubleIntegrator(50, (0.0, 1.0), (0.0, -1.0))
    program.rows = (Position(51, 1 / 9),)
    heard = []
    outcome = minimise(program, program.start, first_number=7, on_iteration=heard.append)
    assert [line.number for line in outcome.log] == list(range(7, 7 + len(outcome.log)))
    assert tuple(heard) == outcome.log
    assert outcome.log[-1].cost == outcome.cost
    assert outcome.log[-1].optimality == outcome.optimality
    assert all(0.0 <= line.step <= 1.0 for line in outcome.log)


def test_pinned_unknowns_and_the_start_are_left_alone():
    program = DoubleIntegrator(30, (0.1, 0.2), (1.0, -0.3))
    start = program.start.copy()
    outcome = minimise(program, start)
    np.testing.assert_array_equal(start, program.start)
    np.testing.assert_array_equal(outcome.x[program.pinned], start[program.pinned])
