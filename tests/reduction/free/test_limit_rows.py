"""Limits on control points against the spline that they are limits of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machine import JointLimits
from des_cli.reduction.free.limit_rows import LimitRows, Tie
from des_cli.solver.band import SymmetricBand
from des_cli.solver.spline import Ends, SplineGrid

GRID = SplineGrid(0.5, 0.2, 9)
LIMITS = (
    JointLimits(np.inf, 5.0, 0.7, 2.0),
    JointLimits(6.0, 3.0, 2.5, np.inf),
    JointLimits(4.0, 2.0, 5.0, 10.0),
)
NO, YES = np.zeros(3, dtype=bool), np.ones(3, dtype=bool)
FREE = Ends(NO, NO, NO, NO, NO)
NAMES = ("angle", "rate", "acceleration", "jerk")
ALONE = {
    name: tuple(
        JointLimits(**{**dict.fromkeys(NAMES, np.inf), name: getattr(limit, name)})
        for limit in LIMITS
    )
    for name in NAMES
}


@pytest.fixture
def rng():
    return np.random.default_rng(4)


@pytest.fixture
def control(rng):
    return np.cumsum(rng.normal(size=(GRID.points, 3)), axis=0)


def rows_of(limits=LIMITS, ends=FREE, base=None, **further):
    return LimitRows(
        GRID, np.zeros((GRID.points, 3)) if base is None else base, limits, ends, **further
    )


def largest_share(rows, deviation):
    """The largest limited quantity over its bound."""
    return np.max(np.abs(rows.value(deviation)) / rows.bounds)


def sampled_share(control, name):
    """The same of the spline on a fine grid."""
    order = NAMES.index(name)
    t = np.linspace(GRID.start, GRID.start + GRID.duration, 9 * 60 + 1)
    value = np.abs(GRID.values(control, t, order)).max(axis=0)
    return np.max(value / [getattr(limit, name) for limit in LIMITS])


@pytest.mark.parametrize("name", ["acceleration", "jerk"])
def test_accelerations_and_jerks_are_exact(name, control):
    share = largest_share(rows_of(ALONE[name]), control)
    assert share == pytest.approx(sampled_share(control, name), rel=1e-12)


@pytest.mark.parametrize("name", ["angle", "rate"])
def test_rates_and_angles_lie_inside_their_hull(name, control):
    for scale in (1.0, -0.3):
        share = largest_share(rows_of(ALONE[name]), scale * control)
        sampled = sampled_share(scale * control, name)
        assert sampled <= share * (1.0 + 1e-12)
        # a hull of four control points is not wider than what they differ by
        assert share <= sampled + np.max(
            np.abs(np.diff(GRID.differences(scale * control, NAMES.index(name)), axis=0))
            / [getattr(limit, name) for limit in LIMITS]
        )


@pytest.mark.parametrize("name", NAMES)
def test_no_interval_is_left_out(name):
    """Splines that live on a few control points, at the ends too."""
    rng, rows, exact = np.random.default_rng(9), rows_of(ALONE[name]), name in NAMES[2:]
    for first in range(GRID.points - 3):
        for _ in range(30):
            control = np.zeros((GRID.points, 3))
            control[first : first + 4] = rng.normal(size=(4, 3))
            share, sampled = largest_share(rows, control), sampled_share(control, name)
            assert share >= sampled * (1.0 - 1e-12)
            assert not exact or share == pytest.approx(sampled, rel=1e-12)


def test_a_motion_may_begin_as_fast_as_the_machine_may_turn():
    """The rate falls from its limit on: its control point before the start is beyond it."""
    t, h = GRID.greville - GRID.start, GRID.step
    base = np.zeros((GRID.points, 3))
    base[:, 1] = LIMITS[1].rate * t - 0.5 * (t**2 - h**2 / 3.0)
    assert GRID.values(base, GRID.knots[:1], 1)[0, 1] == pytest.approx(LIMITS[1].rate)
    assert GRID.differences(base, 1)[0, 1] > LIMITS[1].rate
    rows = rows_of(ALONE["rate"], base=base)
    assert largest_share(rows, np.zeros_like(base)) == pytest.approx(1.0)
    assert largest_share(rows, 0.01 * base) == pytest.approx(1.01)  # and no faster


@pytest.mark.parametrize("end", ["start", "end"])
@pytest.mark.parametrize(("what", "order"), [("value", 0), ("rate", 1)])
def test_the_tips_are_limited_unless_they_are_kept(end, what, order, control):
    limits = ALONE[NAMES[order]]
    free, kept = rows_of(limits), rows_of(limits, replace(FREE, **{f"{end}_{what}": YES}))
    fewer = np.count_nonzero(np.isfinite([getattr(limit, NAMES[order]) for limit in limits]))
    assert len(kept.bounds) == len(free.bounds) - fewer
    tip = GRID.values(control, GRID.knots[[0 if end == "start" else -1]], order)[0]
    for joint in np.flatnonzero(np.isfinite([getattr(each, NAMES[order]) for each in limits])):
        assert np.any(np.isclose(free.value(control), tip[joint], rtol=1e-12))
        assert not np.any(np.isclose(kept.value(control), tip[joint], rtol=1e-12))


def test_the_margin_is_left_unused(control):
    plain, eased = rows_of(), rows_of(margin=0.01)
    np.testing.assert_allclose(eased.bounds, 0.99 * plain.bounds)
    np.testing.assert_array_equal(eased.value(control), plain.value(control))


def test_joints_that_are_held_and_limits_that_are_none(control):
    endless = (JointLimits(np.inf, np.inf, np.inf),) * 3
    nothing = rows_of(endless)
    assert nothing.bounds.shape == nothing.value(control).shape == (0,)
    np.testing.assert_array_equal(nothing.adjoint(np.zeros(0)), np.zeros((GRID.points, 3)))
    held = rows_of(ends=replace(FREE, held=np.array([False, True, False])))
    moved = np.zeros_like(control)
    moved[:, 1] = control[:, 1]
    assert not held.change(moved).any()
    assert held.change(control).any()
    assert rows_of(ends=replace(FREE, held=YES)).bounds.size == 0


def test_ties_are_rates_at_their_times(control):
    end = GRID.start + GRID.duration
    ties = (Tie(1.13, 1, 1e-7), Tie(GRID.start, 0, 1e-6), Tie(end, 2, 1e-5))
    rows = rows_of(ties=ties)
    np.testing.assert_array_equal(rows.bounds[-3:], [tie.bound for tie in ties])
    expected = [GRID.values(control, np.array([tie.time]), 1)[0, tie.joint] for tie in ties]
    np.testing.assert_allclose(rows.value(control)[-3:], expected, rtol=1e-12)


CASES = {
    "free": (FREE, ()),
    "matched": (Ends(YES, YES, NO, YES, NO), (Tie(1.3, 0, 1e-7),)),
    "held": (Ends(YES, NO, NO, NO, np.array([False, False, True])), (Tie(1.3, 1, 1e-7),)),
}


@pytest.fixture(params=list(CASES.values()), ids=list(CASES))
def rows(request, control):
    ends, ties = request.param
    return rows_of(ends=ends, ties=ties, base=control)


def matrix_of(rows):
    size = GRID.points * 3
    return np.stack([rows.change(e.reshape(-1, 3)) for e in np.eye(size)], axis=1)


def test_values_are_affine(rows, control, rng):
    deviation = rng.normal(size=control.shape)
    assert rows.value(deviation).shape == rows.bounds.shape
    expected = rows.value(np.zeros_like(control)) + rows.change(deviation)
    np.testing.assert_allclose(rows.value(deviation), expected, rtol=0, atol=1e-12)
    base = rows.change(control)
    np.testing.assert_allclose(rows.value(np.zeros_like(control)), base, rtol=0, atol=1e-12)


def test_the_adjoint(rows, rng):
    multiplier = rng.normal(size=rows.bounds.shape)
    expected = matrix_of(rows).T @ multiplier
    found = rows.adjoint(multiplier).ravel()
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


def test_stiffness_is_added(rows, rng):
    stiffness = rng.random(rows.bounds.shape)
    band = SymmetricBand(GRID.points, 3)
    band.data[:, :, 0] = 1.0
    rows.add_to(band, stiffness)
    matrix = matrix_of(rows)
    expected = np.eye(GRID.points * 3) + matrix.T @ (stiffness[:, None] * matrix)
    for unit in np.eye(GRID.points * 3):
        found = band.times(unit.reshape(-1, 3)).ravel()
        np.testing.assert_allclose(
            found, expected @ unit, rtol=0, atol=1e-13 * np.abs(expected).max()
        )
