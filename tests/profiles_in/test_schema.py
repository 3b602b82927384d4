"""The JSON Schema says what the reader accepts."""

from __future__ import annotations

import json
from typing import Any

from des_cli.profiles_in.machine_schema import JointLimits
from des_cli.profiles_in.schema import Joints, profile_json_schema
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
