"""Dual numbers against central and one-sided differences of their values."""

from __future__ import annotations

import ast
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from des_cli.profiles_in.dual import (
    ONE_ARGUMENT,
    OPERATORS,
    THREE_ARGUMENTS,
    TWO_ARGUMENTS,
    TWO_OR_MORE,
    Dual,
    Side,
)

H = 1e-6


def first(t: np.ndarray) -> Dual:
    """Positive and below 1, its rate of both signs."""
    return Dual(0.5 + 0.3 * np.sin(t), 0.3 * np.cos(t))


def second(t: np.ndarray) -> Dual:
    return Dual(1.1 + t**2 / 5, 2 * t / 5)


def chord(function: Callable[[np.ndarray], Dual], t: np.ndarray) -> np.ndarray:
    slope: np.ndarray = (function(t + H).value - function(t - H).value) / (2 * H)
    return slope


@pytest.mark.parametrize("name", ONE_ARGUMENT)
def test_a_function_of_one_number_has_its_value_and_its_slope(name: str) -> None:
    t = np.linspace(-3.0, 3.0, 25)
    of_their_own: dict[str, Any] = {"abs": math.fabs, "sign": np.sign}
    library = of_their_own.get(name) or getattr(math, name)

    def lifted(t: np.ndarray) -> Dual:
        return ONE_ARGUMENT[name](first(t), 1)

    np.testing.assert_allclose(lifted(t).value, [library(x) for x in first(t).value], rtol=1e-14)
    np.testing.assert_allclose(lifted(t).rate + 0 * t, chord(lifted, t), atol=1e-8)


@pytest.mark.parametrize("operator", OPERATORS)
def test_an_operator_counts_the_rates_of_both_sides(operator: type[ast.operator]) -> None:
    t = np.linspace(-3.0, 3.0, 25)
    for one, other in ((first, second), (second, first)):

        def lifted(t: np.ndarray, one: Callable = one, other: Callable = other) -> Dual:
            return OPERATORS[operator](one(t), other(t), 1)

        np.testing.assert_allclose(lifted(t).rate, chord(lifted, t), atol=1e-8)


@pytest.mark.parametrize(
    ("exponent", "value", "rate"),
    [(2.0, 9.0, -6.0), (-1.0, -1 / 3, -1 / 9), (3.0, -27.0, 27.0), (1.0, -3.0, 1.0), (0.0, 1.0, 0)],
)
def test_a_constant_power_of_a_negative_number(exponent: float, value: float, rate: float) -> None:
    constant = Dual(np.float64(exponent), np.float64(0.0))
    found = OPERATORS[ast.Pow](Dual(np.array([-3.0]), np.array([1.0])), constant, 1)
    np.testing.assert_allclose((found.value[0], found.rate[0]), (value, rate), rtol=1e-15)


def test_powers_of_zero_with_a_constant_exponent_have_a_rate() -> None:
    zero = Dual(np.zeros(1), np.ones(1))
    with np.errstate(divide="ignore", invalid="ignore"):
        for exponent, rate in ((0.0, 0.0), (1.0, 1.0), (2.0, 0.0)):
            power = OPERATORS[ast.Pow](zero, Dual(np.float64(exponent), np.float64(0.0)), 1)
            assert power.rate[0] == rate


SIDES: tuple[Side, ...] = (-1, 1)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("slopes", [(1.0, 2.0), (-1.0, 2.0), (3.0, -2.0), (-1.0, -2.0)])
def test_at_a_kink_the_rate_is_that_of_the_side_looked_from(
    side: Side, slopes: tuple[float, float]
) -> None:
    a, b = (Dual(np.zeros(1), np.full(1, slope)) for slope in slopes)
    step = side * 0.25
    values = [slope * step for slope in slopes]
    assert TWO_OR_MORE["max"](a, b, side).rate[0] == max(values) / step
    assert TWO_OR_MORE["min"](a, b, side).rate[0] == min(values) / step
    assert ONE_ARGUMENT["abs"](a, side).rate[0] == abs(values[0]) / step
    assert ONE_ARGUMENT["sign"](a, side).value[0] == math.copysign(1.0, values[0])


def test_away_from_a_kink_the_rate_is_that_of_the_one_that_counts() -> None:
    a = Dual(np.array([1.0, 5.0]), np.array([10.0, 20.0]))
    b = Dual(np.array([2.0, 3.0]), np.array([-1.0, -2.0]))
    for side in SIDES:
        assert TWO_OR_MORE["max"](a, b, side).value.tolist() == [2, 5]
        assert TWO_OR_MORE["max"](a, b, side).rate.tolist() == [-1, 20]
        assert TWO_OR_MORE["min"](a, b, side).value.tolist() == [1, 3]
        assert TWO_OR_MORE["min"](a, b, side).rate.tolist() == [10, -2]


def test_atan2_keeps_turning_through_all_quadrants() -> None:
    t = np.linspace(-3.0, 3.0, 25)
    y, x = Dual(2 * np.sin(t), 2 * np.cos(t)), Dual(2 * np.cos(t), -2 * np.sin(t))
    value, rate = TWO_ARGUMENTS["atan2"](y, x, 1)
    np.testing.assert_allclose(value, t, atol=1e-14)
    np.testing.assert_allclose(rate, 1.0, rtol=1e-13)


@pytest.mark.parametrize("name", THREE_ARGUMENTS)
@pytest.mark.parametrize(("start", "end"), [(2.0, 6.0), (6.0, 2.0)])
def test_steps_lead_from_0_to_1_and_rest_outside(name: str, start: float, end: float) -> None:
    first, last = (Dual(np.float64(at), np.float64(0.0)) for at in (start, end))

    def step(t: np.ndarray) -> Dual:
        return THREE_ARGUMENTS[name](first, last, Dual(t, np.float64(1.0)), 1)

    value, rate = step(np.array([0.0, 2.0, 4.0, 6.0, 9.0]))
    rising = [0, 0, 0.5, 1, 1]
    np.testing.assert_array_equal(value, rising if start < end else rising[::-1])
    np.testing.assert_array_equal(rate[[0, 1, 3, 4]], 0.0)
    inside = np.linspace(2.1, 5.9, 39)
    np.testing.assert_allclose(step(inside).rate, chord(step, inside), atol=1e-9)


def test_a_smootherstep_starts_and_ends_without_a_second_derivative() -> None:
    first, last = (Dual(np.float64(at), np.float64(0.0)) for at in (0.0, 1.0))
    near = Dual(np.array([1e-4, 1 - 1e-4]), np.ones(2))
    bent = {name: step(first, last, near, 1).rate / 1e-4 for name, step in THREE_ARGUMENTS.items()}
    np.testing.assert_allclose(bent["smoothstep"], 6.0, rtol=1e-3)
    np.testing.assert_allclose(bent["smootherstep"], 0.0, atol=1e-2)


@pytest.mark.parametrize("name", THREE_ARGUMENTS)
def test_moving_ends_of_a_step_count_in_its_derivative(name: str) -> None:
    def step(t: np.ndarray) -> Dual:
        start, end = Dual(t / 9, np.float64(1 / 9)), Dual(3 + t**2 / 10, t / 5)
        return THREE_ARGUMENTS[name](start, end, Dual(1 + t / 2, np.float64(0.5)), 1)

    t = np.linspace(0.5, 2.5, 9)
    np.testing.assert_allclose(step(t).rate, chord(step, t), atol=1e-8)
