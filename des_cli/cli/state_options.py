"""A state of the joints by options: each quantity in any unit of the table."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

import click

from des_cli.cli.command import STATE, option
from des_cli.model.machine import JOINTS
from des_cli.units import split_unit, suffixes

F = TypeVar("F", bound=Callable[..., Any])

QUANTITIES: tuple[tuple[str, str], ...] = (
    *((joint, kind) for joint in JOINTS for kind in ("angle", "rate", "acceleration")),
    ("seat_yaw", "angle"),
    ("seat_pitch", "angle"),
)
"""What an option gives, each in any unit of the table."""

LARGEST = 1e6
"""Largest magnitude of an option in SI units; no machine comes near."""


def state_options(
    quantities: Sequence[tuple[str, str]] = QUANTITIES, heading: str = STATE
) -> Callable[[F], F]:
    """Return what adds an option for each quantity and each unit that measures it."""

    def add(command: F) -> F:
        for stem, kind in reversed(quantities):
            for suffix in reversed(suffixes(kind)):
                name = f"{stem}_{suffix}"
                plain = kind == "angle" and "_" in stem
                words = stem.replace("_", " ") if plain else f"{stem} {kind}"
                command = option(
                    heading,
                    option_name(name),
                    name,
                    type=float,
                    metavar="NUMBER",
                    callback=_require_plain_number,
                    help=f"{words[0].upper()}{words[1:]} [{_written(suffix)}].",
                )(command)
        return command

    return add


def in_si(given: Mapping[str, float]) -> dict[tuple[str, str], float]:
    """Turn options into SI values by stem and quantity.

    Raises
    ------
    click.UsageError
        Naming the options, if two give the same quantity.
    """
    found: dict[tuple[str, str], float] = {}
    names: dict[tuple[str, str], str] = {}
    for name, value in given.items():
        stem, unit = split_unit(name)
        assert unit is not None, name
        key = stem, unit.quantity
        if key in found:
            raise click.UsageError(
                f"{option_name(names[key])} and {option_name(name)} give the same quantity: "
                "keep one of them."
            )
        found[key], names[key] = value * unit.to_si, name
    return found


def option_name(name: str) -> str:
    """Return the option of a name: ``arm_rad_s`` is ``--arm-rad-s``."""
    return f"--{name.replace('_', '-')}"


def _require_plain_number(
    context: click.Context, parameter: click.Parameter, value: float | None
) -> float | None:
    if value is None:
        return None
    unit = split_unit(str(parameter.name))[1]
    assert unit is not None, parameter.name
    if not math.isfinite(value) or abs(value * unit.to_si) > LARGEST:
        raise click.BadParameter(f"{value:g} is not a number that a machine can meet.")
    return value


def _written(suffix: str) -> str:
    """Write a suffix as a unit.

    >>> _written("rad_s2"), _written("rpm")
    ('rad/s^2', 'rpm')
    """
    return suffix.replace("_s2", "/s^2").replace("_s", "/s")
