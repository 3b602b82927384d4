"""Grids, the joints of segments on them, and commands sampled on both sides."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.profiles_in.expression import parse_expression
from des_cli.profiles_in.sampling import (
    Piece,
    SamplingError,
    first_jump,
    grid_with_joints,
    regular_grid,
    sample_middle,
    sample_sides,
)


def test_grid_times_are_the_doubles_of_their_decimals() -> None:
    t = regular_grid(0.0, 10.0, 0.01)
    assert t.tolist() == [float(f"{k / 100:.2f}") for k in range(1001)]
    assert regular_grid(-0.3, 0.3, 0.1).tolist() == [-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3]


def test_the_last_step_is_shorter_where_the_step_does_not_divide() -> None:
    assert regular_grid(0.0, 1.0, 0.3).tolist() == [0.0, 0.3, 0.6, 0.9, 1.0]
    assert regular_grid(0.0, 1.0, 5.0).tolist() == [0.0, 1.0]
    assert regular_grid(0.0, 0.9999999999999999, 0.1)[-2:].tolist() == [0.9, 0.9999999999999999]


def test_times_that_no_decimal_grid_holds_still_increase() -> None:
    t = regular_grid(1e-300, 1.0, 1 / 3)
    assert (np.diff(t) > 0).all()
    assert t[-1] == 1.0


def test_joints_between_samples_are_inserted_and_those_on_samples_are_not() -> None:
    t = np.array([0.0, 1.0, 2.0, 3.0])
    assert grid_with_joints(t, [0.0, 1.0, 2.5, 2.5, 3.0, -1.0, 9.0]).tolist() == [0, 1, 2, 2.5, 3]
    assert grid_with_joints(t, [1.0 + 1e-9, 2.0 - 1e-9]).tolist() == t.tolist()


def test_each_interval_takes_the_piece_that_covers_it() -> None:
    pieces = (
        Piece(0.0, 1.0, parse_expression("t")),
        Piece(1.0, 2.0, parse_expression("10 - 3*t")),
    )
    sides = sample_sides(pieces, np.array([0.0, 0.5, 1.0, 2.0]), 2.0, rates=True)
    assert sides.start.tolist() == [0.0, 1.0, 14.0]
    assert sides.end.tolist() == [1.0, 2.0, 8.0]
    assert sides.rate_start.tolist() == [2.0, 2.0, -6.0]
    assert sides.rate_end.tolist() == [2.0, 2.0, -6.0]
    assert sample_middle(pieces, np.array([0.0, 1.0, 2.0]), 2.0).tolist() == [1.0, 11.0]
    assert first_jump(sides, np.array([0.0, 0.5, 1.0, 2.0]), 1e-9) == (1.0, 2.0, 14.0)


def test_a_kink_on_a_sample_is_a_step_of_the_rate_and_no_jump() -> None:
    t = regular_grid(0.0, 1.0, 0.01)
    sides = sample_sides((Piece(0, 1, parse_expression("max(0, t - 0.35)")),), t, 1.0, rates=True)
    assert sides.rate_end[34] == 0.0
    assert sides.rate_start[35] == 1.0
    assert first_jump(sides, t, 1e-9) is None


def test_the_first_time_without_a_value_is_named() -> None:
    t = regular_grid(0.0, 2.0, 0.5)
    with pytest.raises(SamplingError, match=r"no finite value at t = 1\.5 s"):
        sample_sides((Piece(0, 2, parse_expression("1/(t - 1.5)")),), t, 1.0, rates=False)
    with pytest.raises(SamplingError, match=r"rate of the expression .* at t = 0 s"):
        sample_sides((Piece(0, 2, parse_expression("sqrt(t)")),), t, 1.0, rates=True)
    with pytest.raises(SamplingError, match=r"beyond 1e\+06 rad or rad/s at t = 1 s"):
        sample_sides((Piece(0, 2, parse_expression("exp(20*t)")),), t, 1.0, rates=False)
    assert sample_sides((Piece(0, 2, parse_expression("sqrt(t)")),), t, 1.0, rates=False).end[-1]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("9**9**9", "comes to a number that is too large at t = 0 s"),
        ("9**9**9 - 9**9**9", "comes to a number that is too large at t = 0 s"),
        ("exp(1000*(t - 0.5))", "beyond 1e+06 rad or rad/s at t = 1 s"),
        ("0*exp(1000*t)", "comes to a number that is too large at t = 1 s"),
        ("1/exp(-1000*t)", "no finite value at t = 1 s (a division by zero, or outside"),
        ("log(-9**9)", "no finite value at t = 0 s (a division by zero, or outside"),
    ],
)
def test_why_there_is_no_value_is_said(text: str, words: str) -> None:
    t = regular_grid(0.0, 2.0, 1.0)
    with pytest.raises(SamplingError) as caught:
        sample_sides((Piece(0, 2, parse_expression(text)),), t, 1.0, rates=False)
    assert words in str(caught.value)
    with pytest.raises(SamplingError, match=r"too large at t = 0\.5 s"):
        sample_middle((Piece(0, 1, parse_expression("exp(2000*t)")),), t[:2], 1.0)
