"""Values of functions of time with their exact first derivatives: forward-mode dual numbers.

At a kink of ``abs``, ``min`` or ``max`` the derivative depends on the side
from which the time is approached, as does the value of ``sign`` at its jump:
every evaluation therefore says from which side it looks.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np

Side: TypeAlias = Literal[-1, 1]
"""+1: at and just after the times given; -1: at and just before them."""


class Dual(NamedTuple):
    """A value and its derivative with respect to time."""

    value: Any
    rate: Any


def _sum(a: Dual, b: Dual, side: Side) -> Dual:
    return Dual(a.value + b.value, a.rate + b.rate)


def _difference(a: Dual, b: Dual, side: Side) -> Dual:
    return Dual(a.value - b.value, a.rate - b.rate)


def _product(a: Dual, b: Dual, side: Side) -> Dual:
    return Dual(a.value * b.value, a.rate * b.value + a.value * b.rate)


def _quotient(a: Dual, b: Dual, side: Side) -> Dual:
    value = a.value / b.value
    return Dual(value, (a.rate - value * b.rate) / b.value)


def _power(base: Dual, exponent: Dual, side: Side) -> Dual:
    value = np.power(base.value, exponent.value)
    # A constant exponent admits a base of either sign; the general rule needs log(base).
    if np.ndim(exponent.rate) == 0 and exponent.rate == 0:
        slope = np.power(base.value, exponent.value - 1.0)
        rate = np.where(exponent.value == 0, 0.0, exponent.value * slope * base.rate)
    else:
        rate = value * (
            exponent.rate * np.log(base.value) + exponent.value * base.rate / base.value
        )
    return Dual(value, rate)


def _absolute(a: Dual, side: Side) -> Dual:
    rate = np.where(a.value == 0, side * np.abs(a.rate), np.sign(a.value) * a.rate)
    return Dual(np.abs(a.value), rate)


def _sign(a: Dual, side: Side) -> Dual:
    value = np.where(a.value == 0, np.sign(side * a.rate), np.sign(a.value))
    return Dual(value, np.float64(0.0))


def _maximum(a: Dual, b: Dual, side: Side) -> Dual:
    tie = side * np.maximum(side * a.rate, side * b.rate)
    rate = np.where(a.value > b.value, a.rate, np.where(a.value < b.value, b.rate, tie))
    return Dual(np.maximum(a.value, b.value), rate)


def _minimum(a: Dual, b: Dual, side: Side) -> Dual:
    largest = _maximum(Dual(-a.value, -a.rate), Dual(-b.value, -b.rate), side)
    return Dual(-largest.value, -largest.rate)


def _fraction(first: Dual, last: Dual, x: Dual) -> Dual:
    """How far x has come from ``first`` to ``last``, held within 0 and 1."""
    span, done = last.value - first.value, x.value - first.value
    raw = done / span
    rate = (x.rate - first.rate - raw * (last.rate - first.rate)) / span
    return Dual(np.clip(raw, 0.0, 1.0), rate)


def _smoothstep(first: Dual, last: Dual, x: Dual, side: Side) -> Dual:
    u, rate = _fraction(first, last, x)
    return Dual(u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u) * rate)


def _smootherstep(first: Dual, last: Dual, x: Dual, side: Side) -> Dual:
    u, rate = _fraction(first, last, x)
    return Dual(u**3 * (10.0 + u * (6.0 * u - 15.0)), 30.0 * (u * (1.0 - u)) ** 2 * rate)


def _atan2(y: Dual, x: Dual, side: Side) -> Dual:
    rate = (x.value * y.rate - y.value * x.rate) / (x.value**2 + y.value**2)
    return Dual(np.arctan2(y.value, x.value), rate)


def _smooth(
    function: Callable[[Any], Any], derivative: Callable[[Any], Any]
) -> Callable[[Dual, Side], Dual]:
    """Lift a differentiable function of one number to dual numbers."""
    return lambda a, side: Dual(function(a.value), derivative(a.value) * a.rate)


OPERATORS: dict[type[ast.operator], Callable[[Dual, Dual, Side], Dual]] = {
    ast.Add: _sum,
    ast.Sub: _difference,
    ast.Mult: _product,
    ast.Div: _quotient,
    ast.Pow: _power,
}
ONE_ARGUMENT: dict[str, Callable[[Dual, Side], Dual]] = {
    "sin": _smooth(np.sin, np.cos),
    "cos": _smooth(np.cos, lambda x: -np.sin(x)),
    "tan": _smooth(np.tan, lambda x: 1.0 / np.cos(x) ** 2),
    "asin": _smooth(np.arcsin, lambda x: 1.0 / np.sqrt(1.0 - x * x)),
    "acos": _smooth(np.arccos, lambda x: -1.0 / np.sqrt(1.0 - x * x)),
    "atan": _smooth(np.arctan, lambda x: 1.0 / (1.0 + x * x)),
    "sinh": _smooth(np.sinh, np.cosh),
    "cosh": _smooth(np.cosh, np.sinh),
    "tanh": _smooth(np.tanh, lambda x: 1.0 - np.tanh(x) ** 2),
    "exp": _smooth(np.exp, np.exp),
    "log": _smooth(np.log, lambda x: 1.0 / x),
    "sqrt": _smooth(np.sqrt, lambda x: 0.5 / np.sqrt(x)),
    "abs": _absolute,
    "sign": _sign,
}
TWO_ARGUMENTS = {"atan2": _atan2}
TWO_OR_MORE = {"min": _minimum, "max": _maximum}
THREE_ARGUMENTS = {"smoothstep": _smoothstep, "smootherstep": _smootherstep}
