"""The options of the group and of every command: how much is said, and in which colors."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from des_cli.cli.command import GENERAL, option
from des_cli.cli.console import Console
from des_cli.cli.lines import LogFormat

F = TypeVar("F", bound=Callable[..., Any])


def verbosity_options(command: F) -> F:
    """Add ``-q``, ``-v`` and ``--log-format``, on the group and on every command alike."""
    quiet = option(
        GENERAL,
        "-q",
        "--quiet",
        is_flag=True,
        expose_value=False,
        callback=_on_quiet,
        help="Print only warnings and errors.",
    )
    verbose = option(
        GENERAL,
        "-v",
        "--verbose",
        count=True,
        expose_value=False,
        callback=_on_verbose,
        help="Print a line for each iteration; twice: also the traceback of a bug.",
    )
    log_format = option(
        GENERAL,
        "--log-format",
        type=click.Choice(["text", "json"]),
        expose_value=False,
        callback=_on_log_format,
        help="Words on stderr for people, or an object a line for programs.  [default: text]",
    )
    return quiet(verbose(log_format(command)))


def color_option(command: F) -> F:
    """Add ``--color``; without it, a terminal without NO_COLOR has colors."""
    return option(
        GENERAL,
        "--color",
        type=click.Choice(["auto", "always", "never"]),
        default="auto",
        show_default=True,
        expose_value=False,
        callback=_on_color,
        help="Color the words on stderr; auto respects NO_COLOR.",
    )(command)


def _console(context: click.Context) -> Console:
    console = context.find_object(Console)
    assert console is not None
    return console


def _on_quiet(context: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        _console(context).verbosity = -1


def _on_verbose(context: click.Context, parameter: click.Parameter, value: int) -> None:
    if value:
        _console(context).verbosity = value


def _on_log_format(
    context: click.Context, parameter: click.Parameter, value: LogFormat | None
) -> None:
    if value is not None:
        _console(context).log_format = value


def _on_color(context: click.Context, parameter: click.Parameter, value: str) -> None:
    _console(context).choose_color(value)
