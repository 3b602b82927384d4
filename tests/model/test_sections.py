"""Dataclasses become JSON objects: keys, order, inner sections, and what is left out."""

import json
from dataclasses import dataclass, field, fields

from des_cli.model.sections import INLINED, LEFT_OUT, as_mapping, is_inlined, key_of, keyed


@dataclass(frozen=True)
class Inner:
    low: float | None = None
    high: float = 2.0


@dataclass(frozen=True)
class Outer:
    first: int = 1
    inlined: Inner = field(default_factory=Inner, metadata=INLINED)
    renamed: str = field(default="x", metadata=keyed("a key"))
    absent: float | None = field(default=None, metadata=LEFT_OUT)
    nested: Inner = field(default_factory=Inner)
    several: tuple[Inner, ...] = (Inner(), Inner(0.0))
    by_name: dict[str, Inner] = field(default_factory=lambda: {"b": Inner(), "a": Inner(1.0)})


INNER = {"low": None, "high": 2.0}


def test_a_section_is_written_in_the_order_of_its_fields() -> None:
    mapping = as_mapping(Outer())
    assert list(mapping) == ["first", "low", "high", "a key", "nested", "several", "by_name"]
    assert json.loads(json.dumps(mapping)) == {
        "first": 1,
        **INNER,
        "a key": "x",
        "nested": INNER,
        "several": [INNER, {"low": 0.0, "high": 2.0}],
        "by_name": {"b": INNER, "a": {"low": 1.0, "high": 2.0}},
    }
    assert list(mapping["by_name"]) == ["b", "a"]


def test_a_field_that_may_be_left_out_is_there_where_it_has_a_value() -> None:
    assert as_mapping(Outer(absent=0.0))["absent"] == 0.0


def test_metadata_tells_key_and_place() -> None:
    by_name = {each.name: each for each in fields(Outer)}
    assert [key_of(by_name[name]) for name in ("first", "renamed")] == ["first", "a key"]
    assert [is_inlined(by_name[name]) for name in ("inlined", "nested")] == [True, False]
