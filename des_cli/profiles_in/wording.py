"""Words for people: what was meant, what was written, which choices there are."""

from __future__ import annotations

import difflib
import shlex
from collections.abc import Iterable, Sequence

_SHOWN_LENGTH = 60
"""Characters of a user's text that a message repeats."""


def shown(value: object) -> str:
    r"""Quote a user's text so that it stays on one line and is not too long.

    >>> shown("a" * 5), shown("two\nlines"), shown(3.0)
    ("'aaaaa'", "'two\\nlines'", '3')
    """
    if isinstance(value, float):
        return f"{value:.12g}"
    text = ascii(value) if isinstance(value, str) and not value.isprintable() else repr(value)
    return text if len(text) <= _SHOWN_LENGTH else f"{text[: _SHOWN_LENGTH - 3]}..."


def plain(name: str) -> str:
    r"""Repeat a user's name without quotes, unless it would leave its line.

    >>> plain("fork_deg"), plain("a\x1b[1m")
    ('fork_deg', "'a\\x1b[1m'")
    """
    fits = name.isprintable() and 0 < len(name) <= _SHOWN_LENGTH
    return name if fits else shown(name)


def option(name: str, value: str) -> str:
    """Write an option as a shell takes it.

    >>> option("--column", "t=UTC"), option("--column", "t=UTC time")
    ('--column t=UTC', "--column 't=UTC time'")
    """
    return f"{name} {shlex.quote(plain(value))}"


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return `` (did you mean x?)`` for the nearest known name, or nothing.

    >>> did_you_mean("cobar", ["cobra", "spike"])
    ' (did you mean cobra?)'
    """
    if len(name) > _SHOWN_LENGTH:
        return ""
    nearest = difflib.get_close_matches(name, sorted(set(known)), n=1, cutoff=0.6)
    return f" (did you mean {plain(nearest[0])}?)" if nearest else ""


def one_of(choices: Sequence[str]) -> str:
    """Join choices as a person would.

    >>> one_of(["a"]), one_of(["a", "b"]), one_of(["a", "b", "c"])
    ('a', 'a or b', 'a, b or c')
    """
    if len(choices) < 2:
        return "".join(choices)
    return f"{', '.join(choices[:-1])} or {choices[-1]}"
