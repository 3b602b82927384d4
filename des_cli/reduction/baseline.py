"""What simpler means make of the same problem: the study's sweep, and a constant p.

A reduction means little without them: slowing everything down by one factor
already takes most of the Coriolis away.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from des_cli.kinematics.coriolis import coriolis
from des_cli.model.motion import Motion, integrate_sides
from des_cli.model.solution import Solution
from des_cli.reduction.problem import Problem
from des_cli.reduction.report_sweep import sweep
from des_cli.reduction.transcription import Transcription

RAN_AWAY = 100.0
"""Growth of the weighted Coriolis beyond which the study's sweep is no baseline."""

BISECTIONS = 60
"""Halvings of [0, 1] for the constant factor: to the last digit of a double."""


@dataclass(frozen=True, slots=True)
class Baselines:
    """Reductions of the weighted Coriolis int c' R1 c, and their price in the joints.

    A reduction is None where the desired motion makes no weighted Coriolis; what
    the sweep reaches is None where it runs away.
    """

    reduction: float | None
    sweep_reduction: float | None
    sweep_deviation: float | None
    constant_p: float
    constant_deviation: float


def compare(problem: Problem, solution: Solution) -> Baselines:
    """Set a solution beside the study's sweep and the constant factor that equals it.

    Parameters
    ----------
    problem : Problem
    solution : Solution

    Returns
    -------
    Baselines
    """
    scalar = replace(problem, r2=np.array([problem.r2.sum()]))
    grid = Transcription(scalar)
    before = weighted_energy(problem, problem.desired)
    after = weighted_energy(problem, solution.modified)
    swept = sweep(scalar)
    swept_energy = weighted_energy(problem, swept.modified)
    ran_away = swept.status == "diverged" or swept_energy > RAN_AWAY * before
    p = _constant_factor(grid, after) if before > after else 1.0
    constant = grid.motion(grid.follow(np.full((grid.n, 1), p)))
    nothing = before <= 1e-24
    return Baselines(
        reduction=None if nothing else 1.0 - after / before,
        sweep_reduction=None if nothing or ran_away else 1.0 - swept_energy / before,
        sweep_deviation=None if ran_away else joint_deviation(problem.desired, swept.modified),
        constant_p=p,
        constant_deviation=joint_deviation(problem.desired, constant),
    )


def weighted_energy(problem: Problem, motion: Motion) -> float:
    """Return int c' R1 c dt of a motion."""
    c = coriolis(problem.chain, motion.angle_sides, motion.rate_sides, problem.axes)
    return float(integrate_sides(motion.step, np.sum((c @ problem.r1) * c, axis=-1)))


def joint_deviation(wanted: Motion, made: Motion) -> float:
    """Return ||theta - Theta|| / ||Theta|| over the joint angles."""
    off = np.sum((made.angle_sides - wanted.angle_sides) ** 2, axis=-1)
    size = float(integrate_sides(wanted.step, np.sum(wanted.angle_sides**2, axis=-1)))
    return float(np.sqrt(float(integrate_sides(wanted.step, off)) / max(size, 1e-300)))


def _constant_factor(grid: Transcription, wanted: float) -> float:
    """Return the largest constant p below one whose weighted energy is the wanted one."""
    low, high = 0.0, 1.0
    for _ in range(BISECTIONS):
        p = 0.5 * (low + high)
        made = grid.motion(grid.follow(np.full((grid.n, 1), p)))
        if weighted_energy(grid.problem, made) > wanted:
            high = p
        else:
            low = p
    return 0.5 * (low + high)
