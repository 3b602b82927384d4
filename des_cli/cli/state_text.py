"""The kinematics of states as aligned text, for a terminal."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from des_cli.model.machine import JOINTS, Machine, Seat

if TYPE_CHECKING:
    from des_cli.model.arrays import Floats
    from des_cli.runs_out.state_tables import Quantity
    from des_cli.study.state import StateReport

WIDTH = 14
"""Of a column of numbers."""

# What a table of many states shows: field, component, header, unit, factor.
_OVERVIEW: tuple[tuple[str, int, str, str], ...] = (
    *(("angle", i, name, "deg") for i, name in enumerate(JOINTS)),
    *(("coriolis_ground", i, name, "rad/s^2") for i, name in enumerate(("AB3", "BB3", "CB3"))),
    *(("coriolis_seat", i, f"seat {name}", "rad/s^2") for i, name in enumerate("xyz")),
    *(("g_vector", i, name, "g") for i, name in enumerate(("Gx", "Gy", "Gz"))),
    ("singular_values", 2, "distance", "1"),
)


def state_text(report: StateReport, machine: Machine, seat: Seat) -> str:
    """Write everything that is known of the first state of a report."""
    from des_cli.runs_out.state_tables import QUANTITIES

    lines = [
        f"Machine {machine.name}, seat yaw {math.degrees(seat.yaw):.6g} deg, "
        f"pitch {math.degrees(seat.pitch):.6g} deg"
    ]
    for quantity in QUANTITIES:
        value = getattr(report, quantity.field)[0].tolist()
        lines += ["", *_table(quantity, value)]
        if quantity.field == "angle":
            lines.append(_row("in deg", [math.degrees(each) for each in value]))
    return "\n".join(lines) + "\n"


def motion_text(t: Floats, report: StateReport) -> str:
    """Write a line for each state of a motion, with the quantities most looked at."""
    columns = [getattr(report, field)[:, part].tolist() for field, part, _, _ in _OVERVIEW]
    heads = ["time", *(name for _, _, name, _ in _OVERVIEW)]
    units = ["s", *(unit for *_, unit in _OVERVIEW)]
    lines = [
        "Joint angles, Coriolis part of the angular acceleration along ground and seat axes, "
        "G-vector,",
        "and distance to the singularity (smallest singular value); --format csv has the rest",
        "",
        "".join(f"{head:>11}" for head in heads).rstrip(),
        "".join(f"{unit:>11}" for unit in units).rstrip(),
    ]
    for time, *values in zip(t.tolist(), *columns, strict=True):
        degrees = [math.degrees(value) for value in values[:3]]
        shown = [time, *degrees, *values[3:]]
        lines.append("".join(f"{_number(value, 4):>11}" for value in shown))
    return "\n".join(lines) + "\n"


def _table(quantity: Quantity, value: Any) -> Iterator[str]:
    """Write a number on the line of its title, a vector or a matrix below it."""
    unit = f" [{quantity.unit}]" if quantity.unit else ""
    if not quantity.rows:
        yield f"{quantity.title + unit:<{2 * WIDTH}}  {_number(value)}"
        return
    yield quantity.title + unit
    if quantity.columns:
        yield _row("", quantity.columns)
        for name, row in zip(quantity.rows, value, strict=True):
            yield _row(name, row)
    else:
        yield _row("", quantity.rows)
        yield _row("", value)


def _row(name: str, cells: Sequence[float | str]) -> str:
    texts = [each if isinstance(each, str) else _number(each) for each in cells]
    return f"  {name:<{WIDTH}}" + "".join(f"{text:>{WIDTH}}" for text in texts)


def _number(value: float, decimals: int = 6) -> str:
    """Write a number with decimals; a rounded zero has no sign."""
    text = f"{value:.{decimals}f}"
    if len(text) >= WIDTH:
        return f"{value:.{decimals}g}"
    return text.removeprefix("-") if not text.strip("-0.") else text
