"""Factors on the study's maneuvers, as `reduction`'s tests have them."""

from tests.reduction.conftest import (  # noqa: F401
    closed_cost,
    closed_motion,
    cobra,
    pose,
    solve_problem,
)
