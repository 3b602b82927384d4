"""Numbers of ``metrics.json`` as the page writes them.

A number that is missing, or is none, is shown as a dash and never an error; see
``results.reading``.
"""

from __future__ import annotations

from typing import Any

DASH = "–"
NO_BREAK = "\u00a0"


def percent(value: float | None) -> str:
    """Write a ratio in percent, with digits that mean something, on one line.

    >>> [percent(value).replace(NO_BREAK, " ") for value in (0.6892, 0.00163, -0.28, 7.5, None)]
    ['68.9 %', '0.16 %', '−28.0 %', '750 %', '–']
    """
    if value is None:
        return DASH
    hundredths = 100.0 * value
    size = abs(hundredths)
    digits = 0 if size >= 99.95 else 1 if size >= 9.995 else 2
    return _signed(f"{hundredths:.{digits}f}") + f"{NO_BREAK}%"


def change(reduction: float | None) -> str:
    """Write a reduction as the change of the squared integral that it is.

    >>> [change(value).replace(NO_BREAK, " ") for value in (0.689, -0.28, 0.0)]
    ['−68.9 %', '+28.0 %', '0.00 %']
    """
    if reduction is None:
        return DASH
    text = percent(-reduction)
    return f"+{text}" if reduction < 0 else text


def plain(value: float | None, digits: int = 4) -> str:
    """Write a number with so many significant digits.

    >>> plain(0.2590558), plain(-1.5e-12, 2), plain(0.0)
    ('0.2591', '−1.5e-12', '0')
    """
    return DASH if value is None else _signed(f"{value:.{digits}g}")


def fixed(value: float | None, decimals: int = 3) -> str:
    """Write a number with so many decimals.

    >>> fixed(-0.0001)
    '0.000'
    """
    return DASH if value is None else _signed(f"{value:.{decimals}f}")


def words(value: Any) -> str:
    """Write what should be a text, whatever it is."""
    return DASH if value is None or value == "" else str(value)


def _signed(text: str) -> str:
    """Give a number a true minus sign, and a rounded zero none."""
    if text.startswith("-"):
        text = text[1:] if not text.strip("-0.") else "−" + text[1:]
    return text
