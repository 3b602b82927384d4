"""The metrics of any ``metrics.json``, typed.

The file may be of an older or newer version, or come from a stranger: what is missing, or
is not what it should be, is None and never an error.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import TYPE_CHECKING, Any, TypeVar, get_args, get_origin, get_type_hints

from des_cli.model.metrics import Metrics
from des_cli.model.sections import is_inlined, key_of

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Section = TypeVar("Section", bound="DataclassInstance")

_LARGEST_INTEGER = 2**53


def read_metrics(content: Any) -> Metrics:
    """Return the metrics that a mapping holds.

    Parameters
    ----------
    content : object
        Of ``metrics.json``; what is no mapping holds nothing.

    >>> read_metrics({"solver": {"cost": 0.25, "status": 3}}).solver.cost
    0.25
    >>> read_metrics({"solver": {"cost": 0.25, "status": 3}}).solver.status
    """
    return _section(Metrics, content)


def _section(kind: type[Section], content: Any) -> Section:
    """Return a section; its fields are all there, whatever the content is."""
    content = _mapping(content)
    hints = _hints(kind)
    own = {key_of(each) for each in fields(kind) if not is_inlined(each)}
    rest = {key: value for key, value in content.items() if key not in own}
    return kind(
        **{
            each.name: _value(
                hints[each.name], rest if is_inlined(each) else content.get(key_of(each))
            )
            for each in fields(kind)
        }
    )


@cache
def _hints(kind: Any) -> dict[str, Any]:
    return get_type_hints(kind)


def _value(hint: Any, value: Any) -> Any:
    """Return a value as its declaration wants it."""
    if get_origin(hint) is UnionType:
        (hint,) = (each for each in get_args(hint) if each is not NoneType)
        if hint in _PLAIN:
            return _PLAIN[hint](value)
        # A section, a mapping or a list that may be missing as a whole.
        given = isinstance(value, Mapping | list | tuple) and bool(value)
        return _value(hint, value) if given else None
    if is_dataclass(hint):
        return _section(hint, value)  # type: ignore[arg-type]
    if get_origin(hint) is tuple:
        items = value if isinstance(value, list | tuple) else ()
        found = (_value(get_args(hint)[0], each) for each in items)
        return tuple(each for each in found if each is not None) if _bare(hint) else tuple(found)
    if get_origin(hint) is Mapping:
        key, of = get_args(hint)
        return _by_key(key, of, _mapping(value))
    return _PLAIN[hint](value)


def _bare(hint: Any) -> bool:
    """Return whether a list holds plain values that are left out where they are none."""
    return get_args(hint)[0] in _PLAIN


def _by_key(key: Any, hint: Any, content: Mapping[str, Any]) -> dict[str, Any]:
    """Return values by key: sections by all keys that there are, others by those given."""
    names = get_args(key) or tuple(content)
    if not is_dataclass(hint):
        names = tuple(name for name in names if name in content)
    found = {name: _value(hint, content.get(name)) for name in names}
    return {name: each for name, each in found.items() if each is not None or hint not in _PLAIN}


def _mapping(value: Any) -> Mapping[str, Any]:
    return value if isinstance(value, Mapping) else {}


def _number(value: Any) -> float | None:
    """Return a finite number, None for what is none."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        value = float(value)
    except OverflowError:
        return None
    return value if math.isfinite(value) else None


def _integer(value: Any) -> int | None:
    number = _number(value)
    if number is None or not number.is_integer() or abs(number) > _LARGEST_INTEGER:
        return None
    return int(number)


def _text(value: Any) -> str | None:
    return value if isinstance(value, str) else None


def _flag(value: Any) -> bool | None:
    return value if isinstance(value, bool) else None


_PLAIN: Mapping[Any, Any] = {float: _number, int: _integer, str: _text, bool: _flag}
