"""YAML text as a tree with places: scalars, refusals, bounds."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from des_cli.errors import ProfileError
from des_cli.profiles_in.yaml_nodes import (
    MAX_DEPTH,
    MAX_NODES,
    parse_scalar_text,
    parse_yaml,
    path_text,
)


def problems_of(text: str) -> list[str]:
    with pytest.raises(ProfileError) as caught:
        parse_yaml(text, "x.yaml")
    return [str(problem) for problem in caught.value.complaints]


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1), ("-12", -12), ("+3", 3), ("0o17", 15), ("0x1f", 31), ("007", 7),
        ("1e-3", 0.001), ("1E3", 1000.0), (".5", 0.5), ("5.", 5.0), ("-.inf", -math.inf),
        ("true", True), ("False", False), ("null", None), ("~", None), ("", None),
        ("no", "no"), ("yes", "yes"), ("on", "on"), ("1:30", "1:30"), ("1_000", "1_000"),
        ("0b1", "0b1"), ("1e", "1e"), ("inf", "inf"), ("nan", "nan"), ("2001-01-01", "2001-01-01"),
        ("9" * 400, math.inf), ("9" * 20, 1e20),
    ],
)  # fmt: skip
def test_plain_scalars_follow_yaml_1_2(text: str, value: object) -> None:
    found = parse_scalar_text(text)
    assert found == value
    assert type(found) is type(value)


def test_not_a_number_is_written_with_a_dot() -> None:
    assert math.isnan(float(str(parse_scalar_text(".nan"))))


def test_quoted_scalars_are_text() -> None:
    text = "a: '1'\nb: \"true\"\nc: |\n  2\nd: 2\n"
    assert parse_yaml(text, "x").plain() == {"a": "1", "b": "true", "c": "2\n", "d": 2}


def test_every_value_and_key_knows_its_place() -> None:
    root = parse_yaml("a: 1\nlist:\n  - {from_s: 0, to_s: 5}\n  - {from_s: 5, to_s: 4}\n", "x.yaml")
    assert root.place_of(["list", 1, "to_s"]) == "x.yaml:4:23"
    assert root.place_of(["list", 1, "to_s"], of_key=True) == "x.yaml:4:17"
    assert root.place_of(["list", 0]) == "x.yaml:3:5"


def test_a_path_that_leads_nowhere_stands_where_it_was_left() -> None:
    root = parse_yaml("a: {b: 1}\n", "x.yaml")
    assert root.place_of(["a", "c", "d"]) == "x.yaml:1:4"
    assert root.place_of(["z"]) == "x.yaml:1:1"


def test_paths_are_written_as_users_do() -> None:
    assert path_text(["joints", "arm_rpm", 1, "to_s"]) == "joints.arm_rpm[1].to_s"


def test_all_repeated_keys_are_named_with_their_first_line() -> None:
    assert problems_of("a: 1\nb:\n  c: 1\n  c: 2\na: 3\n") == [
        "x.yaml:4:3: c is given twice; the first is on line 3",
        "x.yaml:5:1: a is given twice; the first is on line 1",
    ]


@pytest.mark.parametrize(
    ("text", "where", "words"),
    [
        ("", "x.yaml", "is empty"),
        ("# only a comment\n", "x.yaml", "is empty"),
        ("a: 1\n---\nb: 2\n", "x.yaml:2:1", "second document"),
        ("a: !!str 5\n", "x.yaml:1:4", "tag"),
        ("a: !!python/object/apply:os.system [echo]\n", "x.yaml:1:4", "tag"),
        ("a: *b\n", "x.yaml:1:4", "the alias *b is not accepted"),
        ("a: &a [*a]\n", "x.yaml:1:4", "the anchor &a is not accepted"),
        ("&a b: 1\n", "x.yaml:1:1", "the anchor &a is not accepted"),
        ("a: {<<: {b: 1}}\n", "x.yaml:1:5", "the merge key << is not accepted"),
        ("%YAML 1.1\n---\na: no\n", "x.yaml:2:1", "is YAML 1.1, which reads no as false"),
        ("? [1, 2]\n: 3\n", "x.yaml:1:3", "must be a name"),
        ("a: [1, 2\n", "x.yaml", "is not valid YAML"),
        ("a: b: c\n", "x.yaml:1:5", "is not valid YAML"),
        ("\ta: 1\n", "x.yaml:1:1", "is not valid YAML"),
        ("a: \x07\n", "x.yaml", "is not valid YAML"),
        ("[" * 5000, "x.yaml:1:21", f"more than {MAX_DEPTH} levels"),
        ("- " * 5000, "x.yaml:1:41", f"more than {MAX_DEPTH} levels"),
        ("a: [" + "1," * (MAX_NODES + 1) + "]", "x.yaml", f"more than {MAX_NODES} values"),
        ("x" * (1 << 20), "x.yaml", "larger than 256 KiB"),
    ],
)
def test_what_is_not_plain_yaml_is_refused_in_one_line(text: str, where: str, words: str) -> None:
    (line,) = problems_of(text)
    assert line.startswith(f"{where}: ") or line.startswith(f"{where}:")
    assert words in line
    assert line.isprintable()


def test_what_would_multiply_without_bound_ends_at_its_first_anchor() -> None:
    lines = ["a0: &a0 [1, 2, 3, 4, 5, 6, 7, 8, 9]"]
    for level in range(1, 12):
        lines.append(f"a{level}: &a{level} [{', '.join([f'*a{level - 1}'] * 9)}]")
    assert "anchor &a0" in problems_of("\n".join(lines))[0]


@settings(max_examples=150)
@given(st.text(alphabet="ab:- \n{}[]&*!|>'\"#?,%\t1.e0\\\x00\x85é", max_size=60))
def test_any_text_is_read_or_refused(text: str) -> None:
    lines = ["read"]
    try:
        parse_yaml(text, "x").plain()
    except ProfileError as error:
        lines = [str(problem) for problem in error.complaints]
    assert lines
    assert all(line.isprintable() for line in lines)
