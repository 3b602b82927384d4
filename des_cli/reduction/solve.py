"""Which method answers which request."""

from __future__ import annotations

import numpy as np

from des_cli.model.machine import JOINTS, Machine
from des_cli.model.motion import Motion
from des_cli.model.profile import Reduction
from des_cli.model.solution import Solution
from des_cli.reduction.budget import pose_budget, spend_budgets
from des_cli.reduction.executable import nearest_executable
from des_cli.reduction.optimum import find_optimum
from des_cli.reduction.problem import Problem
from des_cli.reduction.report_sweep import sweep
from des_cli.reduction.search import Report, Search
from des_cli.reduction.zero import find_zero, pose_zero


def solve(
    problem: Problem, wanted: Reduction, report: Report | None = None
) -> tuple[Problem, Solution]:
    """Solve a problem by the method that a profile asks for.

    Parameters
    ----------
    problem : Problem
    wanted : Reduction
    report : callable, optional
        Called with each line of the solver's log.

    Returns
    -------
    problem : Problem
        As it was solved: a budget and the zero method bring their own weights.
    solution : Solution
    """
    if wanted.algorithm == "report-sweep":
        return problem, sweep(problem, wanted.iterations)
    search = Search(wanted.max_iterations, report)
    if wanted.method == "zero":
        posed = pose_zero(problem)
        return posed, find_zero(posed, np.diag(problem.r1) > 0.0, wanted.tolerance, search)
    if wanted.budget:
        posed = pose_budget(problem)
        return posed, spend_budgets(posed, wanted.budget, search)
    return problem, find_optimum(problem, search)


def make_executable(machine: Machine, desired: Motion) -> tuple[Motion, str]:
    """Replace a desired motion by the nearest one inside the limits.

    Returns
    -------
    motion : Motion
    trouble : str
        Empty, or why there is none.
    """
    for j, (joint, limit) in enumerate(zip(JOINTS, machine.limits, strict=True)):
        first = abs(float(desired.angle[0, j]))
        if first > limit.angle:
            return desired, (
                f"the {joint} starts at {first:.4g} rad, outside its limit of {limit.angle:.4g} "
                f"rad, at t = {desired.t[0]:g} s; start it inside"
            )
    motion, outcome = nearest_executable(machine, desired)
    if outcome is not None and not outcome.usable:
        return motion, (
            "no motion near the desired one keeps the limits: the search for it ended with "
            f"the limits off by {outcome.infeasibility:.1e} (relative)"
        )
    return motion, ""


def not_attempted(problem: Problem, why: str) -> Solution:
    """Return the solution of a problem that has no executable motion to start from."""
    n = len(problem.desired.t)
    return Solution(
        status="infeasible",
        message=why,
        control=np.ones((n, problem.controls)),
        modified=problem.desired,
        adjoint=np.zeros((n, 3)),
        cost=float("nan"),
        cost_unreduced=float("nan"),
        optimality=float("nan"),
        iterations=0,
    )
