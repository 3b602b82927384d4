"""Values written as YAML on one line read back as they were."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from des_cli.profiles_in.yaml_nodes import parse_yaml
from des_cli.profiles_in.yaml_text import yaml_key, yaml_text

TEXT = st.text(st.characters(exclude_categories=["Cs"]), max_size=8)
VALUES = st.recursive(
    st.none() | st.booleans() | st.floats(allow_nan=False, allow_infinity=False) | TEXT,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXT, inner, max_size=3),
    max_leaves=6,
)


@settings(max_examples=60)
@given(VALUES)
def test_any_plain_value_reads_back_from_one_line(value: object) -> None:
    text = yaml_text(value)
    assert text.isprintable()
    assert parse_yaml(f"- {text}\n", "x").plain() == [value]


@pytest.mark.parametrize("text", ["a\x85b", "a\x7fb", "a\u2028b", "\ufffe", "😀", "\n"])
def test_signs_that_yaml_does_not_take_as_they_stand_read_back(text: str) -> None:
    assert parse_yaml(f"{yaml_key(text)}: {yaml_text(text)}\n", "x").plain() == {text: text}


@pytest.mark.parametrize(
    ("name", "written"),
    [("Lx", "Lx"), ("L_2", "L_2"), ("2L", '"2L"'), ("é", "é"), ("a: b", '"a: b"'), ("", '""')],
)
def test_a_key_is_quoted_where_it_is_no_plain_name(name: str, written: str) -> None:
    assert yaml_key(name) == written
