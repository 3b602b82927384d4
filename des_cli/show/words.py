"""Numbers and labels as people read them, one copy for the console, the page and the figures.

A number that is missing, or is none, is no error. How a share is written in percent is said
by ``units.percent``, which the core's own sentences use too.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from des_cli import units
from des_cli.model.coriolis import COMPONENTS, ComponentKey
from des_cli.model.felt import BeforeAfter, GAxis


@dataclass(frozen=True, slots=True)
class Writing:
    """How numbers are written on one medium.

    Parameters
    ----------
    unknown : str
        What stands for a number that is not known.
    minus, space, arrow : str
        The sign of negative numbers, what keeps a number and its unit together, and what
        stands between before and after.
    """

    unknown: str
    minus: str
    space: str
    arrow: str

    def percent(self, share: float | None) -> str:
        """Write a share in percent.

        >>> [CONSOLE.percent(value) for value in (0.6892, 0.0163, -0.0016, 7.5, None)]
        ['68.9 %', '1.6 %', '-0.16 %', '750 %', 'not known']
        """
        return self._known(share, units.percent).replace(" %", f"{self.space}%")

    def number(self, value: float | None, digits: int = 3) -> str:
        """Write a number with so many significant digits.

        >>> PAGE.number(0.2590558), PAGE.number(-1.5e-12, 2), PAGE.number(0.0)
        ('0.259', '−1.5e-12', '0')
        """
        return self._known(value, lambda known: f"{known:.{digits}g}")

    def fixed(self, value: float | None, decimals: int = 3) -> str:
        """Write a number with so many decimals.

        >>> PAGE.fixed(-0.0001), CONSOLE.fixed(-28.648, 1)
        ('0.000', '-28.6')
        """
        return self._known(value, lambda known: f"{known:.{decimals}f}")

    def less(self, reduction: float | None) -> str:
        """Say a reduction in words that need no sign.

        >>> CONSOLE.less(0.689), CONSOLE.less(-0.28), CONSOLE.less(None)
        ('68.9 % less', '28.0 % more', 'not known')
        """
        if reduction is None or not math.isfinite(reduction):
            return self.unknown
        return f"{self.percent(abs(reduction))} {'less' if reduction >= 0 else 'more'}"

    def change(self, reduction: float | None) -> str:
        """Write a reduction as the change of the squared integral that it is.

        >>> [PAGE.change(value).replace(PAGE.space, " ") for value in (0.689, -0.28, 0.0)]
        ['−68.9 %', '+28.0 %', '0.00 %']
        """
        if reduction is None:
            return self.unknown
        text = self.percent(-reduction)
        return f"+{text}" if reduction < 0 else text

    def from_to(self, pair: BeforeAfter, digits: int = 3) -> str:
        """Write a quantity before and after, empty where either is not known.

        >>> CONSOLE.from_to(BeforeAfter(0.4621, 0.447)), PAGE.from_to(BeforeAfter(None, 1.0))
        ('0.462 -> 0.447', '')
        """
        if pair.known is None:
            return ""
        before, after = (self.number(each, digits) for each in pair.known)
        return f"{before} {self.arrow} {after}"

    def sentence(self, words: str) -> str:
        """Give the numbers of a sentence of the core this medium's signs.

        >>> PAGE.sentence("peak Gy 0.5 -> 0.6 g, start off by cab -0.02 rad/s")
        'peak Gy 0.5 → 0.6 g, start off by cab −0.02 rad/s'
        """
        return words.replace("->", self.arrow).replace(" -", f" {self.minus}")

    def _known(self, value: float | None, write: units.Write) -> str:
        if value is None or not math.isfinite(value):
            return self.unknown
        text = write(value)
        if text.startswith("-"):  # a true minus, and a rounded zero has none
            text = f"{self.minus if text.strip('-0. %') else ''}{text[1:]}"
        return text


CONSOLE = Writing(unknown="not known", minus="-", space=" ", arrow="->")
PAGE = Writing(unknown="–", minus="−", space="\u00a0", arrow="→")
FIGURE = Writing(unknown="–", minus="−", space=" ", arrow="→")

PARTS: Mapping[ComponentKey, str] = MappingProxyType({each.key: each.label for each in COMPONENTS})
"""What the parts of the cross-coupling are called."""


def in_sentence(part: ComponentKey) -> str:
    """Name a part of the cross-coupling inside a sentence.

    >>> in_sentence("vector"), in_sentence("bb3")
    ('the whole vector', 'BB3')
    """
    return f"the {PARTS[part]}" if part == "vector" else PARTS[part]


def axis_name(axis: GAxis) -> str:
    """Name a component of the G-vector: ``Gx``."""
    return axis.capitalize()


def steps_taken(iterations: int | None) -> str:
    """Say how many iterations a solver took."""
    return "1 iteration" if iterations == 1 else f"{iterations} iterations"


def told_parts(objective: Collection[str]) -> tuple[ComponentKey, ...]:
    """Name the whole vector, and the component that was weighed, if it is one."""
    weighed = tuple(each.key for each in COMPONENTS if each.key in objective)
    return ("vector", *(weighed if len(weighed) == 1 else ()))


def text_of(value: object) -> str:
    """Write what should be a text on the page, whatever it is."""
    return PAGE.unknown if value is None or value == "" else str(value)


def listed(parts: Sequence[str]) -> str:
    """Join parts as a sentence does.

    >>> listed(["a"]), listed(["a", "b"]), listed(["a", "b", "c"])
    ('a', 'a and b', 'a, b and c')
    """
    return " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)
