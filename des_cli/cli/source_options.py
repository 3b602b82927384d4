"""Options that say what a command reads and how: the profile, its machine, its columns."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar, cast

import click

from des_cli.batch.source import STANDARD_STREAM, Source
from des_cli.cli.command import PROFILE, RECORD, option
from des_cli.cli.completion import (
    complete_machines,
    complete_profiles,
    complete_setting,
    complete_words,
)
from des_cli.cli.conditioning_options import conditioning_options
from des_cli.cli.options import plain_setting
from des_cli.errors import Complaint, FileAccessError
from des_cli.profiles_in.caps import DEFAULT_CAPS, Caps
from des_cli.profiles_in.setting import AnySetting, Setting
from des_cli.runs_out.forms import SEPARATORS

F = TypeVar("F", bound=Callable[..., Any])

_GAP = "des_cli.gap"


def profile_argument(command: F) -> F:
    """Add ``PROFILE...``."""
    return click.argument(
        "profiles",
        metavar="PROFILE...",
        nargs=-1,
        required=True,
        shell_complete=complete_profiles,
    )(command)


def setting_options(command: F) -> F:
    """Add the options that change how a profile is read, such as ``--set`` and ``--trim``.

    ``--gap`` comes to the command as a setting; its own value is not passed.
    """
    settings = option(
        PROFILE,
        "--set",
        "settings",
        metavar="KEY=VALUE",
        multiple=True,
        callback=_with_gap,
        shell_complete=complete_setting,
        help="Override a key of the profile by its path, such as reduction.r2=0.2; repeatable.",
    )
    columns = option(
        PROFILE,
        "--column",
        "columns",
        metavar="NAME=HEADER",
        multiple=True,
        callback=_read_columns,
        help="Take a column of a CSV profile under its own header, such as t_s=t; repeatable.",
    )
    gap = option(
        RECORD,
        "--gap",
        type=click.Choice(["refuse", "bridge", "split"]),
        is_eager=True,
        expose_value=False,
        callback=_keep_gap,
        help="Where samples are missing: refuse, interpolate, or make a profile of each stretch.  "
        "[default: bridge up to 0.5 s]",
    )
    separator = option(
        PROFILE,
        "--separator",
        metavar="SIGN",
        callback=_read_separator,
        shell_complete=complete_words(dict.fromkeys((",", ";", "|", *SEPARATORS), "")),
        help="What stands between the columns of a CSV profile: ',', ';', '|', tab or space.",
    )
    decimal = option(
        PROFILE,
        "--decimal",
        metavar="SIGN",
        callback=_read_decimal,
        help="The decimal sign of a CSV profile: '.' or ','.",
    )
    return settings(columns(separator(decimal(gap(conditioning_options(_cap_options(command)))))))


def _cap_options(command: F) -> F:
    """Add ``--max-rows`` and ``--max-mib``; a command gets them as its ``caps``."""

    @wraps(command)
    def with_caps(*args: Any, max_rows: int, max_mib: int, **values: Any) -> Any:
        return command(*args, caps=Caps(max_rows, max_mib), **values)

    rows = option(
        PROFILE,
        "--max-rows",
        type=click.IntRange(min=2),
        metavar="N",
        default=DEFAULT_CAPS.rows,
        show_default=True,
        help="The most rows of a table, and samples of a profile, that are read.",
    )
    mib = option(
        PROFILE,
        "--max-mib",
        type=click.IntRange(min=1),
        metavar="N",
        default=DEFAULT_CAPS.mib,
        show_default=True,
        help="The most that is read of a file or of stdin, in 2^20 bytes.",
    )
    return cast(F, rows(mib(with_caps)))


def machine_option(command: F) -> F:
    """Add ``--machine``, which names another machine than the profile's."""
    return machine_option_below(PROFILE)(command)


def machine_option_below(heading: str) -> Callable[[F], F]:
    """Return what adds ``--machine`` below another heading than that of a profile."""
    return option(
        heading,
        "--machine",
        metavar="NAME|FILE",
        callback=_require_name,
        shell_complete=complete_machines,
        help="A built-in machine or a YAML file, instead of the profile's.  [default: des]",
    )


def machine_settings(machine: str | None) -> tuple[Setting, ...]:
    """Turn ``--machine`` into a setting, which stands before those that change the machine.

    >>> [str(setting) for setting in machine_settings("my machine.yaml")]
    ['machine="my machine.yaml"']
    """
    return () if machine is None else (Setting("machine", machine, f"--machine {machine}"),)


def source_of(
    name: str,
    settings: tuple[AnySetting, ...],
    *,
    machine: str | None,
    stdin: bytes | None,
    **read: Any,
) -> Source:
    """Return where a profile comes from, as the options of `setting_options` say.

    Parameters
    ----------
    name : str
        Of a file or a built-in profile, or ``-``.
    settings : tuple of str or Setting
        Of ``--set`` and what comes to the command among them.
    machine : str, optional
        Of ``--machine``, which stands before the settings that change a machine.
    stdin : bytes, optional
        What `read_stdin` found, of all sources.
    **read
        Values of ``--column``, ``--separator`` and ``--decimal``, and the caps.
    """
    return Source(
        name,
        settings=(*machine_settings(machine), *settings),
        stdin=stdin if name == STANDARD_STREAM else None,
        **read,
    )


def read_stdin(sources: tuple[str, ...], caps: Caps) -> bytes | None:
    """Return all of stdin if ``-`` is among the sources.

    Raises
    ------
    click.UsageError
        If it is there twice.
    FileAccessError
        If this process was started with a closed stdin, or there is more of it than `caps`
        has room for.
    """
    from des_cli.profiles_in.source import STDIN_LABEL, read_stream

    if STANDARD_STREAM not in sources:
        return None
    if sources.count(STANDARD_STREAM) > 1:
        raise click.UsageError("stdin ('-') can be read only once.")
    if sys.stdin is None:
        raise FileAccessError([Complaint("stdin", "is closed")])
    return read_stream(sys.stdin.buffer, STDIN_LABEL, caps.mib)


def _require_name(
    context: click.Context, parameter: click.Parameter, value: str | None
) -> str | None:
    if value is not None and not value.strip():
        raise click.BadParameter("is empty: name a machine or a file.")
    return value


def _keep_gap(context: click.Context, parameter: click.Parameter, value: str | None) -> None:
    context.meta[_GAP] = value  # eager: it is there before the settings are read


def _with_gap(
    context: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> tuple[AnySetting, ...]:
    """Return the settings, with what ``--gap`` says as the last one."""
    for value in values:
        if not value.partition("=")[0].strip() or "=" not in value:
            raise click.BadParameter(f"{value!r} is not KEY=VALUE, such as reduction.r2=0.2.")
    values = tuple(map(plain_setting, values))
    gap = context.meta.get(_GAP)
    return values if gap is None else (*values, Setting("gap", gap, f"--gap {gap}"))


def _read_columns(
    context: click.Context, parameter: click.Parameter, values: tuple[str, ...]
) -> dict[str, str]:
    columns: dict[str, str] = {}
    for value in values:
        name, equals, header = value.partition("=")
        if not name or not equals or not header:
            raise click.BadParameter(f"{value!r} is not NAME=HEADER, such as t_s=t.")
        if name in columns:
            raise click.BadParameter(f"{name!r} is given twice.")
        columns[name] = header
    return columns


def _read_separator(
    context: click.Context, parameter: click.Parameter, value: str | None
) -> str | None:
    from des_cli.profiles_in.dialect import parse_separator

    return None if value is None else _in_words(parse_separator, value)


def _read_decimal(
    context: click.Context, parameter: click.Parameter, value: str | None
) -> str | None:
    from des_cli.profiles_in.dialect import parse_decimal

    return None if value is None else _in_words(parse_decimal, value)


def _in_words(parse: Callable[[str], str], value: str) -> str:
    try:
        return parse(value)
    except ValueError as error:
        raise click.BadParameter(f"{value!r}: {error}.") from None
