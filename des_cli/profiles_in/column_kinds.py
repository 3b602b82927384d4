"""What the columns of a file may give: quantities, and the commands that they make up."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from enum import IntEnum

from des_cli.profiles_in.g_schema import G_STEMS, RATE_STEMS
from des_cli.units import Unit, suffixes

JOINTS = ("arm", "fork", "cab")
RATES = ("p", "q", "r")
QUATERNION = ("q0", "q1", "q2", "q3")
"""Recorded attitude (w, x, y, z), without a unit."""

ALIASES: Mapping[str, str] = dict(zip(("qw", "qx", "qy", "qz"), QUATERNION, strict=True))
"""Other names of the quaternion's columns."""

EULER = ("roll", "pitch", "yaw")
"""Recorded angles about the body's x, y and z, an attitude in a known order."""

QUANTITIES: Mapping[str, tuple[str, ...]] = {
    "t": ("time",),
    "arm": ("rate", "angle"),
    "fork": ("angle",),
    "cab": ("angle",),
    "p": ("rate",),
    "q": ("rate",),
    "r": ("rate",),
    **{stem: ("specific_force",) for stem in G_STEMS},
    **{stem: ("angle",) for stem in EULER},
    **{stem: () for stem in QUATERNION},
}
"""What each column may measure; nothing where it has no unit."""

IGNORED = ("quality",)
"""Columns that recorders add and that say nothing about the motion."""


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of commands that a file may hold, beside its times.

    Parameters
    ----------
    words : str
        What a message calls it.
    stems : tuple of str
        The quantities that it needs.
    example : str
        A header of it.
    beside : tuple of tuple of str
        Groups of quantities that are read too, each where it is complete.
    any_of : bool
        Whether one of the quantities is enough.
    """

    words: str
    stems: tuple[str, ...]
    example: str
    beside: tuple[tuple[str, ...], ...] = ()
    any_of: bool = False

    def complete(self, stems: Collection[str]) -> bool:
        """Whether some stems are enough for it."""
        return bool({*stems} & {*self.stems}) if self.any_of else {*stems} >= {*self.stems}


JOINT_COMMANDS = Kind("joint commands", JOINTS, "t_s,arm_rpm,fork_deg,cab_deg")
BODY_RATES = Kind("body rates", RATES, "t_s,p_rad_s,q_rad_s,r_rad_s", (QUATERNION, EULER))
ASKED_G = Kind("G", G_STEMS, "t_s,gz_g", tuple((stem,) for stem in RATE_STEMS), any_of=True)
COMMANDS = (JOINT_COMMANDS, BODY_RATES, ASKED_G)
ATTITUDES = (
    Kind("an attitude", QUATERNION, "t_s,q0,q1,q2,q3"),
    Kind("its angles", EULER, "t_s,roll_deg,pitch_deg,yaw_deg"),
)
"""Flown where nothing else is there; of both the first one."""

KINDS = (*COMMANDS, *ATTITUDES)


class Said(IntEnum):
    """Who says that a column is what it is taken for; the first one has the word."""

    BY_USER = 0
    BY_CONTRACT = 1
    BY_SPELLING = 2


@dataclass(frozen=True, slots=True)
class Column:
    """A column of the file that may be read.

    Parameters
    ----------
    stem : str
        Which quantity it gives.
    name : str
        Its name, with the unit where that has one.
    in_file : str
        Its name in the file.
    place : int
        Which column of the file.
    unit : Unit, optional
        None of an attitude, of times of day, and where the unit is not known.
    unit_text : str
        The unit as it is written.
    said : Said
    is_clock : bool
        Whether it holds times of day or dates instead of numbers.
    """

    stem: str
    name: str
    in_file: str
    place: int
    unit: Unit | None = None
    unit_text: str = ""
    said: Said = Said.BY_CONTRACT
    is_clock: bool = False

    @property
    def usable(self) -> bool:
        """Whether its numbers mean what the stem asks for."""
        quantities = QUANTITIES[self.stem]
        if self.stem == "t" and self.is_clock:
            return True
        if not quantities:
            return not self.unit_text
        return self.unit is not None and self.unit.quantity in quantities


def first_said(columns: Collection[Column], stem: str) -> list[Column]:
    """Return the usable columns of a quantity, of whoever has the word."""
    own = [column for column in columns if column.stem == stem and column.usable]
    first = min((column.said for column in own), default=Said.BY_USER)
    return [column for column in own if column.said == first]


def spelled(stem: str) -> list[str]:
    """Return every name of the contract for a quantity.

    >>> spelled("fork"), spelled("q0")
    (['fork_rad', 'fork_deg'], ['q0'])
    """
    kinds = QUANTITIES[stem]
    return [f"{stem}_{suffix}" for kind in kinds for suffix in suffixes(kind)] or [stem]
