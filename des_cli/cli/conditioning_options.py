"""Options that say by name how a record is conditioned, for every command that reads one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, TypeVar, cast

import click

from des_cli.cli.command import RECORD, option
from des_cli.cli.completion import complete_words
from des_cli.profiles_in.setting import Setting, value_of_option

F = TypeVar("F", bound=Callable[..., Any])

_OPTIONS: tuple[tuple[str, str, str], ...] = (
    ("trim", "FROM:TO", "Fly the rows of a record between two times in seconds; 12: or :30."),
    ("body_axes", "AXES", "The seat's axes along the recorder's, such as p=x,q=-y,r=-z."),
    ("euler", "ORDER", "Order of recorded roll, pitch and yaw: zyx as in aviation, xyz, …"),
    ("resample", "SECONDS", "Put a record on a uniform grid of this step."),
    ("smooth", "HZ", "Take what is faster out of a record before it is reduced."),
)

_ORDERS = dict.fromkeys(("zyx", "xyz", "xzy", "yxz", "yzx", "zxy"), "")


def conditioning_options(command: F) -> F:
    """Add the options that condition a record; a command gets them among its ``settings``."""

    @wraps(command)
    def with_settings(*args: Any, **values: Any) -> Any:
        given = {key: values.pop(key) for key, _, _ in _OPTIONS}
        values["settings"] = (*values["settings"], *conditioning_settings(given))
        return command(*args, **values)

    added: Any = with_settings
    for key, metavar, text in reversed(_OPTIONS):
        name = f"--{key.replace('_', '-')}"
        complete = complete_words(_ORDERS) if key == "euler" else None
        added = option(RECORD, name, key, metavar=metavar, help=text, shell_complete=complete)(
            added
        )
    return cast(F, added)


def conditioning_settings(values: Mapping[str, str | None]) -> tuple[Setting, ...]:
    """Turn the options of `conditioning_options` into settings.

    What a number or a word may be is the schema's business.

    Raises
    ------
    click.UsageError
        If a text does not have the form of its option.

    >>> [str(each) for each in conditioning_settings({"trim": "2.5:", "smooth": "2"})]
    ['trim={"from_s": 2.5}', 'smooth.cutoff_hz=2']
    """
    settings = []
    for key, value in values.items():
        if value is None:
            continue
        text = value.strip()
        path, means = _KEYS[key]
        settings.append(Setting(path, means(text), f"--{key.replace('_', '-')} {text}"))
    return tuple(settings)


def _trim(text: str) -> dict[str, Any]:
    first, colon, last = (part.strip() for part in text.partition(":"))
    if not colon or not (first or last):
        raise click.UsageError(f"--trim {text}: give FROM:TO in seconds, such as 2.5:30 or 12:.")
    ends = (("from_s", first), ("to_s", last))
    return {key: value_of_option(value) for key, value in ends if value}


def _axes(text: str) -> dict[str, str]:
    pairs = [part.partition("=") for part in text.split(",")]
    if not all(name.strip() and equals and axis.strip() for name, equals, axis in pairs):
        raise click.UsageError(f"--body-axes {text}: give three axes, such as p=x,q=-y,r=-z.")
    return {name.strip(): axis.strip() for name, _, axis in pairs}


_KEYS: Mapping[str, tuple[str, Callable[[str], Any]]] = {
    "trim": ("trim", _trim),
    "body_axes": ("axes", _axes),
    "euler": ("samples.euler", str.lower),
    "resample": ("resample.step_s", value_of_option),
    "smooth": ("smooth.cutoff_hz", value_of_option),
}
"""The key of a profile that each option means, and what its text means there."""
