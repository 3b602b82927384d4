"""A free motion's program: every derivative of it by finite differences."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.twist import SeatForms
from des_cli.model.machine import OccupantBounds, Seat
from des_cli.model.machines import DES
from des_cli.reduction.free import windows
from des_cli.reduction.free.ground_cross import GroundCross
from des_cli.reduction.free.local_bounds import NormBound
from des_cli.reduction.free.program import MotionProgram
from tests.support.free_motions import (
    ATTITUDE,
    JOINTS,
    RATE,
    TURNING,
    G,
    program_of,
    smooth,
    task_of,
    wiggle,
)

STEP = 1e-6
MATCHED = {G: 0.1, RATE: 0.2}
OCCUPANT = OccupantBounds(
    gx=(-2.0, 3.0), gy=(-1.0, np.inf), gz=(0.5, 4.0), g_onset=0.8, angular_acceleration=2.0
)
BOUNDED = replace(DES, occupant=OCCUPANT)
ALL_BUDGETS = {
    G: 0.3,
    RATE: 0.4,
    JOINTS: 0.2,
    "joint_deviation_relative_squared": 0.05,
    TURNING: 0.4,
    "seat_g_deviation_relative": 0.3,
    "seat_angular_acceleration_deviation_relative": 0.5,
    "seat_angular_acceleration_rms_ratio": 1.2,
}


def _ground(**further):
    """The study's weight: one component in ground axes, and others a little."""
    root = np.array([[0.3, 0.2, 0.0], [0.1, 1.4, 0.3], [0.0, 0.0, 0.2]])
    return program_of(
        task_of(smooth(), MATCHED), cost=[], ground=GroundCross(chain_of(DES, Seat()), root)
    )


def _heavy_seat():
    """A weight on the seat's turn that matters."""
    task = task_of(smooth(), MATCHED, optimise=("seat_yaw", "seat_pitch"))
    problem = program_of(task).problem
    return MotionProgram(replace(problem, seat=replace(problem.seat, weight=50.0)))


PROGRAMS = {
    "coriolis": lambda: program_of(task_of(smooth(), {})),
    "felt": lambda: program_of(task_of(smooth(), {}, objective="felt")),
    "blend": lambda: program_of(task_of(smooth(), {}, objective="blend", ends="match-rates")),
    "weighted": lambda: program_of(
        task_of(smooth(), {}, r1=np.array([[2.0, 0.5, 0], [0.5, 1.0, 0], [0, 0, 0.2]]))
    ),
    "budgets": lambda: program_of(task_of(smooth(), ALL_BUDGETS, ends="match-both")),
    "held": lambda: program_of(task_of(smooth(), ALL_BUDGETS, hold=frozenset({"fork"}))),
    "starts": lambda: program_of(
        task_of(smooth(), MATCHED, optimise=("fork_start", "cab_start"), ends="free")
    ),
    "occupant": lambda: program_of(task_of(smooth(), MATCHED, BOUNDED)),
    "points": lambda: program_of(
        task_of(smooth(), {ATTITUDE: 25.0, "seat_angular_acceleration_peak_ratio": 2.0, **MATCHED})
    ),
    "every bound": lambda: program_of(task_of(smooth(), {ATTITUDE: 25.0}, BOUNDED)),
    "ground": _ground,
    "seat": lambda: program_of(task_of(smooth(), ALL_BUDGETS, optimise=("seat_yaw", "seat_pitch"))),
    "heavy seat": _heavy_seat,
    "pitch": lambda: program_of(
        task_of(smooth(), MATCHED, optimise=("seat_pitch", "cab_start"), objective="felt")
    ),
}


@pytest.fixture(params=list(PROGRAMS))
def program(request):
    return PROGRAMS[request.param]()


@pytest.fixture
def rng():
    return np.random.default_rng(1)


def multipliers(program, x, rng):
    """Random ones of budgets and local bounds, and stiffness of these."""
    values = program.values(x)
    return rng.random(len(values.budgets)), *rng.random((2, len(values.local)))


def hessian_times(program, hessian, step):
    """The bordered band times a vector of the full space."""
    n = program.problem.base.size
    motion = hessian.band.times(step[:n].reshape(-1, 3)).ravel() + hessian.border.T @ step[n:]
    return np.concatenate([motion, hessian.border @ step[:n] + hessian.corner @ step[n:]])


def central(function, x, step):
    return (function(x + STEP * step) - function(x - STEP * step)) / (2.0 * STEP)


def same(found, expected, rtol=2e-6):
    scale = np.max(np.abs(expected), initial=0.0)
    np.testing.assert_allclose(found, expected, rtol=0, atol=rtol * scale + 1e-9)


def test_expanded_values_are_the_values(program, rng):
    x = wiggle(program)
    for fresh in (True, False):  # not, and just evaluated
        values = program.values(x)
        if fresh:
            program.values(2.0 * x)
        expansion = program.expand(x, *multipliers(program, x, rng))
        assert expansion.cost == pytest.approx(values.cost, rel=1e-12)
        np.testing.assert_allclose(expansion.budgets, values.budgets, rtol=1e-12)
        np.testing.assert_allclose(expansion.local, values.local, rtol=1e-12)


def test_an_iterate_is_evaluated_once(program, rng, monkeypatch):
    evaluate, calls = SeatForms.at, []

    def counted(forms, z):
        calls.append(z.shape[1])
        return evaluate(forms, z)

    monkeypatch.setattr(SeatForms, "at", counted)
    x = wiggle(program)
    arguments = multipliers(program, x, rng)
    expansion = program.expand(x, *arguments)
    for share in (1.0, 0.5, 0.25, 0.0):
        program.system(expansion, share, np.ones_like(program.bounds), 0.0)
    assert sum(calls) == 2 * program.problem.grid.intervals
    before = program.values(x).cost
    x *= 2.0  # the same array, and another point
    assert program.values(x).cost != before
    assert sum(calls) == 4 * program.problem.grid.intervals


def test_a_hessian_does_not_depend_on_the_one_before(program, rng):
    x = wiggle(program)
    arguments = multipliers(program, x, rng)
    expansion = program.expand(x, *arguments)
    expansion.hessian(1.0)
    found, alone = expansion.hessian(0.5), program.expand(x, *arguments).hessian(0.5)
    np.testing.assert_array_equal(found.band.data, alone.band.data)
    np.testing.assert_array_equal(found.border, alone.border)
    np.testing.assert_array_equal(found.corner, alone.corner)


def test_first_derivatives(program, rng):
    x = wiggle(program)
    expansion = program.expand(x, *multipliers(program, x, rng))
    for _ in range(3):
        step = rng.normal(size=program.size)
        same(expansion.gradient @ step, central(lambda y: program.values(y).cost, x, step))
        same(
            expansion.budget_gradients.T @ step,
            central(lambda y: program.values(y).budgets, x, step),
        )
        same(expansion.local_change(step), central(lambda y: program.values(y).local, x, step))
        multiplier = rng.normal(size=len(expansion.local))
        assert multiplier @ expansion.local_change(step) == pytest.approx(
            expansion.local_adjoint(multiplier) @ step, rel=1e-9, abs=1e-12
        )


@pytest.mark.parametrize("chunk", [7, 512])
def test_the_hessian_of_the_lagrangian(program, rng, chunk, monkeypatch):
    monkeypatch.setattr(windows, "CHUNK", chunk)
    program = MotionProgram(program.problem)
    x = wiggle(program)
    budget, local, stiffness = multipliers(program, x, rng)

    def gradient(y):
        e = program.expand(y, budget, local, stiffness)
        return e.gradient + e.budget_gradients @ budget + e.local_adjoint(local)

    expansion = program.expand(x, budget, local, stiffness)
    for _ in range(2):
        step = rng.normal(size=program.size)
        barrier = expansion.local_adjoint(stiffness * expansion.local_change(step))
        found = hessian_times(program, expansion.hessian(1.0), step)
        same(found, central(gradient, x, step) + barrier, 1e-5)


def test_without_its_curvature_the_hessian_is_convex(program, rng):
    x = wiggle(program)
    expansion = program.expand(x, *multipliers(program, x, rng))
    plain, whole, half = (expansion.hessian(share) for share in (0.0, 1.0, 0.5))
    for _ in range(5):
        step = rng.normal(size=program.size)
        assert step @ hessian_times(program, plain, step) > 0.0
        between = 0.5 * (hessian_times(program, plain, step) + hessian_times(program, whole, step))
        same(hessian_times(program, half, step), between, 1e-10)
    assert program.system(expansion, 0.0, np.ones_like(program.bounds), 0.0) is not None


def dense_of(function, size):
    return np.stack([function(unit) for unit in np.eye(size)], axis=1)


def test_the_linear_rows_and_the_ends(program, rng):
    x, step = wiggle(program), rng.normal(size=program.size)
    change = program.linear_change(step)
    found = program.linear(x + step) - program.linear(x)
    np.testing.assert_allclose(found, change, rtol=0, atol=1e-10 * np.abs(change).max())
    multiplier = rng.normal(size=len(program.bounds))
    assert multiplier @ change == pytest.approx(program.linear_adjoint(multiplier) @ step, rel=1e-9)
    reduced = program.reduce(step)
    idle = program.problem.ends.idle(program.problem.grid.points).ravel()
    assert not reduced[: len(idle)][idle].any()
    np.testing.assert_array_equal(program.seat_angles(reduced), program.seat_angles(step))


def test_systems_are_those_of_the_bordered_hessian(program, rng):
    x = wiggle(program)
    expansion = program.expand(x, *multipliers(program, x, rng))
    stiffness = rng.random(len(program.bounds))
    system = program.system(expansion, 0.0, stiffness, 0.0)
    right = rng.normal(size=(program.size, 2))
    solution = system.solve(right)
    n = program.problem.base.size
    for b, step in zip(right.T, solution.T, strict=True):
        # the solution keeps the ends, and leaves a residual that only they can bear
        kept = program.problem.ends.full(
            np.where(program.problem.ends.idle(n // 3), 0.0, step[:n].reshape(-1, 3))
        )
        np.testing.assert_allclose(kept.ravel(), step[:n], rtol=0, atol=1e-8 * np.abs(step).max())
        product = hessian_times(program, expansion.hessian(0.0), step)
        product += program.linear_adjoint(stiffness * program.linear_change(step))
        same(program.reduce(product), program.reduce(b), 1e-7)


def test_what_is_not_convex_has_no_system():
    program = PROGRAMS["coriolis"]()
    x = wiggle(program)
    expansion = program.expand(x, np.zeros(0), np.zeros(0), np.zeros(0))
    band = expansion.hessian(1.0).band  # the one that is factorised next
    band.data[:, :, 0] -= 10.0 * np.abs(band.data).max()
    assert program.system(expansion, 1.0, np.zeros_like(program.bounds), 0.0) is None
    seat = PROGRAMS["seat"]()
    x = wiggle(seat)
    expansion = seat.expand(x, np.zeros(len(ALL_BUDGETS)), np.zeros(0), np.zeros(0))
    expansion.hessian(0.0).corner[:] -= 1e6 * np.eye(2)
    assert seat.system(expansion, 0.0, np.zeros_like(seat.bounds), 0.0) is None


def test_the_smoothing_is_on_the_deviation_alone():
    program = PROGRAMS["coriolis"]()
    still = np.zeros(program.size)
    rough = program.control(wiggle(program)).copy()
    heavier = MotionProgram(
        replace(program.problem, smoothing=program.problem.smoothing + np.array([0.0, 3.0, 0.0]))
    )
    assert heavier.values(still).cost == program.values(still).cost
    jerk = program.problem.grid.differences(rough, 3)[:, 1]
    expected = 3.0 * program.problem.grid.step * np.sum(jerk**2)
    found = heavier.values(rough.ravel()).cost - program.values(rough.ravel()).cost
    assert found == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("bound", ["components", "force"])
def test_bounds_at_points_know_the_seats_angles(bound, rng):
    """Turning the seat moves the head and turns G's components."""
    machine = replace(DES, occupant=OccupantBounds(gx=(-2.0, 3.0))) if bound[0] == "c" else DES
    further = {"local": [NormBound("force", 30.0)]} if bound == "force" else {}
    program = program_of(
        task_of(smooth(), MATCHED, machine, optimise=("seat_yaw", "seat_pitch")), **further
    )
    x = wiggle(program)
    expansion = program.expand(x, *multipliers(program, x, rng))
    step = np.zeros(program.size)
    step[-2:] = 1.0
    chained = central(lambda y: program.values(y).local, x, step)
    assert np.abs(chained).max() > 1e-3
    same(expansion.local_change(step), chained)
