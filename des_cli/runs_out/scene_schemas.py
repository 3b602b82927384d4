"""JSON Schemas of the messages in a recording: Foxglove's by their names, and the rows' own.

Foxglove knows a message by the name of its schema. These say as much of each as the recording
holds, after https://github.com/foxglove/foxglove-sdk/tree/main/schemas/jsonschema.
"""

from __future__ import annotations

from typing import Any, TypeAlias

Json: TypeAlias = dict[str, Any]

NUMBER: Json = {"type": "number"}
TEXT: Json = {"type": "string"}


def record(**properties: Json) -> Json:
    """Return the schema of an object that has all of these."""
    return {"type": "object", "properties": properties, "required": list(properties)}


def many(items: Json) -> Json:
    """Return the schema of an array."""
    return {"type": "array", "items": items}


def numbers(names: str) -> Json:
    """Return the schema of an object of numbers with one letter each."""
    return record(**dict.fromkeys(names, NUMBER))


def _time(title: str) -> Json:
    nsec = {"type": "integer", "minimum": 0, "maximum": 999_999_999}
    return record(sec={"type": "integer"}, nsec=nsec) | {"title": title}


TIME = _time("time")
POSE = record(position=numbers("xyz"), orientation=numbers("xyzw"))
BODY = record(pose=POSE, size=numbers("xyz"), color=numbers("rgba"))
ANYTHING = many({"type": "object"})

FRAME_TRANSFORMS = record(
    transforms=many(
        record(
            timestamp=TIME,
            parent_frame_id=TEXT,
            child_frame_id=TEXT,
            translation=numbers("xyz"),
            rotation=numbers("xyzw"),
        )
    )
)

ARROW = record(
    pose=POSE,
    shaft_length=NUMBER,
    shaft_diameter=NUMBER,
    head_length=NUMBER,
    head_diameter=NUMBER,
    color=numbers("rgba"),
)
CYLINDER = record(
    pose=POSE, size=numbers("xyz"), bottom_scale=NUMBER, top_scale=NUMBER, color=numbers("rgba")
)

SCENE_UPDATE = record(
    deletions=ANYTHING,
    entities=many(
        record(
            timestamp=TIME,
            frame_id=TEXT,
            id=TEXT,
            lifetime=_time("duration"),
            frame_locked={"type": "boolean"},
            metadata=ANYTHING,
            arrows=many(ARROW),
            cubes=many(BODY),
            spheres=many(BODY),
            cylinders=many(CYLINDER),
            lines=ANYTHING,
            triangles=ANYTHING,
            texts=ANYTHING,
            models=ANYTHING,
        )
    ),
)

JOINT_STATES = record(
    timestamp=TIME,
    joints=many(record(name=TEXT, position=NUMBER, velocity=NUMBER, acceleration=NUMBER)),
)
