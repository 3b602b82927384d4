"""How a table is written: what stands between its columns, and its decimal sign."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs", "|": "vertical bars", " ": "blanks"}
"""What may stand between two columns, and what a message calls it; blanks count as one."""

_WORDS = {"comma": ",", "semicolon": ";", "tab": "\t", "\\t": "\t", "bar": "|", "space": " "}
_TYPED = {"\t": "tab", " ": "space", ";": "';'", "|": "'|'", ",": ","}
_PLAIN_NUMBER = r"[-+]?(?:\d+(?:{0}\d*)?|{0}\d+)(?:[eE][-+]?\d+)?"
_NUMBER = {
    sign: re.compile(rf"\s*{_PLAIN_NUMBER.format(re.escape(sign))}\s*", re.ASCII) for sign in ".,"
}
_LOOKED_AT = 50
"""Rows from which the separator is told."""


@dataclass(frozen=True, slots=True)
class Dialect:
    """Separator and decimal sign of a table.

    Parameters
    ----------
    separator : str
        A key of `SEPARATORS`.
    decimal : {".", ","}
    """

    separator: str = ","
    decimal: str = "."

    def is_number(self, cell: str) -> bool:
        """Whether a cell is a number in plain decimal notation."""
        return _NUMBER[self.decimal].fullmatch(cell) is not None

    def number(self, cell: str) -> str:
        """Return a number as Python writes it."""
        return cell.strip().replace(self.decimal, ".")

    def records(self, lines: Iterable[str]) -> Iterator[list[str]]:
        """Iterate over the cells of each record; a quoted cell may span lines.

        Raises
        ------
        csv.Error
            If the quotes are wrong.
        """
        blanks = self.separator == " "
        if blanks:
            lines = (line.replace("\t", " ").strip(" ") for line in lines)
        return csv.reader(lines, delimiter=self.separator, skipinitialspace=blanks, strict=True)

    def split(self, line: str) -> list[str]:
        """Return the cells of one line, or the whole of it where its quotes are wrong."""
        try:
            return next(self.records([line]), [])
        except csv.Error:
            return [line]


PLAIN = Dialect()
"""Commas and decimal points, which need no options."""


def parse_separator(text: str) -> str:
    r"""Return the separator that a person means: the sign itself, or its name.

    Raises
    ------
    ValueError
        In words for the person.

    >>> parse_separator("tab"), parse_separator(";")
    ('\t', ';')
    """
    sign = _WORDS.get(text.strip().lower(), text)
    if sign not in SEPARATORS:
        raise ValueError("must be ',', ';', '|', tab or space")
    return sign


def parse_decimal(text: str) -> str:
    """Return the decimal sign that a person means.

    Raises
    ------
    ValueError
        In words for the person.

    >>> parse_decimal(","), parse_decimal("point")
    (',', '.')
    """
    sign = {"comma": ",", "point": "."}.get(text.strip().lower(), text)
    if sign not in (".", ","):
        raise ValueError("must be '.' or ','")
    return sign


def recognise(text: str, separator: str, decimal: str | None) -> Dialect:
    """Tell the dialect of a table from its header and rows.

    Parameters
    ----------
    text : str
        From the header on.
    separator : str
        The one that is expected: it stands unless it does not split the rows as it
        splits the header, or another one does and leaves more numbers.
    decimal : str, optional
        The one that was asked for: it stands unless no number is written with it
        and some are with the other.
    """
    lines = [line for line in text[: 1 << 16].splitlines()[: _LOOKED_AT + 1] if line.strip()]
    # The expected one comes first, and of several that split as well the first one counts.
    signs = (separator, *(sign for sign in (";", "\t", "|", ",", " ") if sign != separator))
    likely = [sign for sign in signs if _splits(lines, sign)]
    found = max(likely, key=lambda sign: _count_numbers(lines[1:], sign), default=separator)
    commas, points = _count_decimals(text, found, ","), 0
    if commas or decimal == ",":
        points = _count_decimals(text, found, ".")
    if decimal is not None:
        kept = (points if decimal == "." else commas) or not (commas or points)
        return Dialect(found, decimal if kept else "." if decimal == "," else ",")
    return Dialect(found, "," if commas > points else ".")


def how_to_ask(found: Dialect, asked: Dialect) -> str:
    """Say how a table is written, and which options read it so.

    >>> how_to_ask(Dialect(";", ","), Dialect())
    "the columns are separated by semicolons and the numbers have a decimal comma: \
give --separator ';' --decimal , (in YAML: separator: ';', decimal: ',')"
    """
    what, options, keys = [], [], []
    if found.separator != asked.separator:
        what.append(f"the columns are separated by {SEPARATORS[found.separator]}")
        options.append(f"--separator {_TYPED[found.separator]}")
        keys.append(f"separator: {_quoted(_TYPED[found.separator])}")
    if found.decimal != asked.decimal:
        what.append(f"the numbers have a decimal {'comma' if found.decimal == ',' else 'point'}")
        options.append(f"--decimal {found.decimal}")
        keys.append(f"decimal: '{found.decimal}'")
    return f"{' and '.join(what)}: give {' '.join(options)} (in YAML: {', '.join(keys)})"


def _quoted(typed: str) -> str:
    return f"'{typed}'" if typed == "," else typed


def _splits(lines: Sequence[str], sign: str) -> bool:
    """Whether a separator splits most of the rows into as many cells as the header."""
    dialect = Dialect(sign)
    widths = [len(_without_blank_end(dialect.split(line))) for line in lines]
    if not widths or widths[0] < 2:
        return False
    return 2 * sum(width == widths[0] for width in widths[1:]) >= len(widths) - 1


def _count_numbers(lines: Sequence[str], sign: str) -> int:
    """Count the cells that are numbers, with whatever decimal sign may stand beside a separator."""
    dialects = [Dialect(sign, decimal) for decimal in ".," if decimal != sign]
    return sum(
        any(dialect.is_number(cell) for dialect in dialects)
        for line in lines
        for cell in dialects[0].split(line)
    )


def _without_blank_end(cells: list[str]) -> list[str]:
    end = len(cells)
    while end and not cells[end - 1].strip():
        end -= 1
    return cells[:end]


def _count_decimals(text: str, separator: str, sign: str) -> int:
    """Count the cells that are numbers with a decimal sign."""
    number = rf"[-+]?\d*{re.escape(sign)}\d+(?:[eE][-+]?\d+)?"
    border = re.escape(separator) if separator != " " else r" \t"
    if sign not in text or (sign == separator and '"' not in text):
        return 0
    if sign == separator:
        return len(re.findall(rf'"\s*{number}\s*"', text))
    return len(
        re.findall(rf'(?:^|[{border}\r\n])"?[ ]*{number}(?=[ ]*"?(?:[{border}\r\n]|$))', text)
    )
