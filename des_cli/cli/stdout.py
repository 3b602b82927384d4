"""Data for programs, on stdout, byte for byte."""

from __future__ import annotations

import sys

import click

from des_cli.cli.lines import wrapped
from des_cli.cli.status_line import columns_of
from des_cli.cli.terminal import printable
from des_cli.errors import Complaint, FileAccessError


def write_data(data: bytes | str) -> None:
    """Write and flush, so that a full disk or a gone reader shows here.

    Raises
    ------
    FileAccessError
        If this process was started with a closed stdout.
    OSError
        If the data cannot be written.
    """
    if sys.stdout is None:
        raise FileAccessError([Complaint("stdout", "is closed")])
    stream = sys.stdout.buffer
    rest = memoryview(data.encode() if isinstance(data, str) else data)
    while rest:
        # unbuffered (PYTHONUNBUFFERED), a write may take a part and say so only here
        taken = stream.write(rest)
        rest = rest[len(rest) if taken is None else taken :]
    stream.flush()


def write_line(text: str) -> None:
    """Write words for a person on a line, as `write_data` does."""
    write_data(printable(text) + "\n")


def write_words(text: str) -> None:
    """Write a line of words, on a terminal as lines of its width."""
    for line in wrapped(printable(text), columns_of(sys.stdout)):
        write_line(line)


def refuse_binary_on_terminal(table_format: str | None) -> None:
    """Refuse to fill a terminal with bytes that mean nothing to it.

    Raises
    ------
    click.UsageError
    """
    if (
        table_format in ("parquet", "xlsx", "mcap")
        and sys.stdout is not None
        and sys.stdout.isatty()
    ):
        raise click.UsageError(
            f"{table_format} is not for a terminal: redirect stdout, or -o FILE."
        )
