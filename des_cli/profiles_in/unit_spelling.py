"""Units as recorders and spreadsheets write them in a header, and the names before them."""

from __future__ import annotations

import re
from dataclasses import dataclass

from des_cli.profiles_in.column_kinds import ALIASES, QUANTITIES
from des_cli.units import Unit, unit_named

_TIMES = {
    "s": "s sec secs second seconds",
    "ms": "ms msec msecs millisecond milliseconds",
    "us": "us usec usecs microsecond microseconds",
    "ns": "ns nsec nsecs nanosecond nanoseconds",
    "min": "min mins minute minutes",
}
_ANGLES = {"rad": "rad rads radian radians", "deg": "deg degs degree degrees"}
_RATES = {"rad_s": "radps rad_s", "deg_s": "dps degps deg_s", "rpm": "rpm r/min rev/min"}


def _aliases() -> dict[str, str]:
    """Return the suffix of the table by the spelling of the unit."""
    groups = (_TIMES, _ANGLES, _RATES)
    known = {
        word: unit for group in groups for unit, words in group.items() for word in words.split()
    }
    for unit, words in _ANGLES.items():
        # "rads" is as often rad/s as it is radians: alone it says nothing
        known.pop(f"{unit}s", None)
        for word in words.split():
            known |= {f"{word}/{second}": f"{unit}_s" for second in _TIMES["s"].split()}
            known |= {f"{word}_{second}": f"{unit}_s" for second in _TIMES["s"].split()}
    return known


_ALIASES = _aliases()
_STEMS = {stem: stem for stem in QUANTITIES} | {"time": "t", "timestamp": "t"} | {**ALIASES}
_LONGEST = 200
"""Characters up to which a name is taken apart; that takes their square in time."""

_CHANGE = re.compile(r"rate|speed|vel|acc", re.IGNORECASE)
"""What makes another quantity of the stem before it: yaw_rate is no yaw."""

_PER_SECOND = re.compile(r"[\s.*·⋅]*\bs\s*(\^?\s*\(?[-−]\s*1\)?|⁻¹)$|(?<=g|d)s(\^-1|⁻¹)$")
_BRACKETED = re.compile(r"(?P<stem>.*?)[\s_]*[\[(]\s*(?P<unit>[^\[\]()]*?)\s*[\])]")


@dataclass(frozen=True, slots=True)
class HeaderName:
    """A name of a file's header, taken apart.

    Parameters
    ----------
    stem : str
        What is measured: one of the stems of a profile where the name is one
        of theirs or means one (``Time``), else as it is written.
    unit : Unit, optional
        None where the name has none, or one that is not known.
    unit_text : str
        The unit as it is written.
    """

    stem: str
    unit: Unit | None = None
    unit_text: str = ""


def unit_of(text: str) -> Unit | None:
    """Return the unit that a spelling means, or None.

    >>> unit_of("°/s").suffix, unit_of("[rad s^-1]").suffix, unit_of("mrad/s")
    ('deg_s', 'rad_s', None)
    """
    if len(text) > _LONGEST:
        return None
    word = text.strip().strip("[]()").strip().casefold()
    word = word.replace("°", "deg").replace("º", "deg").replace("μ", "u").replace(" per ", "/")
    word = re.sub(r"\s+", "", _PER_SECOND.sub("/s", word))
    return unit_named(word) or unit_named(_ALIASES.get(word, ""))


def read_name(name: str) -> HeaderName:
    """Take a name of a header apart.

    >>> read_name("P (deg/s)").unit.suffix, read_name("Time [ms]").stem
    ('deg_s', 't')
    >>> read_name("p_mrad_s").unit_text, read_name("gyro_x_dps").unit.suffix
    ('mrad_s', 'deg_s')
    """
    if len(name) > _LONGEST:
        return HeaderName(name)
    bracketed = _BRACKETED.fullmatch(name)
    if bracketed:
        return HeaderName(_stem(bracketed["stem"]), unit_of(bracketed["unit"]), bracketed["unit"])
    for border in re.finditer(r"[\s_/]+", name):
        stem, text = name[: border.start()], name[border.end() :]
        # What follows one of our own stems is its unit, known or not: p_mrad_s is no p_mrad in s.
        ours = stem.casefold() in _STEMS and not _CHANGE.match(text)
        if text and (ours or unit_of(text)):
            return HeaderName(_stem(stem), unit_of(text), text)
    return HeaderName(_stem(name))


def _stem(text: str) -> str:
    return _STEMS.get(text.rstrip(" _/").casefold(), text)
