"""The discrete problem against the study's closed forms and complex steps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from des_cli.reduction.transcription import Transcription
from tests.support.cobra import cobra
from tests.support.differences import along

STEP = 1e-30
FULL = [[1.3, 0.2, -0.4], [0.2, 2.0, 0.3], [-0.4, 0.3, 0.9]]
WEIGHTS = {"component": (0.0, 2.0, 0.0), "vector": (2.0, 2.0, 2.0), "full": FULL}


def complex_gradient(function, x):
    """Gradient of a real function of an array, exact to rounding."""
    units = np.eye(x.size).reshape(x.size, *x.shape)
    return (function(x + 1j * STEP * units).imag / STEP).reshape(x.shape)


def hessian_of(function, x, step=1e-3):
    """Sixth-order differences of the complex-step gradient, (size, size)."""
    coefficients = {1: 3 / 4, 2: -3 / 20, 3: 1 / 60}
    rows = []
    for unit in np.eye(x.size).reshape(x.size, *x.shape):
        row = sum(
            weight
            * (
                complex_gradient(function, x + k * step * unit)
                - complex_gradient(function, x - k * step * unit)
            )
            for k, weight in coefficients.items()
        )
        rows.append(row.ravel() / step)
    return np.array(rows)


def exact_hessian(expansion):
    """The blocks (k, k); this cost couples no neighbours."""
    assert expansion.across is None
    return expansion.hessian + expansion.curvature


@pytest.fixture(params=["scalar", "per-joint"])
def control(request):
    return request.param


@pytest.fixture(params=["report", "seat"])
def axes(request):
    return request.param


@pytest.fixture(params=["desired", "adapted"])
def jacobian(request):
    return request.param


@pytest.fixture(params=list(WEIGHTS))
def problem(request, uneven, pose, control, axes, jacobian):
    return pose(
        uneven,
        (0.5, 1.1, 1.7),
        control=control,
        axes=axes,
        r1=WEIGHTS[request.param],
        tracking=(0.3, 0.7, 1.9),
        jacobian=jacobian,
    )


@pytest.fixture
def anywhere(problem):
    """An iterate that does not keep the dynamics."""
    rng = np.random.default_rng(3)
    around = np.hstack([problem.desired.angle, np.ones((9, problem.controls))])
    x = around + 0.25 * rng.normal(size=around.shape)
    assert np.abs(np.cos(x[:, 1])).min() > 0.4  # where nothing is damped
    return x


def test_cost_is_its_definition(problem, anywhere, closed_cost):
    cost = Transcription(problem).cost(anywhere)
    assert cost == pytest.approx(closed_cost(problem, anywhere), rel=1e-13)


def test_gradient(problem, anywhere, closed_cost):
    expansion = Transcription(problem).expand(anywhere)
    expected = complex_gradient(lambda x: closed_cost(problem, x), anywhere)
    np.testing.assert_allclose(expansion.gradient, expected, rtol=1e-11, atol=1e-13)
    assert expansion.cost == pytest.approx(closed_cost(problem, anywhere), rel=1e-13)


def test_hessian_is_block_diagonal_and_exact(problem, anywhere, closed_cost):
    expansion = Transcription(problem).expand(anywhere)
    assert np.linalg.eigvalsh(expansion.hessian).min() > -1e-12  # that of Gauss and Newton
    blocks = exact_hessian(expansion)
    expected = hessian_of(lambda x: closed_cost(problem, x), anywhere)
    n, width = anywhere.shape
    dense = np.zeros((n, width, n, width))
    dense[np.arange(n), :, np.arange(n), :] = blocks
    np.testing.assert_allclose(dense.reshape(n * width, -1), expected, rtol=1e-9, atol=1e-9)


def test_gradient_alone(problem, anywhere):
    grid = Transcription(problem)
    np.testing.assert_allclose(grid.gradient(anywhere), grid.expand(anywhere).gradient, atol=1e-14)


def test_defect_is_the_trapezoid_of_the_rates(problem, anywhere, closed_rates):
    grid, desired = Transcription(problem), problem.desired
    before, after = (
        closed_rates(problem, anywhere[at, :3], anywhere[at, 3:], at, rate)
        for at, rate in ((slice(None, -1), desired.rate_start), (slice(1, None), desired.rate_end))
    )
    half = 0.5 * desired.step[:, None]
    missed = np.diff(desired.angle, axis=0) - half * (desired.rate_start + desired.rate_end)
    missed[:, 0] = 0.0
    factor = 0.5 * (anywhere[:-1, 3:] + anywhere[1:, 3:])
    expected = np.diff(anywhere[:, :3], axis=0) - half * (before + after) - factor * missed
    np.testing.assert_allclose(grid.defect(anywhere), expected, rtol=0, atol=1e-13)
    made = grid.motion(anywhere)
    np.testing.assert_allclose(made.rate_start, before, rtol=0, atol=1e-12)
    np.testing.assert_allclose(made.rate_end, after, rtol=0, atol=1e-12)


def test_defect_derivatives(problem, anywhere):
    grid = Transcription(problem)
    rng = np.random.default_rng(9)
    move, multiplier = rng.normal(size=anywhere.shape), rng.normal(size=(8, 3))

    def pull_back(x):
        """The gradient of multiplier' defect."""
        left, ahead = grid.defect_jacobian(x)
        force = np.zeros_like(x)
        force[:-1] += (multiplier[:, None, :] @ left)[:, 0]
        force[1:] += (multiplier[:, None, :] @ ahead)[:, 0]
        return force

    left, ahead = grid.defect_jacobian(anywhere)
    change = (left @ move[:-1, :, None] + ahead @ move[1:, :, None])[:, :, 0]
    np.testing.assert_allclose(along(grid.defect, anywhere, move), change, rtol=0, atol=1e-9)
    curvature = grid.defect_curvature(anywhere, multiplier)
    expected = 0.0 if curvature is None else (curvature @ move[:, :, None])[:, :, 0]
    np.testing.assert_allclose(
        along(pull_back, anywhere, move), expected + 0.0 * move, rtol=0, atol=1e-8
    )


class TestDesiredJacobian:
    @pytest.fixture
    def jacobian(self):
        return "desired"

    def test_follow_integrates_the_factors(self, problem, closed_motion):
        grid = Transcription(problem)
        u = np.random.default_rng(8).uniform(-0.5, 1.5, (9, problem.controls))
        x = grid.follow(u)
        np.testing.assert_allclose(x, closed_motion(problem, u), rtol=0, atol=1e-14)
        np.testing.assert_allclose(grid.defect(x), 0.0, atol=1e-15)

    def test_reduced_gradient(self, problem, closed_cost, closed_motion):
        grid = Transcription(problem)
        u = np.random.default_rng(10).uniform(0.2, 1.4, (9, problem.controls))
        expected = complex_gradient(lambda v: closed_cost(problem, closed_motion(problem, v)), u)
        found = grid.reduced_gradient(grid.follow(u))
        np.testing.assert_allclose(found, expected, rtol=1e-11, atol=1e-12)


def test_unit_factors_return_the_desired_motion(uneven, pose, control, jacobian):
    grid = Transcription(pose(uneven, control=control, jacobian=jacobian))
    np.testing.assert_array_equal(grid.desired[:, 3:], 1.0)
    np.testing.assert_allclose(grid.defect(grid.desired), 0.0, atol=1e-15)
    made = grid.motion(grid.desired)
    np.testing.assert_allclose(made.angle, uneven.angle, rtol=0, atol=2e-15)
    np.testing.assert_allclose(made.rate_sides, uneven.rate_sides, rtol=0, atol=1e-14)


def test_the_arm_follows_its_velocity_table_whatever_its_angles_say(uneven, pose):
    angle = uneven.angle.copy()
    angle[:, 0] += np.linspace(0.0, 0.1, 9)
    grid = Transcription(pose(replace(uneven, angle=angle)))
    made = grid.motion(grid.follow(np.ones((9, 1))))
    np.testing.assert_allclose(made.angle[:, 0], uneven.angle[:, 0], atol=1e-14)


@pytest.mark.parametrize("depth", [0.0, 0.03, 0.08, 0.12])
def test_derivatives_across_the_singularity(uneven, pose, depth):
    # There phi is damped, and no closed form holds: differences of the cost itself.
    angle = uneven.angle.copy()
    angle[:, 1] = np.pi / 2 + depth
    problem = pose(
        replace(uneven, angle=angle), control="per-joint", r1=(2, 2, 2), jacobian="adapted"
    )
    grid = Transcription(problem)
    rng = np.random.default_rng(12)
    x = grid.desired + 0.01 * rng.normal(size=grid.desired.shape)
    expansion = grid.expand(x)
    for _ in range(5):
        move, h = rng.normal(size=x.shape), 1e-5
        slope = (grid.cost(x + h * move) - grid.cost(x - h * move)) / (2.0 * h)
        assert np.sum(expansion.gradient * move) == pytest.approx(slope, rel=1e-5, abs=1e-6)
        second = (grid.gradient(x + h * move) - grid.gradient(x - h * move)) / (2.0 * h)
        found = (exact_hessian(expansion) @ move[:, :, None])[:, :, 0]
        np.testing.assert_allclose(found, second, rtol=1e-4, atol=1e-4 * np.abs(second).max())


def test_what_is_pinned(uneven, pose):
    def pinned(**further):
        return Transcription(pose(uneven, control="per-joint", **further)).pinned

    start = np.zeros((9, 6), dtype=bool)
    start[0, :3] = True
    np.testing.assert_array_equal(pinned(), start)
    held = start.copy()
    held[:, 4] = True
    np.testing.assert_array_equal(pinned(held=np.array([False, True, False])), held)
    both = start.copy()
    both[[0, -1]] = True
    np.testing.assert_array_equal(pinned(ends="match-both"), both)
    first = start.copy()
    first[0] = True
    np.testing.assert_array_equal(pinned(ends="match-start"), first)


def bb3_squared(t):
    """BB3^2 of the Cobra, (23) with (34)-(37) and the arm's angle in closed form."""
    (theta1, theta2, _), (arm, fork, cab), _ = cobra(t)
    sloping = (
        cab * np.sin(theta1) * np.cos(theta2) * arm + cab * np.cos(theta1) * np.sin(theta2) * fork
    )
    return (sloping - fork * arm * np.cos(theta1)) ** 2


def test_cost_of_the_cobra_as_desired(cobra, pose, control):
    # At p = 1 the cost is the integral of BB3^2, r1 = 2; an earlier check gave 0.538436.
    exact = quad(bb3_squared, 0.0, 5.0)[0] + quad(bb3_squared, 5.0, 10.0)[0]
    assert exact == pytest.approx(0.538436, abs=5e-5)
    for intervals, tolerance in ((250, 1e-6), (1000, 6e-8)):
        grid = Transcription(pose(cobra(intervals), 1.0, control=control))
        cost = grid.cost(grid.desired)
        assert cost == pytest.approx(exact, abs=tolerance)


def test_weights_sum_to_the_duration(problem):
    duration = problem.desired.t[-1] - problem.desired.t[0]
    assert Transcription(problem).weight.sum() == pytest.approx(duration, rel=1e-14)
