"""Zero Coriolis: reached per joint, refused to a scalar with the reason."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.profile import Reduction
from des_cli.reduction.baseline import joint_deviation
from des_cli.reduction.executable import nearest_executable
from des_cli.reduction.limits import find_violations
from des_cli.reduction.search import Search
from des_cli.reduction.zero import find_zero, pose_zero
from des_cli.verify.factors import cross_of
from des_cli.verify.felt import SeatChain
from tests.support.claims import failed_of_factors

BB3 = np.array([False, True, False])


def largest(problem, motion, chosen):
    """The largest component that was to vanish, at samples, by the verification's way."""
    return np.abs(cross_of(problem, SeatChain(DES, Seat()).along(motion))[chosen]).max()


@pytest.fixture(scope="module")
def executable(cobra):
    return nearest_executable(DES, cobra(250))[0]


@pytest.mark.slow
@pytest.mark.parametrize("jerk", [False, True])
def test_one_component_per_joint_inside_the_limits(cobra, pose, table_1, jerk):
    machine = DES if jerk else table_1
    executable, _ = nearest_executable(machine, cobra(250))
    problem = pose_zero(pose(executable, 1.0, control="per-joint", r1=(0, 2, 0), machine=machine))
    solution = find_zero(problem, BB3, 1e-3, Search(3000))
    assert solution.converged
    assert largest(problem, solution.modified, BB3) <= 1e-3
    # An independent solution reached 1.8 % squared deviation without a limit on the jerk.
    deviation = joint_deviation(executable, solution.modified) ** 2
    assert (deviation > 0.0181) if jerk else (deviation == pytest.approx(0.018, abs=1e-4))
    assert find_violations(machine, solution.modified, "modified") == ()
    wanted = Reduction(method="zero", r1=np.diag([0, 2, 0]), axes="report", tolerance=1e-3)
    assert failed_of_factors(problem, solution, wanted) == []


def test_the_whole_vector_per_joint(executable, pose):
    problem = pose_zero(pose(executable, 1.0, control="per-joint", axes="seat", machine=DES))
    everything = np.ones(3, dtype=bool)
    solution = find_zero(problem, everything, 1e-3, Search(3000))
    assert solution.converged
    assert largest(problem, solution.modified, everything) <= 1e-3


def test_a_scalar_can_only_freeze_or_jump(executable, pose):
    problem = pose_zero(pose(executable, 1.0, control="scalar", r1=(0, 2, 0), machine=DES))
    solution = find_zero(problem, BB3, 1e-4, Search(3000))
    assert solution.status == "infeasible"
    assert "freeze the machine or jump between branches" in solution.message
    assert "smallest tolerance reached" in solution.message


def test_what_is_zero_already_stays(wave, pose):
    # Only the arm turns.
    motion, _ = nearest_executable(DES, wave([[0.5, 0.2], [0.0, 0.0], [0.0, 0.0]]))
    problem = pose_zero(pose(motion, 1.0, axes="seat", machine=DES))
    solution = find_zero(problem, np.ones(3, dtype=bool), 1e-4, Search(500))
    assert solution.converged
    np.testing.assert_allclose(solution.control, 1.0, atol=1e-6)


def test_without_a_tracking_weight_the_norm_of_the_study_is_taken(executable, pose):
    problem = pose(executable, 1.0, tracking=(0, 0, 0))
    np.testing.assert_array_equal(pose_zero(problem).tracking, np.ones(3))
    problem = pose(executable, 1.0, tracking=(0, 2, 0))
    np.testing.assert_array_equal(pose_zero(problem).tracking, [0, 2, 0])
