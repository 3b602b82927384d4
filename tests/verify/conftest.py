"""Factors on the study's maneuvers, as `reduction`'s tests have them, and a free motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.model.machines import DES
from des_cli.model.solution import Solution
from des_cli.reduction.executable import nearest_executable
from des_cli.reduction.problem import Problem
from tests.reduction.conftest import (  # noqa: F401
    cobra,
    pose,
    solve_problem,
    study_cost,
    study_motion,
)
from tests.support.free_case import Case


@pytest.fixture(scope="session")
def case() -> Case:
    """The Cobra within its default budgets."""
    return Case()


@pytest.fixture(scope="session", params=["scalar", "per-joint"])
def solved(request, cobra, pose, solve_problem) -> tuple[Problem, Solution]:  # noqa: F811
    """An optimum without limits."""
    problem = pose(cobra(250), 1.0, control=request.param, axes="seat", r1=(2, 2, 2), tracking=0.1)
    return problem, solve_problem(problem)


@pytest.fixture(scope="session")
def inside(cobra, pose, solve_problem) -> tuple[Problem, Solution]:  # noqa: F811
    """An optimum whose limits bind."""
    motion, _ = nearest_executable(DES, cobra(250))
    problem = pose(
        motion, 0.03, control="per-joint", axes="seat", r1=(2, 2, 2), tracking=0.3, machine=DES
    )
    return problem, solve_problem(problem)


@pytest.fixture(scope="session")
def remade() -> Callable[[Problem, Solution, Floats], Solution]:
    """A solution of other factors, with its motion and cost made to fit."""

    def remake(problem: Problem, solution: Solution, control: Floats) -> Solution:
        x = study_motion(problem, control)
        factor = np.broadcast_to(control, (len(control), 3))
        motion = replace(
            solution.modified,
            angle=x[:, :3],
            rate_start=factor[:-1] * problem.desired.rate_start,
            rate_end=factor[1:] * problem.desired.rate_end,
        )
        cost = float(study_cost(problem, x))
        return replace(solution, control=control, modified=motion, cost=cost)

    return remake
