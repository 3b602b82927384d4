"""The feasible interior point on small programs whose optima are known."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pytest
from scipy.linalg import LinAlgError, cho_factor, cho_solve
from scipy.optimize import minimize as scipy_minimize

from des_cli.solver.barrier import Options, minimise
from des_cli.solver.feasible_program import Values


@dataclass
class Function:
    """A function with derivatives; ``curvature`` of its Hessian may be indefinite."""

    value: object
    gradient: object
    hessian: object
    curvature: object = staticmethod(lambda x: np.zeros((len(x), len(x))))


def quadratic(matrix, linear, constant=0.0):
    """1/2 x' A x + b' x + c, all of its Hessian convex."""
    matrix, linear = np.asarray(matrix, float), np.asarray(linear, float)
    return Function(
        lambda x: 0.5 * x @ matrix @ x + linear @ x + constant,
        lambda x: matrix @ x + linear,
        lambda x: matrix,
    )


def disc(centre, radius=1.0):
    """|x - centre|^2 / radius^2, at most one."""
    centre = np.asarray(centre, float)
    scale = 2.0 / radius**2
    return quadratic(
        scale * np.eye(len(centre)), -scale * centre, 0.5 * scale * float(centre @ centre)
    )


def outside(centre):
    """2 - |x - centre|^2, at most one outside the unit disc."""
    inside = disc(centre)
    return Function(
        lambda x: 2.0 - inside.value(x),
        lambda x: -inside.gradient(x),
        lambda x: np.zeros((len(x), len(x))),
        lambda x: -inside.hessian(x),
    )


@dataclass
class Point:
    cost: float
    budgets: np.ndarray
    gradient: np.ndarray
    budget_gradients: np.ndarray
    convex: np.ndarray
    curvature: np.ndarray
    slopes: np.ndarray  # of the local bounds, (k, n)

    def local_change(self, step):
        return self.slopes @ step

    def local_adjoint(self, multiplier):
        return self.slopes.T @ multiplier


@dataclass
class System:
    factor: object

    def solve(self, right):
        return cho_solve(self.factor, right)


@dataclass
class Dense:
    """A program of dense matrices that keeps every iterate."""

    cost: Function
    rows: np.ndarray
    bounds: np.ndarray
    budgets: tuple = ()
    local: tuple = ()
    iterates: list = field(default_factory=list)

    def linear(self, x):
        return self.rows @ x

    linear_change = linear

    def linear_adjoint(self, multiplier):
        return self.rows.T @ multiplier

    def reduce(self, gradient):
        return gradient

    def values(self, x):
        return Values(
            float(self.cost.value(x)),
            np.array([g.value(x) for g in self.budgets]),
            np.array([h.value(x) for h in self.local]),
        )

    def expand(self, x, budget, local, stiffness):
        self.iterates.append(x.copy())
        values = self.values(x)
        convex, curvature = self.cost.hessian(x), self.cost.curvature(x)
        weights = zip([*self.budgets, *self.local], [*budget, *local], strict=True)
        for function, weight in weights:
            convex = convex + weight * function.hessian(x)
            curvature = curvature + weight * function.curvature(x)
        slopes = np.array([h.gradient(x) for h in self.local]).reshape(-1, len(x))
        convex = convex + slopes.T @ (stiffness[:, None] * slopes)
        columns = np.array([g.gradient(x) for g in self.budgets]).reshape(-1, len(x)).T
        return Point(
            values.cost,
            values.budgets,
            self.cost.gradient(x),
            columns,
            convex,
            curvature,
            slopes,
        )

    def system(self, expansion, share, stiffness, shift):
        hessian = expansion.convex + share * expansion.curvature
        matrix = hessian + self.rows.T @ (stiffness[:, None] * self.rows)
        matrix = matrix + shift * np.diag(np.diag(matrix))
        try:
            return System(cho_factor(matrix))
        except LinAlgError:
            return None


def boxed(cost, bound, size, **further):
    """A program with |x_i| <= bound."""
    return Dense(cost, np.eye(size), np.full(size, float(bound)), **further)


def solved(program, start, **options):
    outcome = minimise(program, np.array(start, float), Options(**options))
    assert outcome.status == "converged"
    assert outcome.gap <= 1.01e-7
    for x in program.iterates:  # each of them may be used
        values = program.values(x)
        assert np.all(np.abs(program.linear(x)) < program.bounds)
        assert np.all(values.budgets < 1.0)
        assert np.all(values.local < 1.0)
    return outcome


def test_a_separable_quadratic_is_clipped():
    centre = np.array([0.3, -2.0, 5.0, 0.0])
    program = boxed(quadratic(np.eye(4), -centre), 1.0, 4)
    outcome = solved(program, np.zeros(4))
    np.testing.assert_allclose(outcome.x, np.clip(centre, -1.0, 1.0), atol=1e-6)


@pytest.mark.parametrize("seed", range(5))
def test_a_quadratic_with_rows(seed):
    rng = np.random.default_rng(seed)
    root, rows = rng.normal(size=(6, 6)), rng.normal(size=(9, 6))
    cost = quadratic(root @ root.T + 0.1 * np.eye(6), 5.0 * rng.normal(size=6))
    outcome = solved(Dense(cost, rows, np.ones(9)), np.zeros(6))
    expected = scipy_minimize(
        cost.value,
        np.zeros(6),
        jac=cost.gradient,
        constraints={
            "type": "ineq",
            "fun": lambda x: np.concatenate([1.0 - rows @ x, 1.0 + rows @ x]),
            "jac": lambda x: np.concatenate([-rows, rows]),
        },
        method="SLSQP",
        options={"ftol": 1e-12, "maxiter": 500},
    )
    assert expected.success
    assert outcome.values.cost == pytest.approx(expected.fun, abs=1e-6)
    np.testing.assert_allclose(outcome.x, expected.x, atol=1e-3)


def test_one_budget_and_what_it_is_worth():
    # maximise c'x on a disc of radius r: x = r c/|c|, and a unit of |x|^2/r^2 is worth |c| r/2
    c, radius = np.array([3.0, -4.0]), 0.7
    program = boxed(quadratic(np.zeros((2, 2)), -c), 10.0, 2, budgets=(disc(np.zeros(2), radius),))
    outcome = solved(program, [0.1, 0.0])
    np.testing.assert_allclose(outcome.x, radius * c / 5.0, atol=1e-6)
    assert outcome.budget_multiplier == pytest.approx([5.0 * radius / 2.0], rel=1e-4)
    assert outcome.values.budgets[0] == pytest.approx(1.0, abs=1e-6)


def test_two_budgets_that_both_bind():
    # unit discs about (d, 0) and (-d, 0): the highest point of both is their corner
    d = 0.6
    program = boxed(
        quadratic(np.zeros((2, 2)), [0.0, -1.0]),
        10.0,
        2,
        budgets=(disc([d, 0.0]), disc([-d, 0.0])),
    )
    outcome = solved(program, [0.05, -0.1])
    height = np.sqrt(1.0 - d**2)
    np.testing.assert_allclose(outcome.x, [0.0, height], atol=1e-6)
    # (0, 1) = lambda 2 ((-d, h) + (d, h))
    np.testing.assert_allclose(outcome.budget_multiplier, 0.25 / height, rtol=1e-4)


def test_a_budget_that_does_not_bind_is_worth_nothing():
    program = boxed(
        quadratic(np.eye(2), [-0.1, 0.2]), 10.0, 2, budgets=(disc(np.zeros(2)), disc([0.0, 9], 20))
    )
    outcome = solved(program, [0.5, 0.5])
    np.testing.assert_allclose(outcome.x, [0.1, -0.2], atol=1e-5)
    assert np.all(outcome.budget_multiplier < 1e-6)


def test_a_budget_and_limits_together():
    # maximise x + y with |x| <= 0.3 in the unit disc
    program = Dense(
        quadratic(np.zeros((2, 2)), [-1.0, -1.0]),
        np.array([[1.0, 0.0]]),
        np.array([0.3]),
        budgets=(disc(np.zeros(2)),),
    )
    outcome = solved(program, [0.0, 0.1])
    np.testing.assert_allclose(outcome.x, [0.3, np.sqrt(1.0 - 0.09)], atol=1e-6)


def test_a_start_at_the_least_value_of_a_budget():
    program = boxed(
        quadratic(np.zeros((2, 2)), [-1.0, -1.0]), 10.0, 2, budgets=(disc(np.zeros(2)),)
    )
    outcome = solved(program, [0.0, 0.0])
    np.testing.assert_allclose(outcome.x, np.full(2, np.sqrt(0.5)), atol=1e-6)


def test_a_convex_local_bound():
    target = np.array([3.0, 4.0])
    program = boxed(quadratic(np.eye(2), -target), 10.0, 2, local=(disc(np.zeros(2)),))
    outcome = solved(program, [0.2, -0.3])
    np.testing.assert_allclose(outcome.x, target / 5.0, atol=1e-6)


def test_a_local_bound_that_is_not_convex():
    # nearest to the origin outside the unit disc about (0.5, 0): (-0.5, 0)
    program = boxed(quadratic(np.eye(2), [0.0, 0.0]), 10.0, 2, local=(outside([0.5, 0.0]),))
    outcome = solved(program, [-2.0, 1.0])
    np.testing.assert_allclose(outcome.x, [-0.5, 0.0], atol=1e-5)


def test_a_cost_that_is_not_convex():
    # x^4/4 - x^2/2 + x/10 + y^2/2: from x = 0.1, where it is concave, down to the well
    cost = Function(
        lambda x: x[0] ** 4 / 4 - x[0] ** 2 / 2 + x[0] / 10 + x[1] ** 2 / 2,
        lambda x: np.array([x[0] ** 3 - x[0] + 0.1, x[1]]),
        lambda x: np.diag([3.0 * x[0] ** 2, 1.0]),
        lambda x: np.diag([-1.0, 0.0]),
    )
    roots = np.roots([1.0, 0.0, -1.0, 0.1]).real
    outcome = solved(boxed(cost, 2.0, 2), [0.05, 0.9])
    assert outcome.x[1] == pytest.approx(0.0, abs=1e-5)
    assert np.min(np.abs(roots[[np.argmin(roots), np.argmax(roots)]] - outcome.x[0])) < 1e-5


def test_a_curved_budget_is_followed():
    # Rosenbrock's valley cut by a disc, against SciPy
    cost = Function(
        lambda x: (1 - x[0]) ** 2 + 100 * (x[1] - x[0] ** 2) ** 2,
        lambda x: np.array(
            [-2 * (1 - x[0]) - 400 * x[0] * (x[1] - x[0] ** 2), 200 * (x[1] - x[0] ** 2)]
        ),
        lambda x: np.array([[2 + 800 * x[0] ** 2, -400 * x[0]], [-400 * x[0], 200.0]]),
        lambda x: np.diag([-400 * (x[1] - x[0] ** 2), 0.0]),
    )
    budget = disc(np.zeros(2))
    outcome = solved(boxed(cost, 5.0, 2, budgets=(budget,)), [-0.5, 0.2])
    expected = scipy_minimize(
        cost.value,
        [0.5, 0.2],
        jac=cost.gradient,
        constraints={"type": "ineq", "fun": lambda x: 1.0 - budget.value(x)},
        method="SLSQP",
        options={"ftol": 1e-14},
    )
    np.testing.assert_allclose(outcome.x, expected.x, atol=1e-5)


@pytest.mark.parametrize("start", [[1.5, 0.0], [0.0, 0.9], [0.0, -0.9]], ids=["row", "g", "h"])
def test_a_start_that_is_not_inside_is_refused(start):
    program = boxed(
        quadratic(np.eye(2), [0.0, 0.0]),
        1.0,
        2,
        budgets=(disc([0.0, -2.0], 2.5),),
        local=(disc([0.0, 2.0], 2.5),),
    )
    minimise(program, np.zeros(2))
    with pytest.raises(ValueError, match="not strictly inside"):
        minimise(program, np.array(start))


def test_the_limit_on_iterations():
    program = boxed(quadratic(np.eye(2), [-3.0, 1.0]), 1.0, 2)
    outcome = minimise(program, np.zeros(2), Options(max_iterations=2))
    assert outcome.status == "iteration-limit"
    assert len(outcome.steps) == 3  # the start and two steps
    assert np.all(np.abs(outcome.x) < 1.0)
    full = minimise(program, np.zeros(2), Options())
    assert full.status == "converged"
    np.testing.assert_array_equal(full.steps[2].cost, outcome.values.cost)


def test_halfway_there_is_room_for_a_smaller_budget():
    c = np.array([3.0, -4.0])
    linear = quadratic(np.zeros((2, 2)), -c)
    large, small = (boxed(linear, 10.0, 2, budgets=(disc([0, 0], r),)) for r in (0.7, 0.6999))
    outcome = solved(large, [0.1, 0.0])
    assert small.values(outcome.x).budgets[0] > 1.0
    assert small.values(outcome.halfway).budgets[0] < 1.0
    (step,) = [s for s in outcome.steps if s.cost == large.cost.value(outcome.halfway)]
    assert step.gap <= 1e-2 < outcome.steps[step.number - 1].gap
    again = minimise(small, outcome.halfway, Options(start_gap=1e-2, gap=1e-8, tolerance=1e-8))
    np.testing.assert_allclose(again.x, 0.6999 * c / 5.0, atol=1e-6)
    assert len(again.steps) < len(outcome.steps)


def test_a_gradient_that_is_not_one_is_told():
    wrong = quadratic(np.eye(2), [0.5, 0.5])
    wrong.gradient = lambda x: -(x + 0.5)  # up, not down
    outcome = minimise(boxed(wrong, 1.0, 2), np.array([0.3, 0.1]))
    assert outcome.status == "stalled"
    assert np.all(np.abs(outcome.x) < 1.0)


def test_each_step_is_told_as_it_is_made():
    told = []
    program = boxed(quadratic(np.eye(2), [-3.0, 1.0]), 1.0, 2)
    outcome = minimise(program, np.zeros(2), on_step=told.append)
    assert tuple(told) == outcome.steps
    assert [step.number for step in told] == list(range(len(told)))
    assert told[0].cost == 0.0
    assert [step.cost for step in told] == [program.cost.value(x) for x in program.iterates]
    assert 0.0 < min(step.length for step in told[1:]) <= max(s.length for s in told[1:]) <= 1.0


def test_ended_early():
    program = boxed(quadratic(np.zeros((2, 2)), [-1.0, 0.0]), 9.0, 2, budgets=(disc([0, 0]),))
    outcome = minimise(
        program, np.array([-0.5, 0.0]), Options(stop_early=lambda budgets: budgets[0] > 0.3)
    )
    assert outcome.status == "converged"
    assert 0.3 < outcome.values.budgets[0] < 1.0
    values = [program.values(x).budgets[0] for x in program.iterates[1:-1]]
    assert all(value <= 0.3 for value in values)


def test_nothing_binds_and_nothing_bounds():
    program = Dense(quadratic(2.0 * np.eye(3), [1.0, 2.0, 3.0]), np.zeros((0, 3)), np.zeros(0))
    outcome = minimise(program, np.ones(3))
    assert outcome.status == "converged"
    np.testing.assert_allclose(outcome.x, [-0.5, -1.0, -1.5], atol=1e-6)


def test_a_search_that_has_come_to_rest_ends():
    # of terms of a million that cancel, a gradient has a rounding of 1e-10 and no less
    c, big = np.array([3.0, -4.0]), 1e6
    smooth = quadratic(np.eye(2), -c)
    rounded = Function(
        smooth.value,
        lambda x: (smooth.gradient(x) + big * np.array([1.0, -1.0])) - big * np.array([1.0, -1.0]),
        smooth.hessian,
    )
    program = boxed(rounded, 10.0, 2, budgets=(disc(np.zeros(2), 0.7),))
    start = np.array([0.1, 0.0])
    floor = minimise(program, start, Options(tolerance=1e-30, max_iterations=80)).steps
    least = min(step.optimality for step in floor[-40:])
    assert least > 0.0
    ended = minimise(program, start, Options(tolerance=least / 3.0, max_iterations=400))
    assert ended.status == "converged"
    assert len(ended.steps) < 200
    far = minimise(program, start, Options(tolerance=least / 1000.0, max_iterations=80))
    assert far.status != "converged"
