"""Commands as values of a file: numbers, expressions, segments, and what is none of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from des_cli.profiles_in.command_schema import Command, Constant, Segment, kind_of
from tests.support.schemas import accepted, refused


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        (3, "<number>"),
        (3.5, "<number>"),
        ("t", "<text>"),
        ([], "<list>"),
        ({}, "<mapping>"),
        (True, None),
        (None, None),
    ],
)
def test_a_value_is_checked_as_what_it_is_and_true_is_no_number(value: Any, kind: str) -> None:
    assert kind_of(value) == kind


def test_a_command_is_a_number_an_expression_or_segments() -> None:
    assert accepted(Command, "-2.5") == -2.5
    expression = accepted(Command, "3*t**2")
    value, rate = expression.at(np.array([2.0]))
    assert (value[0], rate[0]) == (12.0, 12.0)
    first, second = accepted(
        Command, "[{from_s: -1, to_ms: 500, value: 4}, {from_s: 0.5, to_min: 1, value: t}]"
    )
    assert (first.si("from"), first.si("to"), first.value) == (-1.0, 0.5, 4.0)
    assert second.si("to") == 60.0


def test_segments_join_to_rounding_and_not_to_a_millisecond() -> None:
    text = "[{{from_s: 0, to_s: 0.3, value: 1}}, {{from_s: {}, to_s: 1, value: 2}}]"
    assert len(accepted(Command, text.format(0.1 + 0.2))) == 2
    (gap,) = refused(Command, text.format(0.301))
    assert gap.endswith(
        "[1].from_s: leaves a gap: it must be where the previous segment ends (0.3 s)"
    )
    (overlap,) = refused(Command, text.format(0.299))
    assert "leaves an overlap" in overlap


@pytest.mark.parametrize(
    ("text", "where", "words"),
    [
        ("true", "1:1", "must be a number, an expression in t, or a list of segments"),
        ("null", "1:1", "must be a number, an expression in t, or a list of segments"),
        ("{a: 1}", "1:1", "must be a number, an expression in t, or a list of segments"),
        (".inf", "1:1", "must be a finite number"),
        ("2^t", "1:1", "a power is written **"),
        ("[]", "1:1", "is an empty list: give at least one segment"),
        ("[{from_s: 1, to_s: 1, value: 0}]", "1:20: [0].to_s", "must be greater than from_s (1)"),
        ("[{from_s: 2, to_ms: 1999, value: 0}]", "[0].to_ms", "must be greater than from_s (2)"),
        ("[{from_s: 0, to_s: 1}]", "[0].value", "is missing"),
        ("[{from_s: 0, value: 1}]", "[0]", "the end of a segment is missing"),
    ],
)
def test_what_is_no_command_is_refused_where_it_stands(text: str, where: str, words: str) -> None:
    (line,) = refused(Command, text)
    assert f"{where}: " in line
    assert words in line


def test_a_segment_holds_a_number_or_an_expression_and_no_segments() -> None:
    assert accepted(Constant, "7") == 7.0
    (line,) = refused(Segment, "{from_s: 0, to_s: 1, value: [{from_s: 0, to_s: 1, value: 2}]}")
    assert line.endswith("value: must be a number or an expression in t")
