"""In what form rows are written: their columns and units, and what stands between them.

Plain data, made before numpy is imported. A preset is the form that another program reads; what
each of them asks for is in ``docs/formats.md`` with its source.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

from des_cli.model.machine import JOINTS
from des_cli.units import split_unit, suffixes

Kind: TypeAlias = Literal["csv", "ndjson", "json", "parquet", "ros2", "xlsx", "mcap"]
"""Of file."""

TIMES = ("t", "elapsed")
"""Stems of a time: the table's own, and the one since the first row, rounded to nanoseconds."""

QUANTITIES = ("angle", "rate", "acceleration")
"""Of a joint that can be a column."""

SEPARATORS: Mapping[str, str] = {"tab": "\t", "space": " "}
"""Signs that have a name; any other single sign is itself."""


@dataclass(frozen=True, slots=True)
class Column:
    """A column of numbers.

    Parameters
    ----------
    name : str
        A quantity with its unit, as in ``fork_deg_s``.
    header : str
        What the header calls it.
    """

    name: str
    header: str


@dataclass(frozen=True, slots=True)
class Form:
    """How rows are written.

    Parameters
    ----------
    kind : str
    columns : tuple of Column
        Of ``ros2`` and ``mcap`` none: what they hold is theirs.
    separator : str
        Of a ``csv``.
    header : bool
        Whether a ``csv`` begins with the names of its columns.
    unit_row : bool
        Whether a ``csv`` has a row of units below them.
    hz : float, optional
        Rows a second; None for the table's own.
    """

    kind: Kind = "csv"
    columns: tuple[Column, ...] = ()
    separator: str = ","
    header: bool = True
    unit_row: bool = False
    hz: float | None = None

    @property
    def timed(self) -> bool:
        """Whether the time of a row is told; otherwise rows have to be evenly spaced."""
        return self.kind in ("ros2", "mcap") or any(
            split_unit(column.name)[0] in TIMES for column in self.columns
        )


def _columns(**headers: str) -> tuple[Column, ...]:
    return tuple(Column(name, header) for name, header in headers.items())


COMMANDS = tuple(Column(name, name) for name in ("t_s", "arm_rpm", "fork_deg", "cab_deg"))
"""Columns of a command table."""

_IN_RADIANS = tuple(
    Column(f"{joint}_{unit}", f"{joint}_{unit}")
    for joint in JOINTS
    for unit in ("rad", "rad_s", "rad_s2")
)

PRESETS: Mapping[str, Form] = {
    "halstreamer": Form(columns=COMMANDS[1:], separator=" ", header=False),
    "veristand": Form(columns=(*_columns(elapsed_ms="timestamp"), *COMMANDS[1:])),
    "simulink": Form(columns=(*_columns(elapsed_s="time"), *_IN_RADIANS), unit_row=True),
    "ros2": Form("ros2"),
    "xlsx": Form("xlsx", COMMANDS),
    "mcap": Form("mcap"),
}
"""By the name of the program, or of the format, that is to read them."""

ENDINGS: Mapping[str, tuple[str, ...]] = {
    "halstreamer": ("txt", "dat"),
    "veristand": ("csv",),
    "simulink": ("csv", "xlsx"),
    "ros2": ("yaml", "yml"),
    "xlsx": ("xlsx",),
    "mcap": ("mcap",),
}
"""Of names of files, by preset."""


def read_columns(text: str) -> tuple[Column, ...]:
    """Read a list of columns.

    Parameters
    ----------
    text : str
        Names with commas between, each with a header of its own if it has ``=HEADER``.

    Raises
    ------
    ValueError
        Which of them is none, and what one is.

    >>> [column.header for column in read_columns("t_s=time, arm_rpm")]
    ['time', 'arm_rpm']
    """
    found = []
    for part in text.split(","):
        name, equals, header = (each.strip() for each in part.partition("="))
        if not is_column(name):
            joints = f"{', '.join(JOINTS[:-1])} or {JOINTS[-1]}"
            units = ", ".join(unit for quantity in QUANTITIES for unit in suffixes(quantity))
            raise ValueError(
                f"{name!r} is no column: t or elapsed with a unit of time "
                f"({', '.join(suffixes('time'))}), or {joints} with one of {units}"
            )
        if equals and not header:
            raise ValueError(f"{name}= names no header")
        found.append(Column(name, header or name))
    headers = [column.header for column in found]
    if twice := [header for header in headers if headers.count(header) > 1]:
        raise ValueError(f"{twice[0]!r} is there twice")
    return tuple(found)


def is_column(name: str) -> bool:
    """Tell whether there is a column of this name."""
    stem, unit = split_unit(name)
    if unit is None:
        return False
    if stem in TIMES:
        return unit.quantity == "time"
    return stem in JOINTS and unit.quantity in QUANTITIES


def read_separator(text: str) -> str:
    """Return the sign that an option means.

    Raises
    ------
    ValueError
        If it is no single sign, or one that numbers are written with.
    """
    sign = SEPARATORS.get(text, text)
    if len(sign) != 1 or sign.isalnum() or sign in ".+-_\n\r\"'":
        raise ValueError(f"{text!r} cannot stand between numbers: give ',', ';', '|', tab or space")
    return sign


def as_spreadsheet(form: Form) -> Form:
    """Return the form of a spreadsheet with the same columns, whose first row are their names."""
    return replace(form, kind="xlsx", unit_row=False, separator=",", header=True)
