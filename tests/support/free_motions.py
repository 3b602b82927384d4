"""Small free motions for the tests: smooth maneuvers, tasks and programs on coarse knots."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import Machine, Seat
from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion
from des_cli.model.profile import Reduction
from des_cli.reduction.executable import ExecutableSpline, fit_executable
from des_cli.reduction.free.pose import pose_motion
from des_cli.reduction.free.program import MotionProgram
from des_cli.reduction.free.task import FreeTask, unlimited
from des_cli.solver.spline import SplineGrid

G, RATE = "seat_g_rms_error_g", "seat_rate_deviation_relative"
JOINTS = "joint_deviation_relative"
TURNING = "seat_angular_acceleration_rms_error_rad_s2"
ATTITUDE = "attitude_error_max_deg"

AMPLITUDE = ((0.6, 0.0, 0.15), (0.1, 0.3, 0.0), (-0.2, 0.1, 0.25))
"""Of cos(j pi t / T) in the rates of arm, fork and cab [rad/s]: smooth, inside the limits."""


def smooth(intervals: int = 600, duration: float = 4.0, amplitude: Any = AMPLITUDE) -> Motion:
    """Return a smooth maneuver with exact angles."""
    t = np.linspace(0.0, duration, intervals + 1)
    angle, rate = np.tile([0.2, -0.3, 0.4], (len(t), 1)), np.zeros((len(t), 3))
    for j, column in enumerate(np.transpose(amplitude)):
        w = j * np.pi / duration
        rate += np.cos(w * t)[:, None] * column
        angle += (np.sin(w * t) / w if j else t)[:, None] * column
    return Motion(t, angle, rate[:-1], rate[1:])


def task_of(
    motion: Motion,
    budget: Mapping[str, float],
    machine: Machine = DES,
    seat: Seat | None = None,
    **reduction: Any,
) -> FreeTask:
    """Return the task of a maneuver within budgets."""
    budgets = tuple(Budget(metric, most) for metric, most in budget.items())  # type: ignore[arg-type]
    asked = Reduction(budget=budgets, **reduction)
    limits = machine.limits if asked.limits == "enforce" else unlimited()
    return FreeTask(machine, seat or Seat(), asked, motion, limits)


def fit(task: FreeTask, intervals: int) -> ExecutableSpline:
    """Return the executable motion on so many intervals."""
    t = task.reference.t
    grid = SplineGrid(float(t[0]), float(t[-1] - t[0]) / intervals, intervals)
    return fit_executable(grid, task.reference, task.limits, task.base_ends)


def program_of(task: FreeTask, intervals: int = 20, **change: Any) -> MotionProgram:
    """Return the task's program, with parts of its problem changed."""
    spline = fit(task, intervals)
    assert not spline.trouble
    problem = pose_motion(task, spline.grid, spline.control)
    return MotionProgram(replace(problem, **change))


def wiggle(program: MotionProgram, size: float = 0.02, seed: int = 0) -> Floats:
    """Return a random vector that keeps the ends."""
    x = size * np.random.default_rng(seed).normal(size=program.size)
    control = program.problem.ends.full(program.control(x))
    return np.concatenate([control.ravel(), program.seat_angles(x)])


def sway(program: MotionProgram, size: float = 0.05) -> Floats:
    """Return a smooth vector that keeps angles and rates at the start."""
    grid = program.problem.grid
    s = (grid.greville - grid.start)[:, None] / grid.duration
    control = size * s**3 * np.cos(np.array([5.0, 3.0, 7.0]) * s + np.array([0.0, 1.0, 2.0]))
    control = program.problem.ends.full(control)
    return np.concatenate([control.ravel(), np.zeros(program.free_angles)])
