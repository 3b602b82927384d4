"""The colours of the plots, and the pens that curves are drawn with."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

# Okabe and Ito's palette: distinct to the colour-blind, and in grey by its dashes.
GREY: Final = "#767676"
BLUE: Final = "#0072B2"
VERMILION: Final = "#D55E00"
GREEN: Final = "#009E73"

# What frames a curve: text, notes beside it, the axes, the line at zero, the grid.
INK: Final = "#262626"
NOTE: Final = "#5A5A5A"
AXIS: Final = "#9A9A9A"
ZERO: Final = "#C4C4C4"
FAINT: Final = "#E3E3E3"

# Inside a bound, and beyond it.
WITHIN: Final = "#EAF3EA"
BEYOND: Final = "#F7E3DA"


@dataclass(frozen=True, slots=True)
class Pen:
    """How a curve is drawn, and what the legend calls it."""

    label: str
    color: str
    dashes: Any = "-"
    width: float = 1.5
    zorder: float = 3.0
    marker: str = ""


DASHES = (0, (5, 2.2))
BEFORE = Pen("before", GREY, DASHES, 1.3, 2.5)
AFTER = Pen("after", BLUE)
DESIRED = Pen("desired", GREY, DASHES, 1.3, 2.5)
MODIFIED = Pen("modified", BLUE)
JOINT_PENS = (
    Pen("arm", BLUE),
    Pen("fork", VERMILION, (0, (6, 1.5))),
    Pen("cab", GREEN, (0, (2.5, 1.2))),
)
