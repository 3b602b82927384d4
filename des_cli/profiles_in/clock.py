"""Times of day and dates with times, as recorders write them: seconds between them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import date
from decimal import Decimal

_ZONE = r"(?P<zone>Z|[+-]\d\d(?::?\d\d)?)?"
_SECONDS = r"(?P<s>[0-5]\d|60)(?P<fraction>[.,]\d+)?"
_DATE = re.compile(
    r"(?P<date>\d{4}([-/])\d\d?\2\d\d?)[T ]\s*"
    rf"(?P<h>\d\d?):(?P<m>[0-5]\d)(?::{_SECONDS})?\s*{_ZONE}",
    re.ASCII | re.IGNORECASE,
)
_CLOCK = re.compile(rf"(?:(?P<h>\d\d?):)?(?P<m>[0-5]?\d):{_SECONDS}", re.ASCII)

_DAY, _HOUR = Decimal(86400), Decimal(3600)


class ClockError(ValueError):
    """A column of times cannot be read; carries the row and words for a person."""

    def __init__(self, row: int, what: str) -> None:
        super().__init__(what)
        self.row = row


def is_clock(cell: str) -> bool:
    """Whether a cell is a time of day, or a date with one.

    >>> is_clock("2024-05-01T12:00:00.123Z"), is_clock("01:02.5"), is_clock("1.5")
    (True, True, False)
    """
    return ":" in cell and bool(_DATE.fullmatch(cell.strip()) or _CLOCK.fullmatch(cell.strip()))


def seconds_of(cells: Sequence[str]) -> tuple[list[float], int]:
    """Return the times since the first one.

    Parameters
    ----------
    cells : sequence of str
        All of one form: dates with times (ISO 8601, with a zone or without),
        ``12:00:00.123``, or minutes and seconds ``01:02.5``.

    Returns
    -------
    seconds : list of float
        [s]
    turns : int
        How often the clock passed its end (midnight, or the full hour where
        only minutes and seconds are written) and started anew.

    Raises
    ------
    ClockError
        If a time is none, or is not written as the first one is; or if
        minutes and seconds could as well be hours and minutes.
    """
    found = [_parse(row, cell.strip()) for row, cell in enumerate(cells)]
    form = found[0][0]
    for row, (own, _) in enumerate(found):
        if own != form:
            raise ClockError(row, f"is not written as the first time, {cells[0].strip()}")
    if form == "m:s" and not any(sign in cell for cell in cells for sign in ".,"):
        what = "may be minutes and seconds or hours and minutes; write it as 00:01:02"
        raise ClockError(0, what)
    period = {"h:m:s": _DAY, "m:s": _HOUR}.get(form)
    result, turns, before = [], 0, found[0][1]
    for _, value in found:
        if period is not None and value - before < -period / 2:
            turns += 1
        before = value
        result.append(float(value - found[0][1] + turns * (period or 0)))
    return result, turns


def _parse(row: int, cell: str) -> tuple[str, Decimal]:
    """Return how a time is written, and its seconds since some origin of that form."""
    match = _DATE.fullmatch(cell) or _CLOCK.fullmatch(cell)
    if match is None:
        raise ClockError(row, "is no time")
    given = match.groupdict()
    seconds = 3600 * int(given["h"] or 0) + 60 * int(given["m"]) + int(given["s"] or 0)
    exact = Decimal(seconds) + Decimal((given["fraction"] or "0").replace(",", "."))
    if "date" not in given:
        return "h:m:s" if given["h"] else "m:s", exact
    try:
        day = date(*(int(part) for part in re.split("[-/]", given["date"])))
    except ValueError:
        raise ClockError(row, "is no date of the calendar") from None
    zone = given["zone"]
    exact += _DAY * day.toordinal() - (_offset(zone) if zone else 0)
    return "date with a zone" if zone else "date", exact


def _offset(zone: str) -> int:
    """Return how far a zone is ahead of universal time [s].

    >>> _offset("+05:30"), _offset("-08"), _offset("Z")
    (19800, -28800, 0)
    """
    if zone in "zZ":
        return 0
    digits = zone[1:].replace(":", "")
    seconds = 3600 * int(digits[:2]) + 60 * int(digits[2:] or 0)
    return -seconds if zone[0] == "-" else seconds
