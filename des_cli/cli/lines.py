"""What is said, as lines: wrapped for a terminal, or an object a line for a program."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from typing import Any, Literal, TypeAlias

Level: TypeAlias = Literal["debug", "info", "warning", "error"]
LogFormat: TypeAlias = Literal["text", "json"]

HANG = 4
"""Columns by which what does not fit on a line is indented, where nothing else is said."""

_NARROWEST = 40
"""Below so many columns words are left to the terminal."""

# Patterns are compiled when something is said: --help need not wait for it.
_TOGETHER = (
    r"(?<=\d) (?=(?:%|g|deg|rad|s|rpm|Hz|times)(?:[/,;:)\s]|$))"  # a number and its unit
    r"| (?=-> )|(?<=->) "  # before and after
    r"|(?<=\bt) (?==)|(?<=t =) "
    r"|(?<= g) (?=rms)|(?<=%) (?=less|more)"
)
_PARTS = r"(?<=[,;]) "
_STYLE = r"\x1b\[[\d;]*m"


def wrapped(
    text: str, columns: int | None, hang: int = HANG, *, whole: bool = False
) -> Iterator[str]:
    """Yield a line of words as lines of so many columns.

    A number stays with its unit, and a word that is longer than a line stays whole.

    Parameters
    ----------
    text : str
        It may hold styles, which take no room.
    columns : int, optional
        None leaves it as it is, and so does a terminal that is too narrow.
    hang : int
        Columns by which all lines but the first are indented.
    whole : bool
        Keep what stands between commas and semicolons on a line, where that holds it.

    >>> list(wrapped("off by 0.05 g rms, tilt 4 deg", 40, 2))
    ['off by 0.05 g rms, tilt 4 deg']
    >>> list(wrapped("the seat G is off by 0.05 g rms, and the tilt is 4 deg", 40, 2))
    ['the seat G is off by 0.05 g rms, and the', '  tilt is 4 deg']
    """
    if columns is None or columns < _NARROWEST or _width(text) <= columns:
        yield text
        return
    # What is indented begins with a label, which reaches as far as the other lines hang.
    head = text[:hang] if text.startswith(" ") else ""
    line, empty = head, True
    for word in _words(text[len(head) :], columns - hang if whole else 0):
        if not empty and _width(line) + 1 + _width(word) > columns:
            yield line.replace("\0", " ").rstrip()
            line, empty = " " * hang, True
        line, empty = f"{line}{word}" if empty else f"{line} {word}", False
    yield line.replace("\0", " ")


def _words(text: str, widest: int) -> Iterator[str]:
    """Yield what is to stay on a line: words, and parts of a list of at most so many columns."""
    for part in re.split(_PARTS, text):
        if _width(part) <= widest:
            yield part.replace(" ", "\0")
        else:
            yield from re.sub(_TOGETHER, "\0", part).split(" ")


def _width(text: str) -> int:
    return len(re.sub(_STYLE, "", text))


def json_line(level: Level, kind: str, text: str, facts: Mapping[str, Any]) -> str:
    r"""Return an object on one line: level, kind and text, then the facts that are known.

    >>> json_line("info", "notice", "5 µm", {"profile": "a", "name": None, "most": math.inf})
    '{"level": "info", "kind": "notice", "text": "5 \\u00b5m", "profile": "a", "most": null}'
    """
    import json  # --help need not wait for it

    known = {key: _plain(value) for key, value in facts.items() if value is not None}
    # ASCII alone: whatever the encoding of the stream, and nothing in it moves a cursor.
    return json.dumps({"level": level, "kind": kind, "text": text.strip(), **known})


def _plain(value: Any) -> Any:
    """Return a value that JSON has: it knows no infinity."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def asked_log_format(args: list[str]) -> LogFormat:
    """Return what ``--log-format`` says in a command line that may be wrong otherwise.

    What is wrong with it is told in that form too, and is found before options count.

    >>> asked_log_format(["reduce", "--log-format", "json"]), asked_log_format(["--", "json"])
    ('json', 'text')
    """
    options = args[: args.index("--")] if "--" in args else args
    for at, word in enumerate(options):
        if word == "--log-format=json" or options[at : at + 2] == ["--log-format", "json"]:
            return "json"
    return "text"
