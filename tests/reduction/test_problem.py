"""From a profile to the problem of factors along a motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.model.machines import DES
from des_cli.model.motion import Record, Shortfall
from des_cli.model.profile import Reduction
from des_cli.reduction.problem import control_weight, pose_problem
from des_cli.reduction.transcription import Transcription
from tests.support.claims import profile_of
from tests.support.free_motions import smooth

MOTION, OTHER = smooth(12), smooth(12, amplitude=((0.5,), (0.1,), (0.2,)))
BB3 = np.diag([0.0, 2.0, 0.0])


def test_three_equal_factors_cost_what_the_scalar_costs() -> None:
    r2, p = np.array([0.3, 1.1, 2.5]), 0.7
    scalar, joints = control_weight("scalar", r2), control_weight("per-joint", r2)
    assert (scalar.shape, joints.shape) == ((1,), (3,))
    assert joints.sum() * (1.0 - p) ** 2 == pytest.approx(float(scalar[0]) * (1.0 - p) ** 2)
    np.testing.assert_allclose(joints / joints[0], r2 / r2[0])


def test_equal_factors_cost_the_same_on_the_grid_too() -> None:
    costs = []
    for control in ("scalar", "per-joint"):
        reduction = Reduction(control=control, r2=np.array([0.3, 1.1, 2.5]), r1=BB3)
        grid = Transcription(pose_problem(profile_of(MOTION, reduction), MOTION))
        costs.append(grid.cost(grid.follow(np.full((13, grid.m), 0.7))))
    assert costs[0] == pytest.approx(costs[1], rel=1e-13)


@pytest.mark.parametrize(
    ("r1", "axes"),
    [(2.0 * np.eye(3), "seat"), (np.zeros((3, 3)), "seat"), (BB3, "report")],
)
def test_a_weight_on_the_length_needs_no_ground_axes(r1: Any, axes: str) -> None:
    asked = profile_of(MOTION, Reduction(control="scalar", axes="report", r1=r1))
    assert pose_problem(asked, MOTION).axes == axes


def test_a_weight_on_the_length_is_the_same_in_the_grounds_axes() -> None:
    problem = pose_problem(profile_of(MOTION, Reduction(control="scalar")), MOTION)
    costs = [
        (grid := Transcription(replace(problem, axes=axes))).cost(grid.desired)
        for axes in ("seat", "report")
    ]
    assert costs[0] > 1e-3
    assert costs[0] == pytest.approx(costs[1], rel=1e-12)


@pytest.mark.parametrize(("limits", "machine"), [("enforce", DES), ("check", None), ("warn", None)])
def test_limits_hold_where_they_are_enforced(limits: str, machine: object) -> None:
    asked = profile_of(MOTION, Reduction(limits=limits))  # type: ignore[arg-type]
    assert pose_problem(asked, MOTION).machine is machine


def test_what_a_profile_asks_for_is_taken_over() -> None:
    reduction = Reduction(
        control="per-joint",
        r1=BB3,
        tracking=np.array([0.1, 0.2, 0.3]),
        jacobian="adapted",
        hold=frozenset({"cab", "arm"}),
        ends="match-both",
    )
    problem = pose_problem(profile_of(MOTION, reduction, replace(DES, gravity=9.5)), MOTION)
    assert (problem.jacobian, problem.ends, problem.gravity) == ("adapted", "match-both", 9.5)
    assert problem.controls == 3
    np.testing.assert_array_equal(problem.held, [True, False, True])
    np.testing.assert_array_equal(problem.tracking, [0.1, 0.2, 0.3])
    np.testing.assert_array_equal(problem.r1, BB3)


def test_budgets_are_measured_against_what_is_asked_for() -> None:
    asked = profile_of(MOTION, Reduction())
    alone = pose_problem(asked, MOTION)
    assert alone.reference is alone.desired is MOTION
    nothing = np.zeros((12, 2, 3))
    missing = Shortfall(nothing, nothing, nothing, np.zeros((13, 3)))
    problem = pose_problem(asked, MOTION, Record(OTHER, missing))
    assert (problem.desired, problem.reference) == (MOTION, OTHER)
    assert problem.shortfall is missing


@pytest.mark.parametrize(("name", "shape"), [("r1", 3), ("r2", (3, 1)), ("tracking", 1)])
def test_weights_of_another_shape_are_refused(
    name: str, shape: Any, pose: Callable[..., Any]
) -> None:
    with pytest.raises(ValueError, match="shape"):
        replace(pose(MOTION), **{name: np.ones(shape)})


def test_weights_cannot_be_changed_afterwards(pose: Callable[..., Any]) -> None:
    with pytest.raises(ValueError, match="read-only"):
        pose(MOTION).r1[0, 0] = 1.0
