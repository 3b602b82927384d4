"""Arithmetic in ``t``: parsed against a whitelist, never run as Python.

An expression is evaluated over whole arrays of times and brings its exact
first derivative along (forward-mode dual numbers), so the rate of a position
command owes nothing to finite differences.

At a kink of ``abs``, ``min`` or ``max`` the derivative depends on the side
from which the time is approached, as does the value of ``sign`` at its jump:
every evaluation therefore says from which side it looks.
"""

from __future__ import annotations

import ast
import math
import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.profiles_in.wording import did_you_mean, one_of, shown

Side: TypeAlias = Literal[-1, 1]
"""+1: at and just after the times given; -1: at and just before them."""

MAX_LENGTH = 1000
"""Characters; a maneuver's expressions have some tens of them."""

MAX_DEPTH = 50
"""Levels of nesting, far below what would exhaust the interpreter's stack."""

_CHUNK = 1 << 15
"""Samples evaluated at once: bounds the memory of a deep expression."""

_ALLOWED_TEXT = re.compile(r"[0-9A-Za-z_.+\-*/(),\s]")
_CONSTANTS = {"pi": math.pi, "e": math.e}


class ExpressionError(ValueError):
    """An expression that is not arithmetic in ``t``; the message says why."""


class _Dual(NamedTuple):
    """A value and its derivative with respect to time."""

    value: Any
    rate: Any


def _power(base: _Dual, exponent: _Dual, side: Side) -> _Dual:
    value = np.power(base.value, exponent.value)
    # A constant exponent admits a base of either sign; the general rule needs log(base).
    if np.ndim(exponent.rate) == 0 and exponent.rate == 0:
        slope = np.power(base.value, exponent.value - 1.0)
        rate = np.where(exponent.value == 0, 0.0, exponent.value * slope * base.rate)
    else:
        rate = value * (
            exponent.rate * np.log(base.value) + exponent.value * base.rate / base.value
        )
    return _Dual(value, rate)


def _absolute(a: _Dual, side: Side) -> _Dual:
    rate = np.where(a.value == 0, side * np.abs(a.rate), np.sign(a.value) * a.rate)
    return _Dual(np.abs(a.value), rate)


def _sign(a: _Dual, side: Side) -> _Dual:
    value = np.where(a.value == 0, np.sign(side * a.rate), np.sign(a.value))
    return _Dual(value, np.float64(0.0))


def _maximum(a: _Dual, b: _Dual, side: Side) -> _Dual:
    tie = side * np.maximum(side * a.rate, side * b.rate)
    rate = np.where(a.value > b.value, a.rate, np.where(a.value < b.value, b.rate, tie))
    return _Dual(np.maximum(a.value, b.value), rate)


def _minimum(a: _Dual, b: _Dual, side: Side) -> _Dual:
    largest = _maximum(_Dual(-a.value, -a.rate), _Dual(-b.value, -b.rate), side)
    return _Dual(-largest.value, -largest.rate)


def _fraction(first: _Dual, last: _Dual, x: _Dual) -> _Dual:
    """How far x has come from ``first`` to ``last``, held within 0 and 1."""
    span, done = last.value - first.value, x.value - first.value
    raw = done / span
    rate = (x.rate - first.rate - raw * (last.rate - first.rate)) / span
    return _Dual(np.clip(raw, 0.0, 1.0), rate)


def _smoothstep(first: _Dual, last: _Dual, x: _Dual, side: Side) -> _Dual:
    u, rate = _fraction(first, last, x)
    return _Dual(u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u) * rate)


def _smootherstep(first: _Dual, last: _Dual, x: _Dual, side: Side) -> _Dual:
    u, rate = _fraction(first, last, x)
    return _Dual(u**3 * (10.0 + u * (6.0 * u - 15.0)), 30.0 * (u * (1.0 - u)) ** 2 * rate)


def _atan2(y: _Dual, x: _Dual, side: Side) -> _Dual:
    rate = (x.value * y.rate - y.value * x.rate) / (x.value**2 + y.value**2)
    return _Dual(np.arctan2(y.value, x.value), rate)


def _smooth(
    function: Callable[[Any], Any], derivative: Callable[[Any], Any]
) -> Callable[[_Dual, Side], _Dual]:
    """Lift a differentiable function of one number to dual numbers."""
    return lambda a, side: _Dual(function(a.value), derivative(a.value) * a.rate)


_ONE_ARGUMENT: dict[str, Callable[[_Dual, Side], _Dual]] = {
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
_TWO_ARGUMENTS = {"atan2": _atan2}
_TWO_OR_MORE = {"min": _minimum, "max": _maximum}
_THREE_ARGUMENTS = {"smoothstep": _smoothstep, "smootherstep": _smootherstep}
FUNCTIONS: tuple[str, ...] = (
    *_ONE_ARGUMENT,
    *_TWO_ARGUMENTS,
    *_TWO_OR_MORE,
    *_THREE_ARGUMENTS,
)
"""Every function that an expression may call."""


def _binary(operator: ast.operator, a: _Dual, b: _Dual, side: Side) -> _Dual:
    match operator:
        case ast.Add():
            return _Dual(a.value + b.value, a.rate + b.rate)
        case ast.Sub():
            return _Dual(a.value - b.value, a.rate - b.rate)
        case ast.Mult():
            return _Dual(a.value * b.value, a.rate * b.value + a.value * b.rate)
        case ast.Div():
            value = a.value / b.value
            return _Dual(value, (a.rate - value * b.rate) / b.value)
        case _:
            return _power(a, b, side)


def _evaluate(node: ast.expr, t: _Dual, side: Side) -> _Dual:
    match node:
        case ast.Constant(value=int() | float() as number):
            return _Dual(np.float64(number), np.float64(0.0))
        case ast.Name(id="t"):
            return t
        case ast.Name(id=name):
            return _Dual(np.float64(_CONSTANTS[name]), np.float64(0.0))
        case ast.UnaryOp(op=operator, operand=operand):
            a = _evaluate(operand, t, side)
            return _Dual(-a.value, -a.rate) if isinstance(operator, ast.USub) else a
        case ast.BinOp(left=left, op=operator, right=right):
            return _binary(operator, _evaluate(left, t, side), _evaluate(right, t, side), side)
        case ast.Call(func=ast.Name(id=name), args=args):
            return _call(name, [_evaluate(arg, t, side) for arg in args], side)
    raise AssertionError("the whitelist lets nothing else through")


def _call(name: str, args: list[_Dual], side: Side) -> _Dual:
    if name in _ONE_ARGUMENT:
        return _ONE_ARGUMENT[name](args[0], side)
    if name in _TWO_ARGUMENTS:
        return _TWO_ARGUMENTS[name](args[0], args[1], side)
    if name in _THREE_ARGUMENTS:
        return _THREE_ARGUMENTS[name](args[0], args[1], args[2], side)
    result = args[0]
    for arg in args[1:]:
        result = _TWO_OR_MORE[name](result, arg, side)
    return result


@dataclass(frozen=True, slots=True)
class Expression:
    """Arithmetic in ``t``, the profile's time [s].

    Parameters
    ----------
    text : str
        As the user wrote it.
    size : int
        Number of operations, names and numbers in it.
    """

    text: str
    size: int
    _tree: ast.expr = field(repr=False, compare=False)

    def at(self, t: Floats, side: Side = 1) -> tuple[Floats, Floats]:
        """Evaluate value and exact derivative.

        Parameters
        ----------
        t : (n,) array
            Times [s].
        side : {1, -1}
            From which side a kink or a jump at ``t`` is looked at.

        Returns
        -------
        value, rate : (n,) arrays
            In the unit of the expression, and that unit per second; not a
            number or infinite where the expression has no value there.
        """
        value, rate = np.empty(len(t)), np.empty(len(t))
        with np.errstate(all="ignore"):
            for start in range(0, len(t), _CHUNK):
                part = slice(start, start + _CHUNK)
                dual = _evaluate(self._tree, _Dual(t[part], np.float64(1.0)), side)
                value[part], rate[part] = dual.value, dual.rate
        return value, rate


def parse_expression(text: str, *, variable: bool = True) -> Expression:
    """Read an expression, refusing everything but arithmetic.

    Parameters
    ----------
    text : str
        Operators ``+ - * / **``, parentheses, numbers, ``t``, ``pi``, ``e``
        and the functions of ``FUNCTIONS``; angles of ``sin`` and its kin in
        radians; ``smoothstep(a, b, x)`` rises from 0 at a to 1 at b.
    variable : bool
        Whether ``t`` may occur.

    Raises
    ------
    ExpressionError
        Saying what is not understood.

    >>> parse_expression("8.8 - 0.66*t").at(np.array([5.0]))
    (array([5.5]), array([-0.66]))
    """
    if len(text) > MAX_LENGTH:
        raise ExpressionError(f"is longer than {MAX_LENGTH} characters")
    if not text.strip():
        raise ExpressionError("is empty: give an expression in t, such as 8.8 - 0.66*t")
    for character in text:
        if not (character.isascii() and _ALLOWED_TEXT.match(character)):
            hint = " (a power is written **)" if character == "^" else ""
            raise ExpressionError(f"has an unexpected {shown(character)}{hint}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Python's advice on its own syntax
            tree = ast.parse(" ".join(text.split()), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise ExpressionError(f"is not an arithmetic expression: {shown(text)}") from None
    size = _check(tree, _CONSTANTS.keys() | ({"t"} if variable else set()), depth=1)
    return Expression(text, size, tree)


def constant_expression(value: float) -> Expression:
    """Make the expression that is one number at all times."""
    return Expression(repr(value), 1, ast.Constant(float(value)))


def _check(node: ast.expr, names: set[str], depth: int) -> int:
    """Refuse whatever is not on the whitelist; return the number of nodes."""
    if depth > MAX_DEPTH:
        raise ExpressionError(f"is nested more than {MAX_DEPTH} levels deep")
    match node:
        case ast.Constant(value=bool() | str() | bytes() | complex() | None):
            raise ExpressionError(f"may hold plain numbers only, not {ast.unparse(node)}")
        case ast.Constant(value=int() | float() as number):
            _check_number(number)
            return 1
        case ast.Name(id=name):
            if name not in names:
                hint = did_you_mean(name, names | set(FUNCTIONS))
                raise ExpressionError(f"has an unknown name {shown(name)}{hint}")
            return 1
        case ast.UnaryOp(op=ast.USub() | ast.UAdd(), operand=operand):
            return 1 + _check(operand, names, depth + 1)
        case ast.BinOp(
            op=ast.Add() | ast.Sub() | ast.Mult() | ast.Div() | ast.Pow(), left=left, right=right
        ):
            return 1 + _check(left, names, depth + 1) + _check(right, names, depth + 1)
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]):
            _check_call(name, len(args))
            return 1 + sum(_check(arg, names, depth + 1) for arg in args)
    raise ExpressionError(f"may hold + - * / ** and functions of {one_of(sorted(names))} only")


def _check_number(number: int | float) -> None:
    try:
        finite = math.isfinite(float(number))
    except OverflowError:
        finite = False
    if not finite:
        raise ExpressionError("holds a number that is too large")


def _check_call(name: str, given: int) -> None:
    if name not in FUNCTIONS:
        hint = did_you_mean(name, FUNCTIONS)
        raise ExpressionError(f"calls an unknown function {shown(name)}{hint}")
    if name in _TWO_OR_MORE:
        if given < 2:
            raise ExpressionError(f"{name}() takes two arguments or more")
        return
    want = 1 if name in _ONE_ARGUMENT else 2 if name in _TWO_ARGUMENTS else 3
    if given != want:
        raise ExpressionError(f"{name}() takes {want} argument{'s' * (want > 1)}, not {given}")
