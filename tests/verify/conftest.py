"""Factors on the study's maneuvers, as `reduction`'s tests have them, and a free motion."""

from __future__ import annotations

import pytest

from des_cli.model.machines import DES
from des_cli.model.solution import Solution
from des_cli.reduction.executable import nearest_executable
from des_cli.reduction.problem import Problem
from tests.reduction.conftest import (  # noqa: F401
    cobra,
    pose,
    solve_problem,
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
