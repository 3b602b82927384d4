"""``--preset``, ``--columns`` and their like: which form a command line means."""

from __future__ import annotations

import click
import pytest

from des_cli.cli import form_options
from des_cli.cli.form_options import FormWords, form_of, lines_form, output_form
from des_cli.runs_out.forms import COMMANDS, PRESETS, Form, as_spreadsheet, read_columns

NONE = FormWords(None, None, None, header=True)


def words(
    preset: str | None = None,
    columns: str | None = None,
    separator: str | None = None,
    *,
    header: bool = True,
) -> FormWords:
    return FormWords(preset, read_columns(columns) if columns else None, separator, header=header)


@pytest.fixture(autouse=True)
def extras(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every extra is installed."""
    monkeypatch.setattr(form_options, "find_spec", lambda name: name)


@pytest.mark.parametrize(
    ("out", "named", "given", "form"),
    [
        (None, None, NONE, None),
        ("run", None, NONE, None),
        ("run/", None, NONE, None),
        ("runs/v1.2", None, NONE, None),
        ("x.csv", None, NONE, Form("csv", COMMANDS)),
        ("X.JSON", None, NONE, Form("json", COMMANDS)),
        ("-", None, NONE, Form("csv", COMMANDS)),
        ("-", "ndjson", NONE, Form("ndjson", COMMANDS)),
        ("x.txt", "csv", NONE, Form("csv", COMMANDS)),
        ("x", "csv", NONE, Form("csv", COMMANDS)),
        ("x.xlsx", None, NONE, PRESETS["xlsx"]),
        ("x.mcap", None, NONE, PRESETS["mcap"]),
        ("x.dat", None, words("halstreamer"), PRESETS["halstreamer"]),
        ("x", None, words("halstreamer"), PRESETS["halstreamer"]),
        ("-", None, words("xlsx"), PRESETS["xlsx"]),
        ("x.yaml", None, words("ros2"), PRESETS["ros2"]),
        ("x.csv", None, words("simulink"), PRESETS["simulink"]),
        ("x.xlsx", None, words("simulink"), as_spreadsheet(PRESETS["simulink"])),
        ("x.csv", None, words(columns="t_s"), Form("csv", read_columns("t_s"))),
        ("x.parquet", None, words(columns="t_s"), Form("parquet", read_columns("t_s"))),
        ("-", None, words(separator=";", header=False), Form("csv", COMMANDS, ";", header=False)),
        (
            "x.dat",
            None,
            words("halstreamer", "arm_rad_s,fork_rad", "\t"),
            Form("csv", read_columns("arm_rad_s,fork_rad"), "\t", header=False),
        ),
    ],
)
def test_forms(out: str | None, named: str | None, given: FormWords, form: Form | None) -> None:
    assert form_of(out, named, given, None) == form


def test_rows_a_second_are_part_of_the_form() -> None:
    assert form_of("x.csv", None, NONE, 50.0) == Form("csv", COMMANDS, hz=50.0)


@pytest.mark.parametrize(
    ("out", "named", "given", "what"),
    [
        ("x.foo", None, NONE, r"\.foo is no format of a table: name it \.csv, .* or \.mcap"),
        ("x.txt", None, words(columns="t_s"), r"\.txt is no format"),
        ("x", None, words(columns="t_s"), "x has no suffix: name it"),
        ("x.json", "csv", NONE, "--format csv contradicts the suffix of x.json"),
        ("x.xlsx", "csv", NONE, "--format csv contradicts the suffix of x.xlsx"),
        ("x.csv", "csv", words("veristand"), "--format and --preset exclude each other"),
        ("x.txt", None, words("ros2"), r"contradicts the suffix of x.txt: name it \.yaml or \.yml"),
        ("x.mcap", None, words(columns="t_s"), "--columns is not for mcap"),
        ("x.yml", None, words("ros2", "t_s"), "--columns is not for ros2"),
        ("x.json", None, words(separator=";"), "--out-separator is for rows of text, and json has"),
        ("x.xlsx", None, words(header=False), "--no-header is for rows of text, and xlsx has none"),
        (None, "csv", NONE, "--format is for a command table: add -o FILE"),
        (None, None, words("ros2"), "--preset is for a command table"),
        (None, None, words(header=False), "--no-header is for a command table"),
        (
            "run/",
            None,
            words(columns="t_s"),
            "--columns is for .*, and run/ is a folder",
        ),
    ],
)
def test_what_cannot_be_meant(
    out: str | None, named: str | None, given: FormWords, what: str
) -> None:
    with pytest.raises(click.UsageError, match=what):
        form_of(out, named, given, None)


def test_rows_a_second_are_of_a_table() -> None:
    with pytest.raises(click.UsageError, match="--hz is for a command table"):
        form_of(None, None, NONE, 50.0)


def test_an_extra_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(form_options, "find_spec", lambda name: None)
    with pytest.raises(click.UsageError, match=r"needs openpyxl.*'des-coriolis\[xlsx\]'"):
        form_of("x.xlsx", None, NONE, None)
    with pytest.raises(click.UsageError, match=r"needs mcap.*'des-coriolis\[mcap\]'"):
        form_of("x.mcap", None, NONE, None)


def test_a_command_table_is_written_as_ever() -> None:
    assert output_form(Form("json", COMMANDS)) == {"table_format": "json", "form": None}
    assert output_form(None) == {"table_format": None, "form": None}
    for form in (Form("csv", COMMANDS, hz=50.0), PRESETS["xlsx"], Form("csv", COMMANDS, ";")):
        assert output_form(form) == {"table_format": None, "form": form}


def test_lines_are_those_of_a_command_table_unless_told() -> None:
    assert lines_form(NONE) == Form("csv", COMMANDS)
    assert lines_form(words("veristand", header=False)).header is False
