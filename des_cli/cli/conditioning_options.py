"""Options that say by name how a record is conditioned, for every command that reads one."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, TypeVar, cast

import click

F = TypeVar("F", bound=Callable[..., Any])

_OPTIONS: tuple[tuple[str, str, str], ...] = (
    ("trim", "FROM:TO", "Fly the rows of a record between two times in seconds; 12: or :30."),
    ("body_axes", "AXES", "The seat's axes along the recorder's, such as p=x,q=-y,r=-z."),
    ("euler", "ORDER", "Order of recorded roll, pitch and yaw: zyx as in aviation, xyz, …"),
    ("resample", "SECONDS", "Put a record on a uniform grid of this step."),
    ("smooth", "HZ", "Take what is faster out of a record before it is reduced."),
)


def conditioning_options(command: F) -> F:
    """Add the options that condition a record; a command gets them among its ``settings``."""

    @wraps(command)
    def with_settings(*args: Any, **values: Any) -> Any:
        given = {key: values.pop(key) for key, _, _ in _OPTIONS}
        values["settings"] = (*values["settings"], *conditioning_settings(given))
        return command(*args, **values)

    added: Any = with_settings
    for key, metavar, text in reversed(_OPTIONS):
        added = click.option(f"--{key.replace('_', '-')}", key, metavar=metavar, help=text)(added)
    return cast(F, added)


def conditioning_settings(values: Mapping[str, str | None]) -> tuple[str, ...]:
    """Turn the options of `conditioning_options` into settings.

    What a number or a word may be is the schema's business.

    Raises
    ------
    click.UsageError
        If a text does not have the form of its option.

    >>> conditioning_settings({"trim": "2.5:", "body_axes": "p=x,q=-y,r=-z", "smooth": "2"})
    ('trim={from_s: 2.5}', 'axes={p: x, q: -y, r: -z}', 'smooth.cutoff_hz=2')
    """
    settings = []
    for key, value in values.items():
        if value is None:
            continue
        text = value.strip()
        match key:
            case "trim":
                settings.append(f"trim={{{_trim(text)}}}")
            case "body_axes":
                settings.append(f"axes={{{_axes(text)}}}")
            case "euler":
                settings.append(f"samples.euler={text.lower()}")
            case "resample":
                settings.append(f"resample.step_s={text}")
            case "smooth":
                settings.append(f"smooth.cutoff_hz={text}")
    return tuple(settings)


def _trim(text: str) -> str:
    first, colon, last = (part.strip() for part in text.partition(":"))
    if not colon or not (first or last):
        raise click.UsageError(f"--trim {text}: give FROM:TO in seconds, such as 2.5:30 or 12:.")
    ends = (("from_s", first), ("to_s", last))
    return ", ".join(f"{key}: {value}" for key, value in ends if value)


def _axes(text: str) -> str:
    pairs = [part.partition("=") for part in text.split(",")]
    if not all(name.strip() and equals and axis.strip() for name, equals, axis in pairs):
        raise click.UsageError(f"--body-axes {text}: give three axes, such as p=x,q=-y,r=-z.")
    return ", ".join(f"{name.strip()}: {axis.strip()}" for name, _, axis in pairs)
