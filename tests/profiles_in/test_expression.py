"""Expressions against Python's own arithmetic, complex steps and one-sided differences."""

from __future__ import annotations

import ast
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from des_cli.profiles_in.expression import (
    FUNCTIONS,
    MAX_DEPTH,
    MAX_LENGTH,
    ExpressionError,
    constant_expression,
    parse_expression,
)

# Names as numpy spells them, so that an expression can also be run on complex numbers.
NUMPY = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "sinh": np.sinh, "cosh": np.cosh,
    "tanh": np.tanh, "exp": np.exp, "log": np.log, "sqrt": np.sqrt,
    "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan, "pi": math.pi, "e": math.e,
}  # fmt: skip
STEP = 1e-30


def by_complex_step(text: str, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Value and derivative of a trusted text, run as Python on complex numbers."""
    z = eval(text, {"__builtins__": {}}, {**NUMPY, "t": t + 1j * STEP})
    z = np.broadcast_to(np.asarray(z, dtype=complex), t.shape)
    return z.real, z.imag / STEP


@pytest.mark.parametrize(
    "text",
    [
        "8.8 - 0.66*t",
        "5.5 + 0.66*(t - 5)",
        "-60*(1 - cos(pi*t/5))",
        "t**3 - 2*t**-1.5 + 4**t - (t + 1)**t",
        "(t + 1)**0.5 * exp(-t/3) / (2 + sin(3*t))",
        "tan(t/9) + asin(t/9) - acos(t/9) * atan(t) + sinh(t/4) - cosh(t/5)/tanh(t)",
        "log(t + 2) * sqrt(t) + e**(-t) + +t - -t",
        "1e-3*t + .5 + 2.",
    ],
)
def test_value_and_derivative_agree_with_the_complex_step(text: str) -> None:
    t = np.linspace(0.1, 8.9, 57)
    value, rate = parse_expression(text).at(t)
    want_value, want_rate = by_complex_step(text, t)
    np.testing.assert_allclose(value, want_value, rtol=1e-13, atol=1e-15)
    np.testing.assert_allclose(rate, want_rate, rtol=1e-11, atol=1e-14)


NUMBERS = st.sampled_from(["t", "2", "0.5", "pi", "3.25", "(t - 4)"])
SMOOTH = st.sampled_from(["sin", "cos", "atan", "tanh"])
TREES = st.recursive(
    NUMBERS,
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from(["+", "-", "*"]), inner).map(lambda x: f"({' '.join(x)})"),
        st.tuples(SMOOTH, inner).map(lambda x: f"{x[0]}({x[1]})"),
        inner.map(lambda x: f"-{x}"),
        inner.map(lambda x: f"({x})**2"),
    ),
    max_leaves=8,
)


@settings(max_examples=60)
@given(TREES)
def test_random_expressions_agree_with_the_complex_step(text: str) -> None:
    t = np.array([0.3, 1.7, 4.9])
    value, rate = parse_expression(text).at(t)
    want_value, want_rate = by_complex_step(text, t)
    np.testing.assert_allclose(value, want_value, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(
        rate, want_rate, rtol=1e-8, atol=1e-9 * (1 + np.abs(want_rate).max())
    )


@pytest.mark.parametrize(
    ("text", "left", "right"),
    [
        ("abs(t - 5)", -1.0, 1.0),
        ("max(0, t - 5)", 0.0, 1.0),
        ("min(t, 10 - t)", 1.0, -1.0),
        ("max(t - 5, 2*(t - 5), 5 - t)", -1.0, 2.0),
        ("min(5, t) - max(5, t)", 1.0, -1.0),
        ("abs(3*(5 - t))", -3.0, 3.0),
    ],
)
def test_a_kink_has_the_derivative_of_the_side_looked_from(
    text: str, left: float, right: float
) -> None:
    expression, at = parse_expression(text), np.array([5.0])
    assert expression.at(at, -1)[1][0] == left
    assert expression.at(at, 1)[1][0] == right
    # The sides are those of difference quotients that stay on one side.
    value = [expression.at(np.array([t]))[0][0] for t in (4.875, 5.0, 5.125)]
    assert [(value[1] - value[0]) / 0.125, (value[2] - value[1]) / 0.125] == [left, right]


@pytest.mark.parametrize(
    ("text", "value", "rate"),
    [
        ("atan2(t, 2)", math.pi / 4, 0.25),
        ("smoothstep(1, 5, t)", 0.15625, 0.28125),
        ("smootherstep(t - 1, t + 1, t)", 0.5, 0.0),
    ],
)
def test_several_arguments_stand_in_their_order(text: str, value: float, rate: float) -> None:
    found = parse_expression(text).at(np.array([2.0]))
    np.testing.assert_allclose((found[0][0], found[1][0]), (value, rate), rtol=1e-14)


def test_long_grids_are_evaluated_in_parts_without_a_seam() -> None:
    t = np.linspace(0.0, 1.0, 100_001)
    np.testing.assert_array_equal(parse_expression("t*t").at(t)[0], t * t)


def test_a_constant_has_one_value_and_no_rate() -> None:
    value, rate = constant_expression(-2.5).at(np.linspace(0, 1, 4))
    np.testing.assert_array_equal(value, -2.5)
    np.testing.assert_array_equal(rate, 0.0)


def test_no_value_is_not_an_exception_but_not_a_number() -> None:
    value, rate = parse_expression("1/t + log(t - 1)").at(np.array([0.0, 0.5, 2.0]))
    assert not np.isfinite(value[:2]).any()
    assert np.isfinite(value[2])
    assert np.isfinite(rate[2])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        ("   ", "is empty"),
        ("2^t", "a power is written **"),
        ("sni(t)", "did you mean sin"),
        ("x + 1", "unknown name 'x'"),
        ("__import__(t)", "unknown function"),
        ("t.real", "may hold"),
        ("(1).real", "may hold"),
        ("t[0]", "unexpected '['"),
        ("lambda: 0", "unexpected ':'"),
        ("sin", "has sin without its arguments: sin(…)"),
        ("sin(t, t)", "sin() takes 1 argument, not 2"),
        ("atan2(t)", "atan2() takes 2 arguments, not 1"),
        ("max(t)", "two arguments or more"),
        ("smoothstep(0, t)", "takes 3 arguments"),
        ("sin(*t)", "may hold"),
        ("sin(x=t)", "unexpected '='"),
        ("1j*t", "has '1j', which is no number in plain notation"),
        ("1_000*t", "has '1_000', which is no number"),
        ("0x10", "has '0x10', which is no number"),
        ("0b1 + 0o7", "has '0b1', which is no number"),
        ("1e", "has '1e', which is no number"),
        ("1e+t", "has '1e+t', which is no number"),
        ("1e400", "too large"),
        ("007", "is not an arithmetic expression"),
        ("\uff11", "has an unexpected '\uff11'"),
        ("True + t", "plain numbers only"),
        ("None", "plain numbers only"),
        ("1 +", "is not an arithmetic expression"),
        ("t t", "is not an arithmetic expression"),
        ("t // 2", "may hold"),
        ("(t, t)", "may hold"),
        ("t if t else t", "may hold"),
        ("t and t", "may hold"),
        ("1e999*t", "too large"),
        ("9" * 400, "too large"),
        ("t" * (MAX_LENGTH + 1), "longer than"),
        ("(" * 400 + "t" + ")" * 400, "is not an arithmetic expression"),
        ("-" * (MAX_DEPTH + 5) + "t", "nested more than"),
        ("t\N{SUPERSCRIPT TWO}", "unexpected"),
        ("\N{GREEK SMALL LETTER PI}*t", "unexpected"),
        ("t \x1b[1m", "unexpected"),
    ],
)
def test_everything_but_arithmetic_is_refused(text: str, words: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        parse_expression(text)
    assert words in str(caught.value)
    assert str(caught.value).isprintable()


def test_towers_of_powers_end_at_once() -> None:
    value, _ = parse_expression("9**9**9**9**9").at(np.zeros(1))
    assert np.isinf(value[0])


def test_t_is_refused_where_it_means_nothing() -> None:
    with pytest.raises(ExpressionError, match="unknown name 't'"):
        parse_expression("2*t", variable=False)
    assert parse_expression("pi/2", variable=False).at(np.zeros(1))[0][0] == math.pi / 2


@settings(max_examples=150)
@given(st.text(alphabet="0123456789tepi+-*/(),. sincoabmx_ =;'\n", max_size=40))
def test_any_text_is_an_expression_or_refused(text: str) -> None:
    words = ""
    try:
        expression = parse_expression(text)
    except ExpressionError as error:
        words = str(error)
    if words:
        assert words.isprintable()
        return
    names = {node.id for node in ast.walk(ast.parse(" ".join(text.split()), mode="eval"))
             if isinstance(node, ast.Name)}  # fmt: skip
    assert names <= {"t", "pi", "e", *FUNCTIONS}
    assert expression.at(np.array([0.5]))[0].shape == (1,)
