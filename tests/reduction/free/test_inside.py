"""A point inside budgets and bounds, from one that is outside."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machine import OccupantBounds
from des_cli.model.machines import DES
from des_cli.reduction.free.inside import LITTLE_ROOM, ROOM, find_inside
from tests.support.free_motions import (
    JOINTS,
    RATE,
    TURNING,
    G,
    fit,
    program_of,
    smooth,
    task_of,
    wiggle,
)

INTERVALS = 24
BUDGETS = {G: 0.02, RATE: 0.05}
TIGHT = {G: 2e-4, RATE: 1e-3}
SLOW = replace(
    DES, limits=(replace(DES.limits[0], acceleration=0.05), DES.limits[1], DES.limits[2])
)


def worst(program, x):
    values = program.values(x)
    return float(np.max(np.concatenate([values.budgets, values.local])))


def inside_limits(program, x):
    return np.all(np.abs(program.linear(x)) < program.bounds)


def far(program):
    """A vector that keeps limits and ends, and none of the budgets."""
    x = wiggle(program, 1.0)
    size = np.max(np.abs(program.linear_change(x)) / program.bounds)
    base = np.max(np.abs(program.linear(np.zeros_like(x))) / program.bounds)
    return x * (0.9 * (1.0 - base) / size)


def test_a_point_inside_is_kept():
    program = program_of(task_of(smooth(), BUDGETS), INTERVALS)
    x = np.zeros(program.size)
    assert find_inside(program, x) is x


@pytest.mark.parametrize(
    "budget",
    [TIGHT, {TURNING: 4e-3}, {G: 2e-4, JOINTS: 5e-5}],
    ids=["felt", "turning", "joints"],
)
def test_from_far_outside(budget):
    program = program_of(task_of(smooth(), budget), INTERVALS)
    x = far(program)
    assert worst(program, x) > 1.5
    assert inside_limits(program, x)
    told = []
    found = find_inside(program, x, told.append)
    assert found is not None
    assert told
    assert worst(program, found) < 1.0 - LITTLE_ROOM
    assert inside_limits(program, found)
    kept = program.problem.ends.full(program.control(found))
    grid = program.problem.grid
    tip = grid.values(program.control(found), grid.knots[:1])
    np.testing.assert_allclose(tip, 0.0, atol=1e-12)
    assert kept.shape == program.control(found).shape


def test_bounds_on_what_the_occupant_gets():
    """The desired motion itself is beyond one."""
    plain = program_of(task_of(smooth(), {G: 0.3}), INTERVALS)
    forms, base = plain.problem.forms, plain._base[0]
    peak = np.max(np.linalg.norm(forms.at(base).twist_rate[:3], axis=0))
    bounded = replace(DES, occupant=OccupantBounds(angular_acceleration=0.8 * float(peak)))
    program = program_of(task_of(smooth(), {G: 0.3}, bounded), INTERVALS)
    start = np.zeros(program.size)
    assert worst(program, start) > 1.4  # squared
    found = find_inside(program, start)
    assert found is not None
    assert worst(program, found) < 1.0 - LITTLE_ROOM


def test_what_is_nearly_spent_gets_room():
    program = program_of(task_of(smooth(), TIGHT), INTERVALS)
    x = far(program)
    low, high = 0.0, 1.0
    for _ in range(60):  # to the edge along the way there
        middle = 0.5 * (low + high)
        low, high = (middle, high) if worst(program, middle * x) < 1.0 else (low, middle)
    edge = low * x
    assert worst(program, edge) > 1.0 - LITTLE_ROOM
    found = find_inside(program, edge)
    assert worst(program, found) < 1.0 - ROOM


@pytest.mark.parametrize("gy", [-0.65, -0.5])
def test_a_bound_that_a_simple_motion_keeps(gy):
    bounded = replace(DES, occupant=OccupantBounds(gy=(gy, 0.5)))
    program = program_of(task_of(smooth(), {G: 0.3, RATE: 0.5}, bounded), INTERVALS)
    start = np.zeros(program.size)
    assert worst(program, start) > 1.0
    # turning the cab further, ever faster, keeps everything with room to spare
    grid = program.problem.grid
    turned = np.zeros((grid.points, 3))
    turned[:, 2] = 0.65 * (np.maximum(grid.greville - grid.start, 0.0) / grid.duration) ** 4
    turned = program.problem.ends.full(turned).ravel()
    assert worst(program, turned) < 0.8
    assert inside_limits(program, turned)
    assert find_inside(program, start) is not None


def test_there_is_none_where_limits_forbid_it():
    """An arm that may hardly change its rate cannot follow this closely."""
    task = task_of(smooth(amplitude=[[0.8, 0.4], [0, 0], [0, 0.1]]), {RATE: 0.01}, SLOW)
    assert not fit(task, INTERVALS).trouble
    program = program_of(task, INTERVALS)
    start = np.zeros(program.size)
    assert worst(program, start) > 1.0
    assert find_inside(program, start) is None


def test_there_is_none_from_outside_the_limits():
    program = program_of(task_of(smooth(), BUDGETS), INTERVALS)
    assert find_inside(program, 100.0 * far(program)) is None
