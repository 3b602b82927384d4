"""The JSON Schema says what the reader accepts."""

from __future__ import annotations

import json
from typing import Any

import pytest
from pydantic import ValidationError

from des_cli.profiles_in.command_schema import Segment
from des_cli.profiles_in.machine_schema import JointLimits
from des_cli.profiles_in.schema import Joints, Seat, profile_json_schema
from des_cli.units import suffixes


def test_every_key_of_the_contract_is_in_the_schema() -> None:
    schema = profile_json_schema()
    assert set(schema["properties"]) == {
        "format", "name", "machine", "seat", "initial", "time", "joints", "body_rates", "g",
        "samples", "gap", "trim", "axes", "resample", "smooth", "reduction",
    }  # fmt: skip
    assert schema["required"] == ["format"]
    assert schema["additionalProperties"] is False
    reduction = schema["$defs"]["ReductionSection"]["properties"]
    assert {"method", "algorithm", "control", "axes", "jacobian", "r1", "r2", "tracking", "limits",
            "budget"} <= set(reduction)  # fmt: skip


def test_every_unit_of_a_quantity_is_a_key() -> None:
    assert {f"arm_{suffix}" for suffix in suffixes("rate")} <= set(Joints.known_keys())
    assert {f"rate_{suffix}" for suffix in suffixes("rate")} <= set(JointLimits.known_keys())
    properties = profile_json_schema()["$defs"]["Joints"]["properties"]
    assert set(properties) == set(Joints.known_keys())


def test_exactly_one_unit_is_asked_for() -> None:
    rules = profile_json_schema()["$defs"]["Joints"]["allOf"]
    keys = [[rule["required"][0] for rule in one["oneOf"]] for one in rules]
    assert keys == [["arm_rad_s", "arm_deg_s", "arm_rpm", "arm_rad", "arm_deg"],
                    ["fork_rad", "fork_deg"], ["cab_rad", "cab_deg"]]  # fmt: skip


def test_the_schema_is_json_without_nulls_as_defaults() -> None:
    def walk(node: Any) -> None:
        if isinstance(node, dict):
            assert node.get("default", 0) is not None
            for child in node.values():
                walk(child)
        elif isinstance(node, list):
            for child in node:
                walk(child)

    schema = profile_json_schema()
    assert json.loads(json.dumps(schema)) == schema
    walk(schema)


def test_a_quantity_given_twice_is_named_with_what_is_wrong_in_each() -> None:
    with pytest.raises(ValidationError) as caught:
        Seat.model_validate({"yaw_deg": "north", "yaw_rad": "south", "pitch_deg": 1})
    found = [(error["loc"], error["type"]) for error in caught.value.errors()]
    assert found == [
        ((), "profile"),
        (("yaw_rad",), "float_type"),
        (("yaw_deg",), "float_type"),
    ]


def test_a_field_is_no_key_and_a_value_stays_in_the_unit_of_its_key() -> None:
    segment = Segment.model_validate({"from_ms": 500, "to_s": 2, "value": "t"})
    assert (segment.given_key("from"), segment.from_, segment.si("from")) == ("from_ms", 500.0, 0.5)
    assert segment.written("from") == "from_ms (500)"
    with pytest.raises(ValidationError, match="the start of a segment needs its unit in the key"):
        Segment.model_validate({"from": 0, "to_s": 2, "value": 1})
