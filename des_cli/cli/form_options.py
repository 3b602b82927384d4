"""In what form rows are written: ``--preset``, ``--columns`` and their like."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import wraps
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TypedDict, TypeVar, cast

import click

from des_cli.batch.job import TableFormat
from des_cli.batch.source import STANDARD_STREAM
from des_cli.cli.command import ROWS, option
from des_cli.cli.completion import complete_columns, complete_words
from des_cli.cli.options import TABLE_FORMATS, existing_folder
from des_cli.runs_out.forms import (
    COMMANDS,
    ENDINGS,
    PRESETS,
    SEPARATORS,
    Column,
    Form,
    Kind,
    as_spreadsheet,
    read_columns,
    read_separator,
)

F = TypeVar("F", bound=Callable[..., Any])

LINES = ("halstreamer", "veristand", "simulink")
"""Presets of which each row is a line."""

_OF_SUFFIX = {"xlsx": "xlsx", "mcap": "mcap"}
"""Presets that the suffix of a file means by itself."""

_EXTRAS = {"xlsx": "openpyxl", "mcap": "mcap"}
"""Modules that a kind of file needs, by the extra that brings them."""

_SUFFIX = re.compile(r"\.([A-Za-z]\w*)\Z")
"""A version (``v1.2``) is none."""


@dataclass(frozen=True, slots=True)
class FormWords:
    """What the options of `form_options` say.

    Parameters
    ----------
    preset, separator : str, optional
    columns : tuple of Column, optional
    header : bool
    """

    preset: str | None
    columns: tuple[Column, ...] | None
    separator: str | None
    header: bool

    @property
    def given(self) -> tuple[str, ...]:
        """The options that were given."""
        said = {
            "--preset": self.preset is not None,
            "--columns": self.columns is not None,
            "--out-separator": self.separator is not None,
            "--no-header": not self.header,
        }
        return tuple(option for option, is_given in said.items() if is_given)

    def on(self, form: Form) -> Form:
        """Return a form with what these words change of it.

        Raises
        ------
        click.UsageError
            If it has no such thing.
        """
        if self.columns is not None:
            if form.kind in ("ros2", "mcap"):
                raise click.UsageError(
                    f"--columns is not for {form.kind}: what it holds is its own."
                )
            form = replace(form, columns=self.columns)
        if form.kind != "csv" and (not self.header or self.separator is not None):
            option = "--out-separator" if self.separator is not None else "--no-header"
            raise click.UsageError(f"{option} is for rows of text, and {form.kind} has none.")
        if not self.header:
            form = replace(form, header=False, unit_row=False)
        return form if self.separator is None else replace(form, separator=self.separator)


def form_options(command: F) -> F:
    """Add the options of a form, which come to a command as its ``words``."""
    return _form_options(tuple(PRESETS))(command)


def line_options(command: F) -> F:
    """Add those of a form whose rows are lines."""
    return _form_options(LINES)(command)


def hz_option(command: F) -> F:
    """Add ``--hz`` to a command that writes tables."""
    return option(
        ROWS,
        "--hz",
        type=click.FloatRange(1.0, 10_000.0),
        metavar="RATE",
        help="Rows a second, between those of the table and inside the same limits.  "
        "[default: its own rows]",
    )(command)


def form_of(
    out: str | None, table_format: str | None, words: FormWords, hz: float | None
) -> Form | None:
    """Return the form that a command line means, or None where it means a run folder.

    Parameters
    ----------
    out : str, optional
        A file, ``-``, a folder, or nothing.
    table_format : str, optional
        Of ``--format``.
    words : FormWords
    hz : float, optional
        Of ``--hz``.

    Raises
    ------
    click.UsageError
        If the options contradict each other, or the suffix is unknown.
    """
    given = [
        *(["--format"] if table_format is not None else []),
        *words.given,
        *(["--hz"] if hz is not None else []),
    ]
    if out is None:
        if given:
            raise click.UsageError(
                f"{given[0]} is for a command table: add -o FILE, or -o - for stdout."
            )
        return None
    if out != STANDARD_STREAM and existing_folder(out):
        if given:
            raise click.UsageError(f"{given[0]} is for a command table, and {out} is a folder.")
        return None
    suffix = _suffix_of(out)
    if table_format is None and words.preset is None and out != STANDARD_STREAM:
        if not suffix and not given:
            return None
        _require_known(out, suffix)
    form = words.on(_base(out, suffix, table_format, words.preset))
    _require_extra(form.kind)
    return replace(form, hz=hz)


def lines_form(words: FormWords) -> Form:
    """Return the form of lines that options mean."""
    return words.on(PRESETS[words.preset] if words.preset else Form(columns=COMMANDS))


class OutputForm(TypedDict):
    """The fields of an output that a form fills."""

    table_format: TableFormat | None
    form: Form | None


def output_form(form: Form | None) -> OutputForm:
    """Return what a form means for an output: a command table as ever, or a form of its own."""
    if form is not None and form.kind in TABLE_FORMATS and form == Form(form.kind, COMMANDS):
        return {"table_format": cast(TableFormat, form.kind), "form": None}
    return {"table_format": None, "form": form}


def _form_options(presets: tuple[str, ...]) -> Callable[[F], F]:
    def add(command: F) -> F:
        @wraps(command)
        def with_words(
            *args: Any,
            preset: str | None,
            out_columns: tuple[Column, ...] | None,
            out_separator: str | None,
            no_header: bool,
            **values: Any,
        ) -> Any:
            words = FormWords(preset, out_columns, out_separator, not no_header)
            return command(*args, words=words, **values)

        preset = option(
            ROWS, "--preset", type=click.Choice(presets), help="The form that this program reads."
        )
        columns = option(
            ROWS,
            "--columns",
            "out_columns",
            metavar="NAME[=HEADER],...",
            callback=_read_columns,
            shell_complete=complete_columns,
            help="The columns of the rows, by quantity and unit: t_s,arm_rad_s,fork_deg=Fork.",
        )
        separator = option(
            ROWS,
            "--out-separator",
            metavar="SIGN",
            callback=_read_separator,
            shell_complete=complete_words(dict.fromkeys((",", ";", "|", *SEPARATORS), "")),
            help="What stands between them: ',', ';', '|', tab or space.",
        )
        header = option(ROWS, "--no-header", is_flag=True, help="Write no names above the rows.")
        return cast(F, preset(columns(separator(header(with_words)))))

    return add


def _base(out: str, suffix: str, table_format: str | None, preset: str | None) -> Form:
    """Return the form that a name, a format or a preset means by itself."""
    if table_format is not None:
        if preset is not None:
            raise click.UsageError("--format and --preset exclude each other.")
        if suffix in (*TABLE_FORMATS, *_OF_SUFFIX) and suffix != table_format:
            raise click.UsageError(f"--format {table_format} contradicts the suffix of {out}.")
        return Form(cast(Kind, table_format), COMMANDS)
    preset = preset or _OF_SUFFIX.get(suffix)
    if preset is None:
        return Form(cast(Kind, suffix or "csv"), COMMANDS)
    if suffix and suffix not in ENDINGS[preset]:
        known = " or ".join(f".{ending}" for ending in ENDINGS[preset])
        raise click.UsageError(
            f"--preset {preset} contradicts the suffix of {out}: name it {known}."
        )
    form = PRESETS[preset]
    return as_spreadsheet(form) if suffix == "xlsx" and form.kind == "csv" else form


def _suffix_of(out: str) -> str:
    found = _SUFFIX.search(Path(out).name)
    return found[1].lower() if found and out != STANDARD_STREAM else ""


def _require_known(out: str, suffix: str) -> None:
    known = (*TABLE_FORMATS, *_OF_SUFFIX)
    if suffix not in known:
        what = f"{out}: .{suffix} is no format of a table" if suffix else f"{out} has no suffix"
        names = f"{', '.join(f'.{each}' for each in known[:-1])} or .{known[-1]}"
        raise click.UsageError(
            f"{what}: name it {names}, or end the name of a run folder with a slash."
        )


def _require_extra(kind: str) -> None:
    module = _EXTRAS.get(kind)
    if module is not None and find_spec(module) is None:
        raise click.UsageError(
            f"{kind} needs {module}, which the extra {kind} brings: "
            f"pip install 'des-coriolis[{kind}]'."
        )


def _read_columns(
    context: click.Context, parameter: click.Parameter, text: str | None
) -> tuple[Column, ...] | None:
    try:
        return None if text is None else read_columns(text)
    except ValueError as error:
        raise click.BadParameter(f"{error}.") from None


def _read_separator(
    context: click.Context, parameter: click.Parameter, text: str | None
) -> str | None:
    try:
        return None if text is None else read_separator(text)
    except ValueError as error:
        raise click.BadParameter(f"{error}.") from None
