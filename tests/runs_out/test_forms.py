"""Forms: what a column is, and what presets hold."""

from __future__ import annotations

import pytest

from des_cli.runs_out.forms import (
    COMMANDS,
    ENDINGS,
    PRESETS,
    Column,
    Form,
    as_spreadsheet,
    is_column,
    read_columns,
    read_separator,
)
from des_cli.runs_out.table_reading import COLUMNS


def test_commands_are_the_columns_of_a_command_table() -> None:
    assert tuple(column.name for column in COMMANDS) == COLUMNS


def test_columns_have_names_units_and_headers() -> None:
    assert read_columns("t_ms=Time, arm_rad_s2 ,cab_deg=Cab angle") == (
        Column("t_ms", "Time"),
        Column("arm_rad_s2", "arm_rad_s2"),
        Column("cab_deg", "Cab angle"),
    )


@pytest.mark.parametrize("name", ["t_s", "elapsed_ns", "arm_rpm", "fork_rad_s2", "cab_deg"])
def test_columns(name: str) -> None:
    assert is_column(name)


@pytest.mark.parametrize(
    "name", ["t", "t_deg", "arm", "arm_s", "arm_rad_s3", "arm_m", "seat_deg", "p_rad_s", ""]
)
def test_what_is_no_column_is_told_with_what_is_one(name: str) -> None:
    assert not is_column(name)
    with pytest.raises(ValueError, match="is no column: t or elapsed with a unit of time") as told:
        read_columns(f"t_s,{name}")
    assert "arm, fork or cab with one of rad, deg, rad_s, deg_s, rpm" in str(told.value)


@pytest.mark.parametrize(
    ("text", "what"),
    [("t_s=", "names no header"), ("t_s,arm_rpm=t_s", "'t_s' is there twice")],
)
def test_headers_that_cannot_be(text: str, what: str) -> None:
    with pytest.raises(ValueError, match=what):
        read_columns(text)


@pytest.mark.parametrize(
    ("text", "sign"), [("tab", "\t"), ("space", " "), (";", ";"), (",", ","), ("|", "|")]
)
def test_separators(text: str, sign: str) -> None:
    assert read_separator(text) == sign


@pytest.mark.parametrize("text", ["", "--", "e", "1", ".", "-", "+", "\n", '"'])
def test_what_numbers_are_written_with_cannot_stand_between_them(text: str) -> None:
    with pytest.raises(ValueError, match="cannot stand between numbers"):
        read_separator(text)


@pytest.mark.parametrize("name", PRESETS)
def test_presets_hold_columns_that_exist_and_have_endings(name: str) -> None:
    form = PRESETS[name]
    assert all(is_column(column.name) for column in form.columns)
    assert ENDINGS[name]
    assert form.timed == (name != "halstreamer")
    assert bool(form.columns) == (form.kind not in ("ros2", "mcap"))


def test_a_spreadsheet_has_names_and_no_units_below_them() -> None:
    form = as_spreadsheet(PRESETS["simulink"])
    assert (form.kind, form.unit_row, form.columns[0].header) == ("xlsx", False, "time")


def test_rows_are_untimed_without_a_column_of_time() -> None:
    assert not Form(columns=read_columns("arm_rpm")).timed
    assert Form(columns=read_columns("elapsed_ms,arm_rpm")).timed
