"""Rows as a recording (MCAP) that Foxglove shows: frames, bodies, joints and commands.

Messages are JSON. Their times count from the first row, as nothing is said of the day of a flight.
"""

from __future__ import annotations

import json
from io import BytesIO

import numpy as np

from des_cli.kinematics.chain import chain_of
from des_cli.model.joint_rows import JointRows
from des_cli.model.machine import JOINTS, Machine, Seat
from des_cli.runs_out.forms import COMMANDS, Column
from des_cli.runs_out.row_text import column_values
from des_cli.runs_out.scene import Json, frame_rotations, frame_transforms, scene_update
from des_cli.runs_out.scene_schemas import (
    FRAME_TRANSFORMS,
    JOINT_STATES,
    NUMBER,
    SCENE_UPDATE,
    record,
)

TRANSFORMS, SCENE, STATES, ROWS = "/tf", "/scene", "/joint_states", "/commands"
"""Topics."""

ROW = (
    *COMMANDS,
    *(
        Column(f"{joint}_{unit}", f"{joint}_{unit}")
        for joint in JOINTS
        for unit in ("rad", "rad_s", "rad_s2")
    ),
)
"""Columns of a message of `ROWS`."""

LIBRARY = "des-coriolis"

NANO = 1_000_000_000
"""Nanoseconds in a second."""


def encode_recording(rows: JointRows, machine: Machine, seat: Seat) -> bytes:
    """Return the bytes of a recording.

    Parameters
    ----------
    rows : JointRows
    machine, seat : Machine, Seat
        Whose frames are recorded.
    """
    from mcap.writer import Writer

    sink = BytesIO()
    writer = Writer(sink)
    writer.start(profile="", library=LIBRARY)
    channels = {}
    for topic, name, schema in (
        (TRANSFORMS, "foxglove.FrameTransforms", FRAME_TRANSFORMS),
        (SCENE, "foxglove.SceneUpdate", SCENE_UPDATE),
        (STATES, "foxglove.JointStates", JOINT_STATES),
        (ROWS, "des_coriolis.Row", record(**{column.name: NUMBER for column in ROW})),
    ):
        number = writer.register_schema(name, "jsonschema", json.dumps(schema).encode())
        channels[topic] = writer.register_channel(topic, "json", number)

    def add(topic: str, time: int, message: Json) -> None:
        data = json.dumps(message, separators=(",", ":")).encode()
        writer.add_message(channels[topic], time, data, time)

    chain = chain_of(machine, seat)
    times = np.rint((rows.t - rows.t[0]) * NANO).astype(np.int64).tolist()
    turned = frame_rotations(chain, rows.angle).tolist()
    joints = np.stack([rows.angle, rows.rate, rows.acceleration], axis=2).tolist()
    names = [column.name for column in ROW]
    table = np.column_stack([column_values(rows, name) for name in names]).tolist()
    add(SCENE, 0, scene_update(chain, _stamp(0)))
    for time, rotations, states, values in zip(times, turned, joints, table, strict=True):
        add(TRANSFORMS, time, frame_transforms(chain, rotations, _stamp(time)))
        add(STATES, time, {"timestamp": _stamp(time), "joints": [*map(_state, JOINTS, states)]})
        add(ROWS, time, dict(zip(names, values, strict=True)))
    writer.finish()
    return sink.getvalue()


def _stamp(time: int) -> dict[str, int]:
    return {"sec": time // NANO, "nsec": time % NANO}


def _state(joint: str, values: list[float]) -> Json:
    return {
        "name": joint,
        **dict(zip(("position", "velocity", "acceleration"), values, strict=True)),
    }
