"""The measured parts of the Coriolis cross-coupling vector, each declared once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

ComponentKey: TypeAlias = Literal["ab3", "bb3", "cb3", "vector", "seat_x", "seat_y", "seat_z"]


@dataclass(frozen=True, slots=True)
class Component:
    """A part of the Coriolis vector c.

    Parameters
    ----------
    key : str
        Its name under ``coriolis`` of the metrics.
    label : str
        What it is called on a line of text.
    axes : {"report", "seat"} or None
        The axes of which it is a component; None for the whole vector's length.
    index : int
        Which component, 0 to 2; 0 for the whole vector.
    """

    key: ComponentKey
    label: str
    axes: Literal["report", "seat"] | None
    index: int = 0


COMPONENTS: tuple[Component, ...] = (
    Component("ab3", "AB3", "report", 0),
    Component("bb3", "BB3", "report", 1),
    Component("cb3", "CB3", "report", 2),
    Component("vector", "whole vector", None),
    Component("seat_x", "seat x", "seat", 0),
    Component("seat_y", "seat y", "seat", 1),
    Component("seat_z", "seat z", "seat", 2),
)
"""The parts in the order in which they are reported."""
