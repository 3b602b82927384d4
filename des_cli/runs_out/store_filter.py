"""Conditions on the rows of a store: ``seat_g_rms_error_g <= 0.05 and status = converged``.

Nothing of a condition is ever run: it is read by the grammar below, and becomes an expression
of Arrow.

    condition  = all {"or" all}
    all        = one {"and" one}
    one        = "not" one | "(" condition ")" | column sign value
    sign       = "<=" | ">=" | "<" | ">" | "=" | "==" | "!="
    value      = number | "true" | "false" | word | 'text' | "text"
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Mapping
from typing import Any

from des_cli.errors import UsageError
from des_cli.profiles_in.wording import did_you_mean, one_of, shown

_TOKEN = re.compile(r"""\s*(?:([<>!=]=|[<>=()])|('[^']*'|"[^"]*")|([^\s<>!=()'"]+))""")
_SIGNS: Mapping[str, Callable[[Any, Any], Any]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "<": operator.lt,
    ">": operator.gt,
    "=": operator.eq,
    "==": operator.eq,
    "!=": operator.ne,
}
_WORDS = ("and", "or", "not")
_FIRST, _NAMED = "fidelity", 4
"""The section that a bare key is looked for in first; so many columns a sentence names."""

_DEEPEST = 50
"""Conditions inside conditions; a person writes three."""


def parse_condition(text: str, kinds: Mapping[str, str]) -> Any:
    """Return an expression of ``pyarrow.compute``.

    Parameters
    ----------
    text : str
    kinds : mapping of str to str
        ``text``, ``truth`` or ``number`` by column. A fidelity metric may be called by its key
        alone, and any column by the last parts of its name where no other ends so: ``status``
        for ``solver.status``.

    Raises
    ------
    UsageError
        If it is no condition, or names no column.
    """
    reader = _Reader(text, kinds)
    expression = reader.condition(0)
    if reader.tokens:
        raise reader.wrong(f"what does {shown(reader.tokens[0])} mean after a whole condition?")
    return expression


class _Reader:
    """Reads a condition from the left."""

    def __init__(self, text: str, kinds: Mapping[str, str]) -> None:
        self.text, self.kinds = text, kinds
        self.tokens = self._split()

    def condition(self, depth: int) -> Any:
        found = self._all(depth)
        while self._next_is("or"):
            found = found | self._all(depth)
        return found

    def wrong(self, what: str) -> UsageError:
        error = UsageError.of(f"--where {shown(self.text)}: {what}")
        assert isinstance(error, UsageError)
        return error

    def _all(self, depth: int) -> Any:
        found = self._one(depth)
        while self._next_is("and"):
            found = found & self._one(depth)
        return found

    def _one(self, depth: int) -> Any:
        if depth > _DEEPEST:
            raise self.wrong(f"is more than {_DEEPEST} conditions deep")
        if self._next_is("not"):
            return ~self._one(depth + 1)
        if self._next_is("("):
            found = self.condition(depth + 1)
            if not self._next_is(")"):
                raise self.wrong("a ) is missing")
            return found
        return self._comparison()

    def _comparison(self) -> Any:
        import pyarrow.compute as pc

        column = self._column(self._take("a column"))
        sign = self._take("<, <=, =, !=, >= or >")
        if sign not in _SIGNS:
            raise self.wrong(f"<, <=, =, !=, >= or > is to follow {column}, not {shown(sign)}")
        value = self._value(column, self._take("a value"))
        return _SIGNS[sign](pc.field(column), pc.scalar(value))

    def _column(self, name: str) -> str:
        for whole in (name, f"{_FIRST}.{name}"):
            if whole in self.kinds:
                return whole
        ending = [column for column in self.kinds if column.endswith(f".{name}")]
        if len(ending) == 1:
            return ending[0]
        if ending:
            more = ["..."] if len(ending) > _NAMED else []
            raise self.wrong(f"{shown(name)} may be {one_of([*ending[:_NAMED], *more])}")
        last = {column.rpartition(".")[2] for column in self.kinds}
        hint = did_you_mean(name, [*self.kinds, *last])
        raise self.wrong(f"there is no column {shown(name)}{hint}")

    def _value(self, column: str, token: str) -> Any:
        kind = self.kinds[column]
        if kind == "text":
            return token[1:-1] if token[0] in "'\"" else token
        if kind == "truth":
            if token not in ("true", "false"):
                raise self.wrong(f"{column} is true or false, not {shown(token)}")
            return token == "true"
        try:
            return float(token)
        except ValueError:
            raise self.wrong(f"{column} is a number, not {shown(token)}") from None

    def _next_is(self, token: str) -> bool:
        if self.tokens and self.tokens[0] == token:
            self.tokens.pop(0)
            return True
        return False

    def _take(self, what: str) -> str:
        if not self.tokens or self.tokens[0] in (*_WORDS, "(", ")"):
            raise self.wrong(f"{what} is missing")
        return self.tokens.pop(0)

    def _split(self) -> list[str]:
        tokens, at = [], 0
        rest = self.text.rstrip()
        while at < len(rest):
            match = _TOKEN.match(rest, at)
            if not match:
                raise self.wrong(f"cannot be read from {shown(rest[at:].strip())} on")
            tokens.append(match[1] or match[2] or match[3])
            at = match.end()
        return tokens
