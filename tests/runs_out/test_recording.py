"""A recording, read back by the package of the format; its frames against the machine's chain."""

from __future__ import annotations

import json
from collections import defaultdict
from io import BytesIO
from typing import Any

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.model.machine import Machine, Seat
from des_cli.model.machines import MACHINES
from des_cli.runs_out.recording import ROW, encode_recording
from des_cli.runs_out.row_text import column_values
from tests.support.joint_rows import rows

reading = pytest.importorskip("mcap.reader")

SEAT = Seat(1.2, 0.3)
Messages = dict[str, list[tuple[int, dict[str, Any]]]]


def messages_of(data: bytes) -> tuple[Messages, dict[str, tuple[str, dict[str, Any]]]]:
    found, schemas = defaultdict(list), {}
    for schema, channel, message in reading.make_reader(BytesIO(data)).iter_messages():
        assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
        found[channel.topic].append((message.log_time, json.loads(message.data)))
        schemas[channel.topic] = (schema.name, json.loads(schema.data))
    return dict(found), schemas


def matrix(transform: dict[str, Any]) -> np.ndarray:
    """The 4 x 4 matrix of a FrameTransform."""
    x, y, z, w = (transform["rotation"][axis] for axis in "xyzw")
    assert x * x + y * y + z * z + w * w == pytest.approx(1.0)
    whole = np.eye(4)
    whole[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    whole[:3, 3] = [transform["translation"][axis] for axis in "xyz"]
    return whole


def fits(value: Any, schema: dict[str, Any]) -> bool:
    """Whether a value is of a schema of objects, arrays and plain types."""
    match schema["type"]:
        case "object":
            parts = schema.get("properties", {})
            return (
                isinstance(value, dict)
                and set(schema.get("required", ())) <= set(value)
                and all(fits(value[key], part) for key, part in parts.items())
            )
        case "array":
            return isinstance(value, list) and all(fits(each, schema["items"]) for each in value)
        case "integer":
            least, most = schema.get("minimum", value), schema.get("maximum", value)
            return type(value) is int and least <= value <= most
        case kind:
            return isinstance(value, {"number": float, "string": str, "boolean": bool}[kind])


@pytest.mark.parametrize("machine", MACHINES.values(), ids=lambda machine: machine.name)
def test_frames_lead_from_the_ground_to_the_seat(machine: Machine) -> None:
    given = rows()
    messages, _ = messages_of(encode_recording(given, machine, SEAT))
    chain = chain_of(machine, SEAT)
    for (_, message), angle in zip(messages["/tf"], given.angle, strict=True):
        transforms = message["transforms"]
        links = [(each["parent_frame_id"], each["child_frame_id"]) for each in transforms]
        assert links == [("ground", "arm"), ("arm", "fork"), ("fork", "cab"), ("cab", "seat")]
        whole = np.linalg.multi_dot([matrix(each) for each in transforms])
        np.testing.assert_allclose(whole, chain.transform(angle), atol=1e-12)


def test_joints_turn_about_z_of_their_frames() -> None:
    given = rows()
    messages, _ = messages_of(encode_recording(given, MACHINES["des"], SEAT))
    first, last = (messages["/tf"][row][1]["transforms"] for row in (0, -1))
    for joint in range(3):
        turned = matrix(first[joint])[:3, :3].T @ matrix(last[joint])[:3, :3]
        np.testing.assert_allclose(turned[:, 2], [0.0, 0.0, 1.0], atol=1e-12)
        change = given.angle[-1, joint] - given.angle[0, joint]
        assert abs(np.arctan2(turned[1, 0], turned[0, 0])) == pytest.approx(abs(change))


def test_rows_and_states_are_those_given() -> None:
    given = rows(count=30, hz=130.0)
    messages, schemas = messages_of(encode_recording(given, MACHINES["des"], SEAT))
    assert {topic: name for topic, (name, _) in schemas.items()} == {
        "/tf": "foxglove.FrameTransforms",
        "/scene": "foxglove.SceneUpdate",
        "/joint_states": "foxglove.JointStates",
        "/commands": "des_coriolis.Row",
    }
    times = [time for time, _ in messages["/commands"]]
    np.testing.assert_allclose(times, 1e9 * np.arange(30) / 130.0, atol=1.0)
    for column in ROW:
        found = [message[column.name] for _, message in messages["/commands"]]
        np.testing.assert_array_equal(found, column_values(given, column.name))
    for number, (time, message) in enumerate(messages["/joint_states"]):
        assert message["timestamp"] == {"sec": time // 10**9, "nsec": time % 10**9}
        assert [joint["name"] for joint in message["joints"]] == ["arm", "fork", "cab"]
        assert [joint["position"] for joint in message["joints"]] == given.angle[number].tolist()
        assert [joint["velocity"] for joint in message["joints"]] == given.rate[number].tolist()


def test_every_message_is_of_its_schema() -> None:
    messages, schemas = messages_of(encode_recording(rows(), MACHINES["des"], SEAT))
    for topic, found in messages.items():
        assert all(fits(message, schemas[topic][1]) for _, message in found), topic


def test_bodies_are_fixed_in_the_frames_and_stay() -> None:
    messages, _ = messages_of(encode_recording(rows(), MACHINES["des"], SEAT))
    ((time, scene),) = messages["/scene"]
    assert time == 0
    assert [entity["frame_id"] for entity in scene["entities"]] == ["arm", "fork", "cab", "seat"]
    assert all(entity["frame_locked"] for entity in scene["entities"])
    # The arm's bar reaches from its axle to the fork.
    (bar,) = scene["entities"][0]["cubes"]
    reach = np.linalg.norm(chain_of(MACHINES["des"], SEAT).constants[1][:3, 3])
    assert bar["size"]["x"] == pytest.approx(reach)
    assert 2.0 * bar["pose"]["position"]["x"] == pytest.approx(reach)


def test_the_same_rows_are_the_same_bytes() -> None:
    one, other = (encode_recording(rows(), MACHINES["des"], SEAT) for _ in range(2))
    assert one == other
