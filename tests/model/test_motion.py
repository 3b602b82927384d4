"""A motion against the polynomials that it samples, on uneven steps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from des_cli.model.motion import (
    PIECE,
    DesiredMotion,
    Motion,
    Record,
    Shortfall,
    integrate_sides,
    mean_of_sides,
)

T = np.array([0.0, 0.1, 0.3, 0.35, 0.7, 1.0])
CUBICS = [np.polynomial.Polynomial(c) for c in ([1, 2, 3, 4], [0, -1, 0, 2], [5, 0, -1, -3])]


def along(t: np.ndarray, order: int) -> np.ndarray:
    return np.stack([each.deriv(order)(t) if order else each(t) for each in CUBICS], axis=1)


RATE = along(T, 1)
MOTION = Motion(T, along(T, 0), RATE[:-1], RATE[1:])
STEPPED = replace(MOTION, rate_start=RATE[:-1] + np.array([0.0, 0.5, 0.0]))


def shortfall(n: int) -> Shortfall:
    sides = np.zeros((n - 1, 2, 3))
    return Shortfall(sides, sides, sides, np.zeros((n, 3)))


def test_acceleration_and_jerk_are_those_of_cubics() -> None:
    # The mean of a linear acceleration over an interval is that in its middle.
    middles = 0.5 * (T[1:] + T[:-1])
    np.testing.assert_allclose(MOTION.acceleration, along(middles, 2), rtol=0, atol=1e-12)
    np.testing.assert_allclose(MOTION.jerk, along(T[1:-1], 3), rtol=0, atol=1e-11)
    np.testing.assert_array_equal(MOTION.step, np.diff(T))


def test_a_step_of_the_rate_stays_one_and_its_sample_has_the_mean() -> None:
    np.testing.assert_array_equal(MOTION.rate_step, np.zeros((4, 3)))
    np.testing.assert_array_equal(MOTION.rate, RATE)
    np.testing.assert_allclose(STEPPED.rate_step, [[0.0, 0.5, 0.0]] * 4, rtol=0, atol=1e-15)
    np.testing.assert_allclose(STEPPED.rate[1:-1, 1], RATE[1:-1, 1] + 0.25, rtol=0, atol=1e-15)
    assert STEPPED.rate[0, 1] == RATE[0, 1] + 0.5
    assert STEPPED.rate[-1, 1] == RATE[-1, 1]


def test_sides_are_start_and_end_of_each_interval() -> None:
    for k in range(len(T) - 1):
        np.testing.assert_array_equal(STEPPED.angle_sides[k], MOTION.angle[[k, k + 1]])
        expected = [STEPPED.rate_start[k], STEPPED.rate_end[k]]
        np.testing.assert_array_equal(STEPPED.rate_sides[k], expected)
    np.testing.assert_array_equal(mean_of_sides(MOTION.angle_sides), MOTION.angle)


def test_the_integral_is_exact_for_what_is_linear_between_samples() -> None:
    found = integrate_sides(MOTION.step, MOTION.rate_sides)
    for j in range(3):
        exact = quad(lambda t, j=j: np.interp(t, T, RATE[:, j]), 0.0, 1.0, points=T[1:-1])[0]
        assert found[j] == pytest.approx(exact, rel=1e-12)


def test_a_joint_is_taken_from_another_motion_with_angle_and_rates() -> None:
    still = Motion(T, np.ones((6, 3)), np.zeros((5, 3)), np.zeros((5, 3)))
    mixed = MOTION.with_joints([0, 2], still)
    for name in ("angle", "rate_start", "rate_end"):
        ours, source = getattr(MOTION, name), getattr(still, name)
        np.testing.assert_array_equal(getattr(mixed, name)[:, [0, 2]], source[:, [0, 2]])
        np.testing.assert_array_equal(getattr(mixed, name)[:, 1], ours[:, 1])
    assert MOTION.with_joints([], still) is MOTION


def test_arrays_that_do_not_fit_each_other_are_refused() -> None:
    with pytest.raises(ValueError, match="expected"):
        Motion(T, along(T, 0), RATE, RATE)
    with pytest.raises(ValueError, match="expected"):
        replace(shortfall(6), attitude=np.zeros((5, 3)))


def test_a_record_is_the_same_only_where_it_is_the_very_same() -> None:
    missing = shortfall(6)
    asked = DesiredMotion(MOTION, np.ones(6), np.zeros(6, bool), np.zeros((6, 3)), 0.0)
    asked = replace(asked, shortfall=missing)
    assert asked.record == Record(MOTION, missing)
    assert hash(asked.record) == hash(Record(MOTION, missing))
    assert asked.record != Record(MOTION)
    assert Record(MOTION) != Record(replace(MOTION))


def test_pieces_are_the_whole_with_neighbours():
    """Every sample is the own of one piece, which has two on either side where there are."""
    count = 2 * PIECE + 1
    t = np.linspace(0.0, 5.0, count)
    angle = np.cumsum(np.sin(t)[:, None] * [1.0, 2.0, 3.0], axis=0)
    rate = np.cos(t)[:, None] * [3.0, 2.0, 1.0]
    whole = Motion(t, angle, rate[:-1], rate[1:])
    pieces = list(whole.pieces())
    assert [piece.first for piece in pieces] == [0, PIECE, 2 * PIECE]
    found = [piece.motion.angle[piece.own] for piece in pieces]
    np.testing.assert_array_equal(np.concatenate(found), angle)
    found = [piece.motion.acceleration[piece.own_intervals] for piece in pieces]
    np.testing.assert_array_equal(np.concatenate(found), whole.acceleration)
    for piece in pieces:
        jerk = piece.motion.jerk
        begin = piece.first - piece.own.start
        np.testing.assert_array_equal(jerk, whole.jerk[begin : begin + len(jerk)])
    assert len(pieces[-1].motion.t) == 3
