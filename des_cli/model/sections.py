"""Sections of a JSON document as dataclasses: a field is called as its key."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import Field, fields, is_dataclass
from types import MappingProxyType
from typing import Any

INLINED: Mapping[str, bool] = MappingProxyType({"inlined": True})
"""Metadata of a section whose keys stand among those of the section around it."""

LEFT_OUT: Mapping[str, bool] = MappingProxyType({"left_out": True})
"""Metadata of a field that has no key where it is None."""


def keyed(key: str) -> Mapping[str, str]:
    """Return the metadata of a field that has another name than its key."""
    return {"key": key}


def key_of(each: Field[Any]) -> str:
    """Return the key of a field."""
    key: str = each.metadata.get("key", each.name)
    return key


def is_inlined(each: Field[Any]) -> bool:
    """Return whether the keys of a field stand among those around it."""
    return "inlined" in each.metadata


def as_mapping(section: Any) -> dict[str, Any]:
    """Return what JSON writes of a section, with its keys in the order of its fields.

    Parameters
    ----------
    section : dataclass instance
        Of None, bool, int, float, str, tuples, mappings, and further sections.
    """
    found: dict[str, Any] = {}
    for each in fields(section):
        value = getattr(section, each.name)
        if is_inlined(each):
            found |= _plain(value)
        elif value is not None or "left_out" not in each.metadata:
            found[key_of(each)] = _plain(value)
    return found


def _plain(value: Any) -> Any:
    if is_dataclass(value):
        return as_mapping(value)
    if isinstance(value, Mapping):
        return {key: _plain(each) for key, each in value.items()}
    if isinstance(value, tuple):
        return [_plain(each) for each in value]
    return value
