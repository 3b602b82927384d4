"""Arithmetic in ``t``: parsed against a whitelist, never run as Python.

One walk over the parsed text refuses what is not on the whitelist and makes a
function of the rest. It is evaluated over whole arrays of times and brings its exact
first derivative along (`dual`), so the rate of a position command owes nothing to
finite differences.
"""

from __future__ import annotations

import ast
import math
import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.profiles_in.dual import (
    ONE_ARGUMENT,
    OPERATORS,
    THREE_ARGUMENTS,
    TWO_ARGUMENTS,
    TWO_OR_MORE,
    Dual,
    Side,
)
from des_cli.profiles_in.wording import did_you_mean, one_of, shown

MAX_LENGTH = 1000
"""Characters; a maneuver's expressions have some tens of them."""

MAX_DEPTH = 50
"""Levels of nesting, far below what would exhaust the interpreter's stack."""

_CHUNK = 1 << 15
"""Samples evaluated at once: bounds the memory of a deep expression."""

_ALLOWED_TEXT = re.compile(r"[0-9A-Za-z_.+\-*/(),\s]")
_NUMBER_LIKE = re.compile(r"(?<![\w.])\.?[0-9]\w*(?:\.\w*)?(?:(?<=[eE])[+-]\w+)?")
_NUMBER = re.compile(r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
_CONSTANTS = {"pi": math.pi, "e": math.e}


class ExpressionError(ValueError):
    """An expression that is not arithmetic in ``t``; the message says why."""


_Function: TypeAlias = Callable[[Dual, Side], Dual]
"""What an expression is compiled to: from the dual number of ``t`` to that of its value."""


FUNCTIONS: tuple[str, ...] = (
    *ONE_ARGUMENT,
    *TWO_ARGUMENTS,
    *TWO_OR_MORE,
    *THREE_ARGUMENTS,
)
"""Every function that an expression may call."""


def _constant(number: float) -> _Function:
    dual = Dual(np.float64(number), np.float64(0.0))
    return lambda t, side: dual


def _negative(inner: _Function) -> _Function:
    def evaluate(t: Dual, side: Side) -> Dual:
        a = inner(t, side)
        return Dual(-a.value, -a.rate)

    return evaluate


def _folded(
    function: Callable[[Dual, Dual, Side], Dual], first: _Function, others: list[_Function]
) -> _Function:
    """Compile a function of two arguments, or one that takes any number of them by pairs."""

    def evaluate(t: Dual, side: Side) -> Dual:
        result = first(t, side)
        for other in others:
            result = function(result, other(t, side), side)
        return result

    return evaluate


def _applied(function: Callable[..., Dual], args: list[_Function]) -> _Function:
    return lambda t, side: function(*(arg(t, side) for arg in args), side)


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
    _function: _Function = field(repr=False, compare=False)

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
                dual = self._function(Dual(t[part], np.float64(1.0)), side)
                value[part], rate[part] = dual.value, dual.rate
        return value, rate

    def overflows(self, time: float, side: Side = 1) -> bool:
        """Tell whether the first thing that goes wrong at a time is a number that is too large."""
        try:
            with np.errstate(all="raise", under="ignore"):
                self._function(Dual(np.float64(time), np.float64(1.0)), side)
        except FloatingPointError as error:
            return str(error).startswith("overflow")
        return False


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
    for match in _NUMBER_LIKE.finditer(text):
        # Python's own spellings, as 1_000 and 0x10, stand in no table of commands.
        if not _NUMBER.fullmatch(match[0]):
            raise ExpressionError(f"has {shown(match[0])}, which is no number in plain notation")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Python's advice on its own syntax
            tree = ast.parse(" ".join(text.split()), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise ExpressionError(f"is not an arithmetic expression: {shown(text)}") from None
    names = _CONSTANTS.keys() | ({"t"} if variable else set())
    function, size = _compile(tree, names, depth=1)
    return Expression(text, size, function)


def constant_expression(value: float) -> Expression:
    """Make the expression that is one number at all times."""
    return Expression(repr(value), 1, _constant(value))


def _compile(node: ast.expr, names: set[str], depth: int) -> tuple[_Function, int]:
    """Return the function that a part means, and the number of its nodes.

    Raises
    ------
    ExpressionError
        If it is not on the whitelist.
    """
    if depth > MAX_DEPTH:
        raise ExpressionError(f"is nested more than {MAX_DEPTH} levels deep")
    match node:
        case ast.Constant(value=bool() | str() | bytes() | complex() | None):
            raise ExpressionError(f"may hold plain numbers only, not {ast.unparse(node)}")
        case ast.Constant(value=int() | float() as number):
            return _constant(_finite(number)), 1
        case ast.Name(id=name):
            return _named(name, names), 1
        case ast.UnaryOp(op=ast.USub() | ast.UAdd() as sign, operand=operand):
            inner, size = _compile(operand, names, depth + 1)
            return _negative(inner) if isinstance(sign, ast.USub) else inner, 1 + size
        case ast.BinOp(left=left, op=operator, right=right) if type(operator) in OPERATORS:
            first, left_size = _compile(left, names, depth + 1)
            second, right_size = _compile(right, names, depth + 1)
            function = _folded(OPERATORS[type(operator)], first, [second])
            return function, 1 + left_size + right_size
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]):
            _check_call(name, len(args))
            compiled = [_compile(arg, names, depth + 1) for arg in args]
            size = 1 + sum(each for _, each in compiled)
            return _called(name, [function for function, _ in compiled]), size
    raise ExpressionError(f"may hold + - * / ** and functions of {one_of(sorted(names))} only")


def _called(name: str, args: list[_Function]) -> _Function:
    if name in TWO_OR_MORE:
        return _folded(TWO_OR_MORE[name], args[0], args[1:])
    return _applied((ONE_ARGUMENT | TWO_ARGUMENTS | THREE_ARGUMENTS)[name], args)


def _named(name: str, names: set[str]) -> _Function:
    if name not in names:
        hint = did_you_mean(name, names | set(FUNCTIONS))
        if name in FUNCTIONS:
            raise ExpressionError(f"has {name} without its arguments: {name}(…)")
        raise ExpressionError(f"has an unknown name {shown(name)}{hint}")
    return _constant(_CONSTANTS[name]) if name in _CONSTANTS else lambda t, side: t


def _finite(number: int | float) -> float:
    try:
        value = float(number)
    except OverflowError:
        value = math.inf
    if not math.isfinite(value):
        raise ExpressionError("holds a number that is too large")
    return value


def _check_call(name: str, given: int) -> None:
    if name not in FUNCTIONS:
        hint = did_you_mean(name, FUNCTIONS)
        raise ExpressionError(f"calls an unknown function {shown(name)}{hint}")
    if name in TWO_OR_MORE:
        if given < 2:
            raise ExpressionError(f"{name}() takes two arguments or more")
        return
    want = 1 if name in ONE_ARGUMENT else 2 if name in TWO_ARGUMENTS else 3
    if given != want:
        raise ExpressionError(f"{name}() takes {want} argument{'s' * (want > 1)}, not {given}")
