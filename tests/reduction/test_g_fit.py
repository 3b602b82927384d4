"""The fit of a G: derivatives against differences, and what its minimum is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.twist import seat_forms
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.reduction.free.unknowns import SEAT_VARIABLES
from des_cli.reduction.free.windows import Windows
from des_cli.reduction.g_fit import Direction, GFit, Magnitude, Residual, _GProblem, fit_g
from des_cli.solver.spline import Ends, SplineGrid

GRID = SplineGrid(0.0, 0.1, 30)
FORMS = seat_forms(chain_of(DES, Seat(yaw=np.radians(270))), DES.gravity)
TIMES = Windows(GRID, SEAT_VARIABLES).times()
NO = np.zeros(3, dtype=bool)
FREE = Ends(np.array([True, False, False]), NO, NO, NO, NO)


def turning(rate: float) -> np.ndarray:
    """Control points of a steady arm with the cab at 60 degrees."""
    time = GRID.greville
    return np.column_stack([rate * time, 0 * time, np.full_like(time, np.radians(60.0))])


RESIDUALS = {
    "magnitude": Magnitude(np.full(len(TIMES), 2.5)),
    "direction": Direction(np.tile([[0.1], [0.2], [-np.sqrt(0.95)]], len(TIMES))),
}


@pytest.mark.parametrize("residual", RESIDUALS.values(), ids=RESIDUALS)
def test_the_gradient_is_that_of_the_cost(residual: Residual) -> None:
    rng = np.random.default_rng(1)
    control = turning(1.8) + 0.02 * rng.normal(size=(GRID.points, 3))
    problem = _GProblem(GRID, FORMS, residual, DES.limits)
    _, gradient = problem.expand(control, problem.cost(control)[1])
    move = rng.normal(size=control.shape)
    ahead, behind = (problem.cost(control + h * move)[0] for h in (1e-6, -1e-6))
    assert np.sum(gradient * move) == pytest.approx((ahead - behind) / 2e-6, rel=1e-6)


def test_the_hessian_of_gauss_and_newton_is_exact_where_nothing_is_off() -> None:
    control = turning(1.8)
    unit = FORMS.at(Windows(GRID, SEAT_VARIABLES).gather(control, 0, GRID.intervals)).force
    unit = unit / np.linalg.norm(unit, axis=0)
    problem = _GProblem(GRID, FORMS, Direction(unit), DES.limits)
    hessian, _ = problem.expand(control, problem.cost(control)[1])
    move = 1e-4 * np.random.default_rng(2).normal(size=control.shape)
    rise = problem.cost(control + move)[0] + problem.cost(control - move)[0]
    rise -= 2.0 * problem.cost(control)[0]
    assert np.sum(move * hessian.times(move)) == pytest.approx(rise, rel=1e-3)


def fit(residual: Residual, start: np.ndarray, **arm: float) -> GFit:
    limits = (replace(DES.limits[0], **arm), *DES.limits[1:])
    return fit_g(GRID, start, FORMS, residual, limits, FREE)


def test_a_magnitude_within_reach_is_made() -> None:
    arm_alone = replace(FREE, held=np.array([False, True, True]))
    found = fit_g(GRID, turning(1.8), FORMS, RESIDUALS["magnitude"], DES.limits, arm_alone)
    assert found.settled
    np.testing.assert_allclose(np.linalg.norm(found.force, axis=0), 2.5, atol=1e-3)
    # gravity and rho w^2 at right angles: rho by the chain of the DES at 60 degrees
    rate = GRID.values(found.control, np.array([1.5]), 1)[0, 0]
    force = FORMS.at(np.array([[0, np.radians(60), rate, 0, 0, 0, 0, 0]]).T).force / 9.81456
    assert np.linalg.norm(force) == pytest.approx(2.5, abs=1e-3)


def test_limits_are_kept_where_the_ask_is_beyond_them() -> None:
    jump = Magnitude(np.where(TIMES < 1.5, 1.5, 6.0))
    found = fit(jump, turning(1.2), acceleration=0.4, jerk=1.0)
    acceleration, jerk = (GRID.differences(found.control, order) for order in (2, 3))
    assert np.abs(acceleration[:, 0]).max() <= 0.4 * (1 + 1e-6)
    assert np.abs(jerk[:, 0]).max() <= 1.0 * (1 + 1e-6)
    assert np.abs(acceleration[:, 0]).max() > 0.39
