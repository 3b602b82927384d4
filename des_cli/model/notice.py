"""Sentences for the user's attention, each with a name that scripts can ask for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
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

HARMS: Mapping[str, str] = MappingProxyType(
    {
        "worse": "what is felt got worse than in the profile, by any of its measures",
        "turning": "the written table turns the seat harder than the desired motion",
        "g-jump": "the G of the written table jumps further than the desired motion's",
        "start": "the written table does not start where the profile does",
        "geometry": "the machine that it is checked against makes other G of the table",
        "felt": "the seat's rate or G is far from the profile's, and no budget bounds it",
        "ill-posed": "nothing holds the rates of the joints back",
        "bought": "a component of the cross-coupling grew",
        "damped": "the joints cannot follow the asked rates",
    }
)
"""Those that warn of harm to the occupant or to what the maneuver is for, and of what."""


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
