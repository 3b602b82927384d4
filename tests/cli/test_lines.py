"""Words are wrapped at a terminal's width, and a program gets an object a line."""

from __future__ import annotations

import json

import click
import pytest

from des_cli.cli.lines import asked_log_format, json_line, wrapped

ROW = (
    "  seat G         tilt 4.76 deg at most, peak Gy 0.373 -> 0.376 g, Gz onset 0.752 -> 0.632 g/s"
)


@pytest.mark.parametrize("columns", [None, 20, 200])
def test_what_fits_or_cannot_fit_stays_as_it_is(columns: int | None) -> None:
    assert list(wrapped(ROW, columns)) == [ROW]


def test_of_a_list_each_part_stays_whole_below_its_label() -> None:
    assert list(wrapped(ROW, 80, 17, whole=True)) == [
        "  seat G         tilt 4.76 deg at most, peak Gy 0.373 -> 0.376 g,",
        "                 Gz onset 0.752 -> 0.632 g/s",
    ]


@pytest.mark.parametrize("columns", [40, 60, 80])
@pytest.mark.parametrize("whole", [True, False])
def test_no_word_is_lost_and_no_number_leaves_its_unit(columns: int, whole: bool) -> None:
    lines = list(wrapped(ROW, columns, 17, whole=whole))
    assert " ".join(line.strip() for line in lines) == ROW.strip()
    assert all(len(line) <= columns for line in lines)
    assert not any(line.strip().startswith(("g,", "g/s", "deg", "->")) for line in lines)
    assert not any(line.endswith("->") for line in lines)


def test_a_style_takes_no_room_and_a_long_word_stays_whole() -> None:
    styled = click.style("worse to sit in: " + "much " * 4, fg="yellow")
    assert list(wrapped(styled, 40)) == [styled]
    path = "/".join(["folder"] * 12)
    assert list(wrapped(f"written to {path}", 40, 4)) == ["written to", f"    {path}"]


def test_an_object_is_one_line_of_ascii() -> None:
    line = json_line("error", "error", "  a\n\x1b[2J µ", {"exit_code": 4, "profile": None})
    assert line.isascii()
    assert line.isprintable()
    assert json.loads(line) == {
        **{"level": "error", "kind": "error", "text": "a\n\x1b[2J µ", "exit_code": 4}
    }


@pytest.mark.parametrize(
    ("args", "asked"),
    [
        (["--log-format=json", "reduce"], "json"),
        (["reduce", "x", "--log-format", "json", "--frob"], "json"),
        (["reduce", "--log-format", "text"], "text"),
        (["reduce", "--", "--log-format", "json"], "text"),
        (["reduce", "--log-format"], "text"),
    ],
)
def test_the_form_is_known_before_the_command_line_is(args: list[str], asked: str) -> None:
    assert asked_log_format(args) == asked
