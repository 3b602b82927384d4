"""The study's single sweep: its figures, and the same law integrated by others."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from des_cli.reduction.baseline import joint_deviation, weighted_energy
from des_cli.reduction.study_law import sweep
from tests.support.cobra import cobra

RPM = 2.0 * np.pi / 60.0


def desired(t, late):
    """Angles and rates of (34)-(37), before or after the segments join at 5 s, (3, ...)."""
    angle, rate, _ = cobra(t, late=late)
    return angle.T, rate.T


def bb3(theta, rate):
    """BB3 of (23) and its derivatives in theta1 and theta2, written out by hand."""
    (s1, s2), (c1, c2) = np.sin(theta[:2]), np.cos(theta[:2])
    d1, d2, d3 = rate
    value = -d2 * d1 * c1 + d3 * d1 * s1 * c2 + d3 * d2 * c1 * s2
    slope = [
        d2 * d1 * s1 + d3 * d1 * c1 * c2 - d3 * d2 * s1 * s2,
        -d3 * d1 * s1 * s2 + d3 * d2 * c1 * c2,
        0.0 * value,
    ]
    return value, np.array(slope)


def by_integrator(r1, r2):
    """(42)-(47) by adaptive integrators: reduction, squared deviation, and p at 0 s and 2 s."""
    options = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13, "dense_output": True}
    adjoint, final = {}, np.zeros(3)
    for late, span in ((True, (10.0, 5.0)), (False, (5.0, 0.0))):

        def backward(t, _, late=late):
            value, slope = bb3(*desired(t, late))
            return -r1 * value * slope

        found = solve_ivp(backward, span, final, **options)
        adjoint[late], final = found.sol, found.y[:, -1]

    def factor(t, late):
        return 1.0 - adjoint[late](t) @ desired(t, late)[1] / r2

    state = np.append(desired(0.0, False)[0], np.zeros(4))
    for late, span in ((False, (0.0, 5.0)), (True, (5.0, 10.0))):

        def forward(t, y, late=late):
            theta, rate = desired(t, late)
            p = factor(t, late)
            before, after = bb3(theta, rate)[0], bb3(y[:3], p * rate)[0]
            off = y[:3] - theta
            return np.append(p * rate, [before**2, after**2, off @ off, theta @ theta])

        state = solve_ivp(forward, span, state, **options).y[:, -1]
    before, after, off, size = state[3:]
    return 1.0 - after / before, off / size, factor(0.0, False), factor(2.0, False)


def by_euler(h, r1, r2):
    """The same by forward Euler throughout, as a short program of the time would do it."""
    t = np.linspace(0.0, 10.0, round(10.0 / h) + 1)
    wanted, rate = desired(t, t >= 5.0)
    wanted[0] = np.concatenate([[0.0], np.cumsum(h * rate[0, :-1])])
    value, slope = bb3(wanted, rate)
    fall = h * r1 * (value * slope)[:, :-1]
    adjoint = np.zeros_like(wanted)
    adjoint[:, :-1] = np.cumsum(fall[:, ::-1], axis=1)[:, ::-1]
    p = 1.0 - np.sum(adjoint * rate, axis=0) / r2
    theta = wanted.copy()
    theta[:, 1:] = wanted[:, :1] + np.cumsum(h * p[:-1] * rate[:, :-1], axis=1)
    return 1.0 - np.sum(bb3(theta, p * rate)[0] ** 2) / np.sum(value**2)


def reduction_of(problem, solution):
    before, after = (
        weighted_energy(problem, motion) for motion in (problem.desired, solution.modified)
    )
    return 1.0 - after / before


@pytest.mark.parametrize(("r2", "reduction"), [(8.0, 0.1352), (1.0, 0.6392), (0.2, 0.1119)])
def test_reductions_of_the_cobra(cobra, pose, r2, reduction):
    # Found by an independent check of the study on a fine grid.
    problem = pose(cobra(1000), r2)
    solution = sweep(problem)
    assert solution.converged
    assert reduction_of(problem, solution) == pytest.approx(reduction, abs=4e-4)


def test_the_studys_best_weight_is_the_middle_one(cobra, pose):
    reductions = [
        reduction_of(problem, sweep(problem))
        for problem in (pose(cobra(400), r) for r in (8, 1, 0.2))
    ]
    assert np.argmax(reductions) == 1


def test_squared_deviation_and_factor(cobra, pose):
    problem = pose(cobra(1000), 1.0)
    solution = sweep(problem)
    assert joint_deviation(problem.desired, solution.modified) ** 2 == pytest.approx(
        0.057, abs=1e-3
    )
    assert np.mean((1.0 - solution.control) ** 2) == pytest.approx(0.044, abs=5e-4)


def test_range_of_the_factor_at_the_smallest_weight(cobra, pose):
    control = sweep(pose(cobra(1000), 0.2)).control
    assert control.min() == pytest.approx(-0.89, abs=0.01)
    assert control.max() == pytest.approx(1.28, abs=0.01)


@pytest.mark.parametrize("r2", [8.0, 1.0])
def test_against_adaptive_integrators(cobra, pose, r2):
    problem = pose(cobra(1000), r2)
    solution = sweep(problem)
    reduction, squared, at_start, at_two = by_integrator(2.0, r2)
    assert reduction_of(problem, solution) == pytest.approx(reduction, abs=1e-5)
    deviation = joint_deviation(problem.desired, solution.modified)
    assert deviation**2 == pytest.approx(squared, rel=1e-4)
    assert solution.control[0, 0] == pytest.approx(at_start, abs=1e-6)
    assert solution.control[200, 0] == pytest.approx(at_two, abs=1e-5)


def test_forward_euler_prints_what_the_study_printed(cobra, pose):
    # 65.4 percent: the study's figure is the sweep at a quarter of a second.
    assert by_euler(0.25, 2.0, 1.0) == pytest.approx(0.654, abs=5e-4)
    problem = pose(cobra(1000), 1.0)
    assert by_euler(1e-3, 2.0, 1.0) == pytest.approx(
        reduction_of(problem, sweep(problem)), abs=1e-4
    )


def test_it_is_not_the_optimum(cobra, pose):
    solution = sweep(pose(cobra(400), 1.0))
    assert solution.optimality > 0.1
    assert solution.cost_unreduced == pytest.approx(0.538471, abs=1e-5)
    assert solution.cost > 0.4  # the optimum is 0.2591
    np.testing.assert_array_equal(solution.adjoint[-1], 0.0)


def test_per_joint_moves_each_joint_by_its_own_power(cobra, pose):
    problem = pose(cobra(200), 1.0, control="per-joint")
    solution = sweep(problem)
    power = solution.adjoint[40] * problem.desired.rate_start[40]
    np.testing.assert_allclose(solution.control[40], 1.0 - power / problem.r2, atol=1e-12)


def test_more_sweeps_need_not_converge(cobra, pose):
    problem = pose(cobra(200), 1.0)
    several = sweep(problem, 4)
    assert several.iterations == len(several.log) == 4
    assert [line.number for line in several.log] == [1, 2, 3, 4]
    assert "4 sweeps" in several.message
    assert several.log[0].cost == pytest.approx(sweep(problem).cost, rel=1e-14)


def test_leaving_the_finite_numbers_is_a_status(cobra, pose):
    with np.errstate(all="ignore"):
        solution = sweep(pose(cobra(50, table3=True), 1e-80), 6)
    assert solution.status == "diverged"
    assert not solution.converged
