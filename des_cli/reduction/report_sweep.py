"""The study's own law, as printed: one backward-forward sweep.

The adjoint equations (42)-(44) are integrated backward from (45) on the desired
motion, the factor follows from (47),

    L' = -1/2 d/dtheta (c' R1 c),   L(tf) = 0,   p = 1 - L' J2^-1 W / r2,

and the angles are integrated forward once from (46). The law leaves out the
derivative of c with respect to p: it is not the optimum, and iterating it need
not converge. It is here to reproduce the study and as a baseline.
"""

from __future__ import annotations

import numpy as np

from des_cli.kinematics.coriolis import coriolis_derivatives
from des_cli.model.arrays import Floats
from des_cli.model.motion import Motion, mean_of_sides
from des_cli.model.solution import Iteration, Solution, Status
from des_cli.reduction.problem import Problem
from des_cli.reduction.transcription import Transcription

RUNAWAY = 1e6
"""A factor on the rates that no law means: from here squares soon leave the doubles."""


def sweep(problem: Problem, iterations: int = 1) -> Solution:
    """Apply the study's law.

    Parameters
    ----------
    problem : Problem
    iterations : int
        Sweeps in all; each takes its adjoint on the motion of the one before.

    Returns
    -------
    Solution
        ``converged`` means that the sweeps were made and gave sensible numbers;
        its ``optimality`` tells how far from the optimum they ended. Of sweeps
        that ran away (``diverged``) it is the last one before.
    """
    grid = Transcription(problem)
    x = grid.desired
    log: list[Iteration] = []
    adjoint = np.zeros((grid.n, 3))
    change, message = 0.0, ""
    for number in range(1, iterations + 1):
        with np.errstate(over="ignore", invalid="ignore"):
            adjoint_next = _adjoint(problem, grid.motion(x))
            factor = _law(problem, grid, adjoint_next)
        largest = float(np.max(np.abs(factor)))
        if not largest < RUNAWAY:
            message = (
                f"sweep {number} of the study's law asks for a factor of {largest:.3g}: "
                "it need not converge; take a larger r2 or fewer iterations"
            )
            break
        x_next = grid.follow(factor)
        change = float(np.max(np.abs(factor - x[:, 3:])))
        x, adjoint = x_next, adjoint_next
        log.append(Iteration(number, grid.cost(x), 0.0, _optimality(grid, x), 1.0))
    status: Status = "diverged" if message else "converged"
    plural = "one sweep" if iterations == 1 else f"{iterations} sweeps"
    return Solution(
        status=status,
        message=message
        or f"{plural} of the study's law, which is not the optimum; "
        f"the last sweep changed the factor by up to {change:.3g}",
        control=x[:, 3:],
        modified=grid.motion(x),
        adjoint=adjoint,
        cost=log[-1].cost if log else grid.cost(x),
        cost_unreduced=grid.cost(grid.desired),
        optimality=log[-1].optimality if log else float("inf"),
        iterations=len(log),
        log=tuple(log),
    )


def _adjoint(problem: Problem, motion: Motion) -> Floats:
    """Integrate (42)-(45) backward along a motion, (n, 3)."""
    c, dc_dangle, _ = coriolis_derivatives(
        problem.chain, motion.angle_sides, motion.rate_sides, problem.axes
    )
    slope = np.einsum("ksca,ksc->ksa", dc_dangle, c @ problem.r1)
    fall = 0.5 * motion.step[:, None] * slope.sum(axis=1)
    return np.vstack([np.cumsum(fall[::-1], axis=0)[::-1], np.zeros(3)])


def _law(problem: Problem, grid: Transcription, adjoint: Floats) -> Floats:
    """Return the factors of (47), (n, m); one equation a joint for per-joint control."""
    rate = problem.desired.rate_sides
    sides = np.stack([adjoint[:-1], adjoint[1:]], axis=1)
    power = mean_of_sides(sides * rate)
    if grid.m == 1:
        power = power.sum(axis=1, keepdims=True)
    return np.asarray(1.0 - power / problem.r2)


def _optimality(grid: Transcription, x: Floats) -> float:
    """Return the scaled violation of the true first-order conditions."""
    gradient = grid.reduced_gradient(x)
    return float(np.max(np.abs(gradient) / grid.weight[:, None]) / grid.scale)
