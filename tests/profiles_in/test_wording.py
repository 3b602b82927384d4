"""Words for people: on one line, of bounded length, and as a shell or a person takes them."""

from __future__ import annotations

import math
import shlex

import pytest
from hypothesis import given
from hypothesis import strategies as st

from des_cli.profiles_in.wording import did_you_mean, one_of, option, plain, shown


@given(st.text(max_size=200))
def test_any_text_stays_on_one_line_and_short(text: str) -> None:
    for words in (shown(text), plain(text)):
        assert words.isprintable()
        assert 0 < len(words) <= 60


def test_a_text_is_cut_only_where_it_is_too_long() -> None:
    assert plain("a" * 60) == "a" * 60
    assert plain("a" * 61) == "'" + "a" * 56 + "..."
    assert shown("a" * 58) == "'" + "a" * 58 + "'"
    assert shown("a" * 59) == "'" + "a" * 56 + "..."


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (0.1 + 0.2, "0.3"),
        (1e-300, "1e-300"),
        (-2.0, "-2"),
        (math.nan, "nan"),
        (7, "7"),
        (True, "True"),
        (None, "None"),
        ("3", "'3'"),
        ("°", "'°'"),
        ("°\t", r"'\xb0\t'"),
    ],
)
def test_a_value_is_shown_as_what_it_is(value: object, words: str) -> None:
    assert shown(value) == words


def test_a_name_that_cannot_be_seen_is_quoted() -> None:
    assert [plain(name) for name in ("", "a b", "\u200b")] == ["''", "a b", r"'\u200b'"]


@given(st.text(st.characters(codec="utf-8", categories=["L", "N", "P", "S", "Zs"]), max_size=50))
def test_a_shell_takes_an_option_as_it_was_meant(value: str) -> None:
    if value.isprintable() and value:
        assert shlex.split(option("--column", value)) == ["--column", value]


@pytest.mark.parametrize(
    ("name", "hint"),
    [
        ("spiek", " (did you mean spike?)"),
        ("zzzzz", ""),
        ("", ""),
        ("cobra" * 13, ""),
    ],
)
def test_only_what_is_near_is_offered(name: str, hint: str) -> None:
    known = ["spike", "cobra", "cobra" * 12]
    assert did_you_mean(name, iter(known)) == did_you_mean(name, known[::-1]) == hint


def test_no_choices_are_no_words() -> None:
    assert one_of([]) == ""
    assert one_of(["a", "b", "c", "d"]) == "a, b, c or d"
