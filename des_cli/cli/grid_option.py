"""``--grid``: the values that keys of the profiles take in turn."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from des_cli.cli.options import without_percent
from des_cli.errors import ProfileError
from des_cli.profiles_in.setting import AnySetting

if TYPE_CHECKING:
    from des_cli.batch.grid import Axis

_REDUCTION, _BUDGETS = "reduction", "reduction.budget."


def read_grid(texts: Sequence[str], settings: Sequence[AnySetting]) -> tuple[Axis, ...]:
    """Return the axes of a grid.

    Parameters
    ----------
    texts : sequence of str
        ``KEY=V,V,...``; a key that begins with no section of a profile is one of
        ``reduction:``. A list as a value has brackets.
    settings : sequence of str or Setting
        What the command line gives to keys for all points.

    Raises
    ------
    click.UsageError
        If one cannot be understood, or two options give the same key.
    """
    if not texts:
        return ()
    from des_cli.batch.grid import Axis

    axes: list[Axis] = []
    for text in texts:
        key, equals, values = text.partition("=")
        if not key.strip() or not equals:
            raise _wrong(text, "is not KEY=VALUE,VALUE, such as r2=0.2,1")
        path = _path(key.strip(), text)
        if any(axis.path == path for axis in axes):
            raise _wrong(text, f"{path} is given twice")
        axes.append(Axis(path, _values(path, values, text)))
    for axis in axes:
        _refuse_settings_of(axis.path, settings)
    return tuple(axes)


def _path(key: str, text: str) -> str:
    """Return the path of a key from the top of a profile."""
    from des_cli.batch.grid import NAME
    from des_cli.profiles_in.overrides import parse_path
    from des_cli.profiles_in.schema import ProfileDocument

    try:
        first = parse_path(key, "")[0]
    except ProfileError as error:
        raise _wrong(text, str(error)) from None
    path = key if first in ProfileDocument.known_keys() else f"{_REDUCTION}.{key}"
    if path in (NAME, "format"):
        raise _wrong(text, f"{path} is no key to vary: the runs are named after the values")
    return path


def _values(path: str, values: str, text: str) -> tuple[Any, ...]:
    """Return the values of a key, each once, in their order."""
    from des_cli.profiles_in.yaml_nodes import parse_yaml

    try:
        found = parse_yaml(f"[{values}]", "").plain()
    except ProfileError:
        found = []
    if not isinstance(found, list) or not found or None in found:
        raise _wrong(text, "are not values with commas between; a list has brackets: [0,2,0]")
    if path.startswith(_BUDGETS):
        found = [_without_percent(path, value) for value in found]
    return tuple({json.dumps(value): value for value in found}.values())


def _without_percent(path: str, value: Any) -> Any:
    if not isinstance(value, str):
        return value
    plain = without_percent(path.removeprefix(_BUDGETS), value)
    return value if plain == value else float(plain)


def _refuse_settings_of(path: str, settings: Sequence[AnySetting]) -> None:
    """Refuse a setting for all points of a key, or of one below it, that the grid varies."""
    for setting in settings:
        below: list[str]
        if isinstance(setting, str):
            below, said = [setting.partition("=")[0].strip()], f"--set {setting}"
        else:
            inside = setting.value if isinstance(setting.value, dict) else {}
            below = [f"{setting.path}.{key}" for key in inside] or [setting.path]
            said = setting.option
        if any(each == path or each.startswith((f"{path}.", f"{path}[")) for each in below):
            raise click.UsageError(f"--grid varies {path}, and {said} gives it: leave one out.")


def _wrong(text: str, what: str) -> click.UsageError:
    return click.UsageError(f"--grid {text}: {what}.")
