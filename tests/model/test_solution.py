"""What stands where there is no solution."""

import math

import numpy as np
import pytest

from des_cli.model.motion import Motion
from des_cli.model.solution import Iteration, Solution

REST = Motion(np.arange(4.0), np.zeros((4, 3)), np.zeros((3, 3)), np.zeros((3, 3)))


@pytest.mark.parametrize(("controls", "costates"), [(1, 3), (3, 3), (3, 0), (0, 0)])
def test_a_refusal_is_no_solution_and_has_no_cost(controls: int, costates: int) -> None:
    log = (Iteration(0, 1.0, 0.0, 1.0, 1.0),)
    refused = Solution.refused(
        "infeasible", "why", REST, controls=controls, costates=costates, log=log
    )
    assert not refused.usable
    assert (refused.status, refused.message, refused.modified) == ("infeasible", "why", REST)
    np.testing.assert_array_equal(refused.control, np.ones((4, controls)))
    np.testing.assert_array_equal(refused.adjoint, np.zeros((4, costates)))
    assert all(map(math.isnan, (refused.cost, refused.cost_unreduced, refused.optimality)))
    assert (refused.iterations, refused.log) == (1, log)
