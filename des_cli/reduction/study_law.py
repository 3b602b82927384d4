"""The study's law applied to a problem on its grid, once or several times.

``study.backward_forward`` holds the law. It is here to reproduce the study and as
a baseline.
"""

from __future__ import annotations

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.solution import Iteration, Solution, Status
from des_cli.reduction.problem import Problem
from des_cli.reduction.transcription import Transcription
from des_cli.study.backward_forward import adjoint_along, factors_of

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
            adjoint_next = adjoint_along(grid.motion(x), problem.chain, problem.axes, problem.r1)
            factor = factors_of(problem.desired, adjoint_next, problem.r2)
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


def _optimality(grid: Transcription, x: Floats) -> float:
    """Return the scaled violation of the true first-order conditions."""
    gradient = grid.reduced_gradient(x)
    return float(np.max(np.abs(gradient) / grid.weight[:, None]) / grid.scale)
