"""Inequalities: their derivatives by differences, their values by the machine's limits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.reduction.constraints import MARGIN, AngleRows
from des_cli.reduction.transcription import Transcription
from tests.support.differences import along


@pytest.fixture(params=["desired", "adapted"])
def grid(request, wave, pose):
    motion = wave([[0.5, 0.2, 0.1], [0.2, 0.3, 0.1], [0.2, -0.2, 0.15]], intervals=12)
    limits = (replace(DES.limits[0], jerk=np.inf), *(replace(x, jerk=4.0) for x in DES.limits[1:]))
    machine = replace(DES, limits=limits)
    problem = pose(motion, control="per-joint", jacobian=request.param, machine=machine)
    return Transcription(problem)


@pytest.fixture
def x(grid):
    return grid.desired + 0.1 * np.random.default_rng(4).normal(size=grid.desired.shape)


def test_jacobians_and_curvatures(grid, x):
    rng = np.random.default_rng(5)
    assert len(grid.rows) == 4
    for rows in grid.rows:
        move, multiplier = rng.normal(size=x.shape), rng.normal(size=rows.value(x).shape)

        def pull_back(at, rows=rows, multiplier=multiplier):
            """The gradient of multiplier' value."""
            force = np.zeros_like(at)
            for ahead, block in enumerate(rows.jacobian(at)):
                np.add.at(force, rows.node + ahead, (multiplier[:, None, :] @ block)[:, 0])
            return force

        slope = np.sum(along(rows.value, x, move) * multiplier)
        assert np.sum(pull_back(x) * move) == pytest.approx(slope, rel=1e-8)
        curvature = rows.curvature(x, multiplier)
        expected = 0.0 if curvature is None else (curvature @ move[:, :, None])[:, :, 0]
        np.testing.assert_allclose(along(pull_back, x, move), expected + 0.0 * move, atol=1e-7)


def test_values_are_shares_of_the_limits(grid, x):
    motion = grid.motion(x)
    rate, acceleration, angle = (
        np.array([getattr(limit, name) for limit in DES.limits])
        for name in ("rate", "acceleration", "angle")
    )
    at_samples = np.vstack([motion.rate_start, motion.rate_end[-1:]])
    expected = [
        at_samples / rate,
        (motion.rate_end - motion.rate_start) / motion.step[:, None] / acceleration,
        motion.angle[:, 1:] / angle[1:],  # the arm turns endlessly
        motion.jerk[:, 1:] / 4.0,  # and has no limit on its jerk
    ]
    for rows, values in zip(grid.rows, expected, strict=True):
        found = rows.value(x)
        if rows is grid.rows[2]:  # the first angle is what it is
            np.testing.assert_array_equal(found[0], 0.0)
            found, values = found[1:], values[1:]
        # the middle of an angle's bounds is off zero where one of them is drawn in
        near = 0.03 if rows is grid.rows[2] else 1e-12
        np.testing.assert_allclose(found, values, rtol=0.06, atol=near)
        outside = np.abs(values) > 1.0
        assert (np.abs(found[outside]) > 1.0).all()  # drawn in, never out


LIMIT = 2.0 * np.pi * (1.0 - MARGIN)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_an_angle_leaves_room_for_the_parabola_where_it_bulges(sign):
    # rows 0.1 s apart but for one of 5 s; the fork's rate turns round in the fourth interval
    t = np.array([0.0, 0.1, 0.2, 0.3, 0.4, 5.4, 5.5])
    rate = np.zeros((6, 2, 3))
    rate[3, :, 1] = 0.5 * sign, -0.5 * sign
    desired = Motion(t, np.zeros((7, 3)), rate[:, 0], rate[:, 1])
    angles = AngleRows(DES, desired, 4, np.zeros((7, 3), dtype=bool))
    bulge = DES.limits[1].acceleration * 0.1**2 / 8.0
    x = np.zeros((7, 4))
    x[:, 1] = sign * LIMIT
    x[[3, 4], 1] -= sign * bulge
    np.testing.assert_allclose(angles.value(x)[:, 0], sign, atol=1e-12)
    x[:, 1] = -sign * LIMIT  # to the other side nothing bulges
    np.testing.assert_allclose(angles.value(x)[:, 0], -sign, atol=1e-12)


def test_a_desired_angle_at_its_limit_keeps_its_bound():
    # a parabola that touches the limit between rows 5 s apart: its ends are far inside
    # of what the acceleration limit alone could make
    t = np.array([0.0, 5.0])
    rate = np.array([[[0.0, 0.2, 0.0], [0.0, -0.2, 0.0]]])
    angle = np.tile([0.0, 2.0 * np.pi - 0.25, 0.0], (2, 1))
    motion = Motion(t, angle, rate[:, 0], rate[:, 1])
    rows = AngleRows(DES, motion, 4, np.zeros((2, 3), dtype=bool))
    x = np.hstack([angle, np.ones((2, 1))])
    assert (np.abs(rows.value(x)) <= 1.0 + 1e-12).all()


def test_an_angle_that_no_factor_changes_may_stand_at_its_limit(pose):
    t = np.linspace(0.0, 1.0, 11)
    angle = np.zeros((11, 3))
    angle[:, 0], angle[:, 1] = t, 2.0 * np.pi
    rate = np.tile([1.0, 0.0, 0.0], (10, 1))
    angle[6:, 2] = 0.01 * (t[6:] - t[5])  # the cab begins to turn at the sixth sample
    rate[5:, 2] = 0.01
    grid = Transcription(pose(Motion(t, angle, rate, rate), control="per-joint", machine=DES))
    of_angles = grid.rows[2]
    moved = grid.desired.copy()
    moved[:, 1:3] += 1.0
    found = of_angles.value(moved)
    np.testing.assert_array_equal(found[:, 0], 0.0)
    np.testing.assert_array_equal(found[:6, 1], 0.0)
    assert (found[6:, 1] > 0.1).all()
    # where the rates follow from the angles, a joint that was to stand may move
    adapted = Transcription(replace(grid.problem, jacobian="adapted"))
    assert (adapted.rows[2].value(moved)[1:] > 0.1).all()
    np.testing.assert_array_equal(adapted.rows[2].value(moved)[0], 0.0)


@pytest.mark.parametrize("ends", ["free", "match-start"])
def test_a_rate_that_is_kept_at_its_limit_has_no_row(pose, ends):
    t = np.linspace(0.0, 1.0, 11)
    fastest = DES.limits[0].rate
    rate = np.tile([fastest, 0.1, 0.0], (10, 1))
    grid = Transcription(pose(Motion(t, t[:, None] * rate[0], rate, rate), machine=DES, ends=ends))
    shares = grid.rows[0].value(grid.desired)
    assert shares[0, 0] == (0.0 if ends == "match-start" else 1.0)
    np.testing.assert_allclose(shares[1:, 0], 1.0, rtol=1e-15)
    assert (grid.rows[0].value(1.001 * grid.desired)[1:, 0] > 1.0).all()
