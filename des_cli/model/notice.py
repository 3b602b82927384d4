"""Sentences for the user's attention, each with a name that scripts can ask for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

NoticeName: TypeAlias = Literal[
    "worse",
    "turning",
    "g-jump",
    "start",
    "geometry",
    "felt",
    "ill-posed",
    "bought",
    "damped",
    "asked-g",
    "noisy",
    "record",
    "replaced",
    "uncoupled",
    "short",
    "earlier",
]
"""What a notice is called, the same in every version."""

HARMS: tuple[NoticeName, ...] = (
    "worse",
    "turning",
    "g-jump",
    "start",
    "geometry",
    "felt",
    "ill-posed",
    "bought",
    "damped",
)
"""Those that warn of harm to the occupant or to what the maneuver is for; what each means
stands in ``docs/formats.md``."""


@dataclass(frozen=True, slots=True)
class Notice:
    """One sentence with its name.

    Parameters
    ----------
    name : str
        Of ``NoticeName``; of a run of an older or newer version it may be another, or empty.
    text : str
    """

    name: str
    text: str

    @property
    def harmful(self) -> bool:
        """Whether it warns of harm: such a one is told even where quiet is asked for."""
        return self.name in HARMS

    def __str__(self) -> str:
        return self.text
