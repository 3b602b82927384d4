"""Numbers for people to read and change: in the unit in which they are short, and exact."""

from __future__ import annotations

from collections.abc import Sequence

from des_cli.units import UNITS, Unit

_MOST_DIGITS = 17
"""With so many every double reads back."""

_FOREIGN = 2
"""Characters by which a number in another unit must be shorter than in SI to be preferred."""


def shortest_unit(suffixes: Sequence[str], values: Sequence[float]) -> tuple[Unit, list[str]]:
    """Return the unit in which values are shortest to write, and the values in it.

    Parameters
    ----------
    suffixes : sequence of str
        Of the units to choose from; the first is SI.
    values : sequence of float
        In SI, finite.

    Returns
    -------
    Unit
    list of str
        Each, read as a double and times ``to_si`` of the unit, is the value to the last bit.

    >>> unit, texts = shortest_unit(("m", "ft"), [19 * 0.3048, 3.9 * 0.3048])
    >>> unit.suffix, texts
    ('ft', ['19', '3.9'])
    """
    by_suffix = {unit.suffix: unit for unit in UNITS}
    best: tuple[int, Unit, list[str]] | None = None
    for place, suffix in enumerate(suffixes):
        unit = by_suffix[suffix]
        texts = [_exact(value, unit.to_si) for value in values]
        exact = [text for text in texts if text is not None]
        if len(exact) < len(texts):
            continue
        length = max(map(len, exact)) + _FOREIGN * (place > 0)
        if best is None or length < best[0]:
            best = length, unit, exact
    assert best is not None, "in SI every double is exact"
    return best[1:]


def _exact(value: float, to_si: float) -> str | None:
    """Write a value over a unit with the fewest digits that give it back, if any do."""
    for digits in range(1, _MOST_DIGITS + 1):
        number = float(f"{value / to_si:.{digits}g}")
        if number * to_si == value:
            return repr(number).removesuffix(".0")
    return None
