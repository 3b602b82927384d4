"""A free motion: times, limits, ends and held joints, each broken by itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.model.profile import Reduction
from des_cli.verify.claim import Claim
from des_cli.verify.verify import verify
from tests.reduction.conftest import make_cobra
from tests.support.claims import profile_of
from tests.support.free_case import SPENT, Case, with_rates


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_a_spike_of_jerk_at_one_sample(case, joint):
    limit = DES.limits[joint].jerk
    spike = 0.6 * limit * case.requested.step[0] ** 2  # its second difference is 1.2 times it
    at = np.argmin(np.abs(case.solution.modified.jerk[:, joint])) + 1
    name = ("arm", "fork", "cab")[joint]
    failed = case.failed(case.moved((at, joint, spike)))
    assert f"limits.{name}.jerk" in failed
    assert failed <= {f"limits.{name}.jerk", "optimality", *SPENT}


@pytest.mark.parametrize(
    ("quantity", "share"), [("acceleration", 0.9), ("jerk", 0.999), ("rate", 0.9), ("angle", 0.9)]
)
def test_limits_that_are_smaller(case, quantity, share):
    motion = case.solution.modified
    peak = float(np.max(np.abs(getattr(motion, quantity)[:, 1])))
    limits = list(DES.limits)
    for factor, broken in ((1.0 + 1e-5, False), (share, True), (1.0 - 1e-5, True)):
        limits[1] = replace(DES.limits[1], **{quantity: factor * peak})
        failed = case.failed(machine=replace(DES, limits=tuple(limits)))
        assert (f"limits.fork.{quantity}" in failed) is broken
        assert failed <= {f"limits.fork.{quantity}"}


def test_a_motion_that_is_passed_through_keeps_its_angles(case):
    # its positions are more than the integrals of its rates
    passed = replace(case.solution, modified=case.requested)
    assert "dynamics.angles" not in case.failed(passed)
    angle = case.requested.angle.copy()
    angle[-1, 2] += 1e-9
    other = replace(case.solution, modified=replace(case.requested, angle=angle))
    assert "dynamics.angles" in case.failed(other)


def test_an_angle_that_is_exceeded_only_between_two_samples(case):
    # the fork turns back half-way between two samples: the parabola's top is between them
    t = np.arange(0.0, 1.01, 0.1)
    rate = np.zeros((11, 3))
    rate[:, 1] = 0.45 - t
    motion = with_rates(t, np.zeros(3), rate)
    top = 0.5 * 0.45**2
    assert motion.angle[:, 1].max() == pytest.approx(top - 0.5 * 0.05**2)
    reduction = Reduction(ends="free", budget=())
    for factor, broken in ((1.0 + 1e-6, False), (1.0 - 1e-6, True)):
        fork = replace(DES.limits[1], angle=factor * top)
        machine = replace(DES, limits=(DES.limits[0], fork, DES.limits[2]))
        profile = profile_of(motion, reduction, machine)
        solution = replace(
            case.solution, modified=motion, control=np.zeros((11, 0)), adjoint=np.zeros((11, 0))
        )
        checks = verify(Claim(profile, motion, motion, profile.seat, solution))
        assert ("limits.fork.angle" in {c.key for c in checks if not c.ok}) is broken


def test_a_step_of_a_rate(case):
    motion = case.solution.modified
    start = motion.rate_start.copy()
    start[100:, 2] += 1e-8
    end = motion.rate_end.copy()
    end[100:, 2] += 1e-8
    rise = np.cumsum(0.5 * motion.step[:, None] * (start + end), axis=0)
    angle = motion.angle[0] + np.vstack([np.zeros(3), rise])
    stepped = case.played(Motion(motion.t, angle, start, end))
    assert case.failed(stepped) - SPENT == {"limits.cab.rate_step"}
    assert case.failed(stepped, limits="check") <= SPENT


@pytest.mark.parametrize("joint", [0, 1, 2])
def test_an_angle_that_is_not_the_integral(case, joint):
    angle = case.solution.modified.angle.copy()
    angle[120:, joint] += 1e-9
    broken = case.played(replace(case.solution.modified, angle=angle))
    assert case.failed(broken) - SPENT == {"dynamics.angles"}


def test_a_start_that_is_off(case):
    assert case.failed(case.moved(start=(0.0, 0.0, 1e-8))) - SPENT == {"start.angle"}
    gentle = [(k, 2, -2e-9 * (1.0 - k / 50)) for k in range(50)]
    assert case.failed(case.moved(*gentle)) - SPENT == {"start.rate"}
    assert case.failed(case.moved(*gentle), ends="free") <= {"optimality", *SPENT}


def test_a_start_that_is_free_may_be_off():
    case = Case(ends="free", optimise=("cab_start",))
    start = case.solution.modified.angle[0] - case.requested.angle[0]
    assert abs(start[2]) > 0.01
    assert case.failed() == set()
    assert "start.angle" in case.failed(optimise=())
    assert "start.angle" in case.failed(case.moved(start=(0.0, 1e-8, 0.0)))


def test_an_end_that_is_off():
    case = Case(ends="match-both")
    n = len(case.requested.t)
    late = [(n - 1 - k, 1, 2e-9 * (1.0 - k / 40)) for k in range(40)]
    assert case.failed(case.moved(*late)) - SPENT == {"ends.rate"}
    bump = [(100 + k, 1, 1e-3 * np.sin(np.pi * k / 100) ** 2) for k in range(101)]
    assert "ends.angle" in case.failed(case.moved(*bump))
    assert "ends.angle" not in case.failed(case.moved(*bump), ends="match-rates")


def test_the_end_of_a_finer_table_is_held_to_more():
    # a table ends off the smooth motion by the order of the step squared, and no more
    tolerance = {}
    for intervals in (100, 400):
        case = Case(ends="match-both", requested=make_cobra(intervals))
        (check,) = [c for c in case.checks() if c.key == "ends.angle"]
        assert check.ok
        tolerance[intervals] = check.tolerance
    assert tolerance[400] < tolerance[100] / 8.0


def test_a_joint_that_is_held_but_moves():
    case = Case(hold=frozenset({"cab"}))
    bump = [(100 + k, 2, 1e-7 * np.sin(2.0 * np.pi * k / 60)) for k in range(61)]
    assert "hold" in case.failed(case.moved(*bump))
    assert "hold" not in case.failed(case.moved(*[(k, 1, change) for k, _, change in bump]))


def test_factors_that_are_not_those_of_the_motion():
    case = Case(control="per-joint", ends="free")
    control = case.solution.control.copy()
    control[60, 0] += 1e-6
    assert case.failed(replace(case.solution, control=control)) == {"dynamics.rates"}
