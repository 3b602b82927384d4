"""Factors on the study's maneuvers, as `reduction`'s tests have them, and a free motion."""

import pytest

from tests.reduction.conftest import (  # noqa: F401
    closed_cost,
    closed_motion,
    cobra,
    pose,
    solve_problem,
)
from tests.support.free_case import Case


@pytest.fixture(scope="session")
def case() -> Case:
    """The Cobra within its default budgets."""
    return Case()
