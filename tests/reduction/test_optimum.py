"""The optimum: the study's references, and what must hold for any maneuver."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from des_cli.model.machines import DES
from des_cli.reduction.baseline import joint_deviation, weighted_energy
from des_cli.reduction.executable import nearest_executable
from des_cli.reduction.limits import find_violations
from des_cli.reduction.study_law import sweep

pytestmark = pytest.mark.slow

RATES = st.lists(st.lists(st.floats(-1.5, 1.5), min_size=3, max_size=3), min_size=3, max_size=3)


def reduction_of(problem, solution):
    return 1.0 - weighted_energy(problem, solution.modified) / weighted_energy(
        problem, problem.desired
    )


@pytest.mark.parametrize(
    ("r2", "cost", "reduction", "squared"),
    [
        (8.0, 0.448408, 0.2951, 0.0016),
        (1.0, 0.2590558, 0.6889, 0.0163),
        (0.2, 0.139105, 0.8486, 0.041),
    ],
)
def test_the_cobra_by_a_scalar(cobra, pose, solve_problem, r2, cost, reduction, squared):
    # An earlier check's values, the limit of an ever finer grid.
    problem = pose(cobra(1000), r2)
    solution = solve_problem(problem)
    assert solution.status == "converged"
    assert solution.cost == pytest.approx(cost, abs=1e-6)
    assert reduction_of(problem, solution) == pytest.approx(reduction, abs=1e-4)
    deviation = joint_deviation(problem.desired, solution.modified)
    assert deviation**2 == pytest.approx(squared, rel=0.02)
    assert solution.cost_unreduced == pytest.approx(0.5384709, abs=1e-6)
    assert solution.optimality < 1e-9


@pytest.mark.parametrize(
    ("r2", "cost", "reduction"),
    [(8.0, 2.618676, 0.543), (1.0, 1.028142, 0.899), (0.2, 0.374635, 0.968)],
)
def test_table_3_by_a_scalar(cobra, pose, solve_problem, r2, cost, reduction):
    # References of an earlier check, by the midpoint rule at 400 samples: IPOPT finds
    # them again with that rule, and these costs with the trapezoidal one.
    problem = pose(cobra(400, table3=True), r2)
    solution = solve_problem(problem)
    assert solution.converged
    assert solution.cost == pytest.approx(cost, rel=3e-4)
    assert reduction_of(problem, solution) == pytest.approx(reduction, abs=1e-3)


def test_a_small_weight_is_not_caught_in_a_local_minimum(cobra, pose, solve_problem):
    # Minima of 1.24 and 1.937 stand in the way; 0.1225 exists.
    solution = solve_problem(pose(cobra(400, table3=True), 0.05))
    assert solution.converged
    assert solution.cost == pytest.approx(0.1225, abs=1e-4)


def test_the_cobra_per_joint(cobra, pose, solve_problem):
    problem = pose(cobra(500), 1.0, control="per-joint")
    solution = solve_problem(problem)
    assert solution.control.shape == (501, 3)
    assert solution.cost == pytest.approx(0.214397, abs=1e-5)
    assert reduction_of(problem, solution) == pytest.approx(0.7447, abs=1e-4)


def test_a_component_is_bought_with_others(cobra, pose, solve_problem):
    # The scalar optimum at r2 = 1 takes 45.8 percent off the whole vector.
    problem = pose(cobra(1000), 1.0)
    solution = solve_problem(problem)
    whole = pose(cobra(1000), 1.0, r1=(1, 1, 1))
    assert reduction_of(whole, solution) == pytest.approx(0.458, abs=1e-3)


def test_seat_axes_do_not_know_the_azimuth(cobra, pose, solve_problem):
    costs = [
        solve_problem(pose(cobra(300, azimuth=np.radians(turn)), 1.0, axes="seat")).cost
        for turn in (0.0, 37.0, 180.0)
    ]
    assert np.ptp(costs) < 1e-8
    assert costs[0] == pytest.approx(0.112630, abs=2e-6)


def test_report_axes_do(cobra, pose, solve_problem):
    cost = solve_problem(pose(cobra(400, azimuth=np.radians(37.0)), 1.0)).cost
    assert cost == pytest.approx(0.347890, abs=2e-6)


@pytest.mark.parametrize("axes", ["report", "seat"])
@settings(max_examples=12)
@given(amplitude=RATES, r2=st.floats(0.05, 5.0))
def test_never_worse_than_what_it_starts_from(wave, pose, solve_problem, axes, amplitude, r2):
    scalar = pose(wave(amplitude), r2, axes=axes, r1=(0, 2, 0))
    solution = solve_problem(scalar)
    joints = solve_problem(pose(wave(amplitude), r2, axes=axes, r1=(0, 2, 0), control="per-joint"))
    assert solution.converged
    assert joints.converged
    assert solution.cost <= solution.cost_unreduced * (1.0 + 1e-12)
    assert solution.cost <= sweep(scalar).cost * (1.0 + 1e-9)
    assert joints.cost <= solution.cost * (1.0 + 1e-9) + 1e-15


@settings(max_examples=8)
@given(amplitude=RATES, r2=st.floats(0.02, 1.0), tracking=st.sampled_from([0.0, 0.3]))
def test_inside_the_limits_for_any_maneuver(wave, pose, solve_problem, amplitude, r2, tracking):
    motion, _ = nearest_executable(DES, wave(amplitude))
    problem = pose(
        motion,
        r2,
        control="per-joint",
        axes="seat",
        r1=(2, 2, 2),
        tracking=tracking,
        machine=DES,
    )
    solution = solve_problem(problem)
    assert solution.converged
    assert find_violations(DES, solution.modified, "modified") == ()
    assert solution.cost <= solution.cost_unreduced * (1.0 + 1e-9)


def test_no_coriolis_no_change(wave, pose, solve_problem):
    # Only the arm turns.
    solution = solve_problem(pose(wave([[0.5, 0.2], [0.0, 0.0], [0.0, 0.0]]), 1.0, axes="seat"))
    assert solution.converged
    np.testing.assert_allclose(solution.control, 1.0, atol=1e-9)
    assert solution.cost == pytest.approx(0.0, abs=1e-15)


def test_a_joint_that_is_held_keeps_its_motion(cobra, pose, solve_problem):
    problem = pose(
        cobra(200), 1.0, control="per-joint", held=np.array([True, False, False]), axes="seat"
    )
    solution = solve_problem(problem)
    assert solution.converged
    np.testing.assert_array_equal(solution.control[:, 0], 1.0)
    np.testing.assert_allclose(
        solution.modified.angle[:, 0], problem.desired.angle[:, 0], rtol=0, atol=1e-9
    )
    free = solve_problem(pose(cobra(200), 1.0, control="per-joint", axes="seat"))
    assert free.cost < solution.cost < solution.cost_unreduced


@pytest.mark.parametrize("ends", ["match-start", "match-both"])
def test_ends_that_match(cobra, pose, solve_problem, ends):
    problem = pose(cobra(200), 1.0, control="per-joint", axes="seat", ends=ends)
    solution = solve_problem(problem)
    assert solution.converged
    np.testing.assert_array_equal(solution.control[0], 1.0)
    made, wanted = solution.modified, problem.desired
    gap = np.abs(made.angle[-1] - wanted.angle[-1])
    if ends == "match-both":
        np.testing.assert_array_equal(solution.control[-1], 1.0)
        np.testing.assert_allclose(gap, 0.0, atol=1e-9)
    else:
        assert gap.max() > 1e-3


class TestStatuses:
    def test_too_few_steps(self, cobra, pose, solve_problem):
        solution = solve_problem(pose(cobra(200), 0.2), 2)
        assert solution.status == "iteration-limit"
        assert not solution.converged
        assert "max_iterations" in solution.message
        assert "(2)" in solution.message

    def test_the_log_is_one(self, cobra, pose, solve_problem):
        heard = []
        solution = solve_problem(pose(cobra(200), 1.0), report=heard.append)
        assert tuple(heard) == solution.log
        assert [line.number for line in solution.log] == list(range(len(solution.log)))
        assert solution.iterations == len(solution.log)

    def test_the_message_is_a_sentence(self, cobra, pose, solve_problem):
        message = solve_problem(pose(cobra(200), 1.0)).message
        assert "\n" not in message
        assert "optimal" in message

    def test_the_same_input_gives_the_same_bits(self, cobra, pose, solve_problem):
        first, second = (solve_problem(pose(cobra(200), 1.0)) for _ in range(2))
        np.testing.assert_array_equal(first.control, second.control)
        assert first.cost == second.cost
