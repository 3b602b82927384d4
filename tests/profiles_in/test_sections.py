"""Sections whose keys carry units: which key is read, in which unit, and what is said of others."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar

import pytest
from pydantic import Field, TypeAdapter, ValidationError

from des_cli.profiles_in.command_schema import Segment
from des_cli.profiles_in.schema import Seat
from des_cli.profiles_in.sections import OMITTED, Measure, Number, Section, fault
from tests.support.schemas import accepted, refused


class Part(Section):
    """A section with a quantity that must be there, one that need not, and a word."""

    elsewhere: ClassVar = {"colour": "stands in the catalogue"}

    turn: Annotated[str, Field(strict=True)] = OMITTED
    turn_number: Annotated[
        Number,
        Field(gt=0),
        Measure("angle", "the turn", required=True, others=("turn",), stem="turn"),
    ] = OMITTED
    wait: Annotated[Number, Measure("time", "the wait")] = OMITTED


def test_the_keys_are_those_of_the_units_and_the_field_s_name_is_none() -> None:
    assert Part.known_keys() == [
        "turn", "turn_rad", "turn_deg", "wait_s", "wait_ms", "wait_us", "wait_ns", "wait_min",
    ]  # fmt: skip
    assert Part.measure("turn").keys == ("turn_rad", "turn_deg", "turn")
    (line,) = refused(Part, "{turn_deg: 1, turn_number: 2}")
    assert line.startswith("f.yaml:1:15: turn_number: ")


@pytest.mark.parametrize(
    ("text", "turn", "wait"),
    [
        ("{turn_deg: 180}", math.pi, 9.0),
        ("{turn_rad: 2, wait_ms: 500}", 2.0, 0.5),
        ("{turn_rad: 2, wait_min: 2}", 2.0, 120.0),
        ("{turn_rad: 2, wait_s: 0}", 2.0, 0.0),
    ],
)
def test_a_quantity_is_asked_in_si_and_what_is_not_given_is_the_default(
    text: str, turn: float, wait: float
) -> None:
    part = accepted(Part, text)
    assert part.si("turn") == pytest.approx(turn)
    assert part.si("wait", 9.0) == wait


def test_a_field_is_no_key_and_a_value_stays_in_the_unit_of_its_key() -> None:
    segment = Segment.model_validate({"from_ms": 500, "to_s": 2, "value": "t"})
    assert (segment.given_key("from"), segment.from_, segment.si("from")) == ("from_ms", 500.0, 0.5)
    assert segment.written("from") == "from_ms (500)"
    with pytest.raises(ValidationError, match="the start of a segment needs its unit in the key"):
        Segment.model_validate({"from": 0, "to_s": 2, "value": 1})


def test_what_is_given_is_told_with_its_unit_and_nothing_of_what_is_not() -> None:
    part = accepted(Part, "{turn_deg: 90}")
    value, unit = part.given("turn")
    assert (value, unit.suffix, unit.quantity) == (90.0, "deg", "angle")
    assert (part.given("wait"), part.given_key("wait"), part.written("wait")) == (
        None,
        None,
        "wait",
    )


def test_a_word_may_stand_in_the_place_of_a_number_and_not_beside_it() -> None:
    part = accepted(Part, "{turn: endless}")
    assert (part.turn, part.given_key("turn")) == ("endless", "turn")
    (line,) = refused(Part, "{turn: endless, turn_deg: 3}")
    assert line == "f.yaml:1:1: the turn is given twice: turn_deg and turn; keep one"


def test_a_quantity_given_twice_is_named_with_what_is_wrong_in_each() -> None:
    with pytest.raises(ValidationError) as caught:
        Seat.model_validate({"yaw_deg": "north", "yaw_rad": "south", "pitch_deg": 1})
    found = [(error["loc"], error["type"]) for error in caught.value.errors()]
    assert found == [
        ((), "profile"),
        (("yaw_rad",), "float_type"),
        (("yaw_deg",), "float_type"),
    ]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("{}", "1:1: the turn is missing: give turn_rad, turn_deg or turn"),
        ("{turn_deg: 0}", "1:12: turn_deg: must be greater than 0, is 0"),
        ("{turn_deg: null}", "1:12: turn_deg: must be a number, is None"),
        ("{turn_deg: true}", "1:12: turn_deg: must be a number, is True"),
        ("{turn_deg: 1, wait_h: 2}",
         "1:15: wait_h: the wait needs its unit in the key: "
         "wait_s, wait_ms, wait_us, wait_ns or wait_min"),
        ("{turn_deg: 1, wiat_s: 2}", "1:15: wiat_s: is not a key here (did you mean wait_s?)"),
        ("{turn_deg: 1, colour: 2}", "1:15: colour: stands in the catalogue"),
        ("[1]", "1:1: must be a mapping with turn, turn_rad, turn_deg, wait_s, wait_ms, wait_us, "
                "wait_ns, wait_min"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_of_the_key_that_was_written(text: str, line: str) -> None:
    assert refused(Part, text) == [f"f.yaml:{line}"]


def test_a_key_of_a_wrong_unit_is_not_called_missing_too_and_all_comes_at_once() -> None:
    lines = refused(Part, "{turn_rpm: 1, wait_s: soon, depth: 2}")
    assert [line.split(": ")[1] for line in lines] == ["turn_rpm", "depth", "wait_s"]


def test_the_schema_describes_every_key_and_asks_for_exactly_one() -> None:
    schema = TypeAdapter(Part).json_schema()
    assert list(schema["properties"]) == Part.known_keys()
    assert schema["properties"]["wait_ms"]["title"] == "Wait Ms"
    assert schema["properties"]["wait_ms"]["description"] == "the wait"
    assert schema["properties"]["turn_deg"]["exclusiveMinimum"] == 0
    assert schema["allOf"] == [
        {"oneOf": [{"required": [key]} for key in ("turn_rad", "turn_deg", "turn")]}
    ]
    assert schema["additionalProperties"] is False


def test_a_fault_has_its_words_and_its_place() -> None:
    error: Any = fault("is {odd}", (2, "to"), of_key=True)
    assert (error.type, error.message()) == ("profile", "is {odd}")
    assert error.context == {"words": "is {odd}", "at": (2, "to"), "of_key": True}
