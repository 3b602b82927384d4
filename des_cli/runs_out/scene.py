"""The machine as frames and simple bodies, in the JSON of Foxglove's schemas.

Frames follow one another from ``ground`` to ``arm``, ``fork``, ``cab`` and ``seat``: each turns
about its own z with its joint, and the seat is fixed in the cab (x forward, y right, z down).
Bodies are fixed in a frame; they show where the machine is, and not what it looks like.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np

from des_cli.kinematics.chain import Chain
from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS

Json: TypeAlias = dict[str, Any]

FRAMES = ("ground", *JOINTS, "seat")
"""From the ground outward."""

BEAM, CAB, ARROW = 0.4, 1.5, 1.0
"""Width of the arm and of the fork, diameter of the cab, length of the seat's arrows [m]."""

COLORS: dict[str, tuple[float, float, float, float]] = {
    "arm": (0.35, 0.4, 0.5, 1.0),
    "fork": (0.85, 0.55, 0.2, 1.0),
    "cab": (0.3, 0.6, 0.85, 0.4),
    "forward": (0.9, 0.2, 0.2, 1.0),
    "up": (0.2, 0.4, 0.9, 1.0),
}

_PRIMITIVES = (
    "arrows",
    "cubes",
    "spheres",
    "cylinders",
    "lines",
    "triangles",
    "texts",
    "models",
)


def frame_rotations(chain: Chain, angle: Floats) -> Floats:
    """Return how each frame is turned in the one before it, as quaternions x, y, z, w.

    Parameters
    ----------
    chain : Chain
    angle : (n, 3) array
        Of arm, fork and cab [rad].

    Returns
    -------
    (n, 4, 4) array
        For each row, of arm, fork, cab and seat.
    """
    turned = np.zeros((len(angle), len(FRAMES) - 1, 4))
    for joint, (constant, sign) in enumerate(zip(chain.constants, (*chain.signs, 0), strict=True)):
        x, y, z, w = quaternion(constant[:3, :3])
        half = 0.5 * sign * angle[:, joint] if sign else np.zeros(len(angle))
        sin, cos = np.sin(half), np.cos(half)
        # The constant one, then the turn about the new z.
        turned[:, joint] = np.column_stack(
            [x * cos + y * sin, y * cos - x * sin, z * cos + w * sin, w * cos - z * sin]
        )
    return turned


def frame_transforms(chain: Chain, rotations: Sequence[Sequence[float]], stamp: Json) -> Json:
    """Return a ``foxglove.FrameTransforms`` of one row of `frame_rotations`."""
    return {
        "transforms": [
            {
                "timestamp": stamp,
                "parent_frame_id": parent,
                "child_frame_id": child,
                "translation": _vector(constant[:3, 3].tolist()),
                "rotation": dict(zip("xyzw", rotation, strict=True)),
            }
            for parent, child, constant, rotation in zip(
                FRAMES[:-1], FRAMES[1:], chain.constants, rotations, strict=True
            )
        ]
    }


def scene_update(chain: Chain, stamp: Json) -> Json:
    """Return a ``foxglove.SceneUpdate`` with a body in each frame."""
    to_fork, to_cab = (chain.constants[k][:3, 3] for k in (1, 2))
    bodies: list[Json] = [
        {"cubes": [_beam(to_fork, COLORS["arm"])], "cylinders": [_axle(COLORS["arm"])]},
        {"cubes": [_beam(to_cab, COLORS["fork"])], "cylinders": [_axle(COLORS["fork"])]},
        {"spheres": [_ball(COLORS["cab"])]},
        {
            "arrows": [
                _arrow((0.0, 0.0, 0.0, 1.0), COLORS["forward"]),
                # Turned about y, so that it points to -z, which is up for the pilot.
                _arrow((0.0, math.sqrt(0.5), 0.0, math.sqrt(0.5)), COLORS["up"]),
            ]
        },
    ]
    entities = [
        {
            "timestamp": stamp,
            "frame_id": frame,
            "id": frame,
            "lifetime": {"sec": 0, "nsec": 0},
            "frame_locked": True,
            "metadata": [],
            **{name: [] for name in _PRIMITIVES},
            **body,
        }
        for frame, body in zip(FRAMES[1:], bodies, strict=True)
    ]
    return {"deletions": [], "entities": entities}


def quaternion(rotation: Floats) -> tuple[float, float, float, float]:
    """Return a rotation matrix as a unit quaternion x, y, z, w."""
    # The largest of its four squares first: no division by what may be nothing.
    trace = float(np.trace(rotation))
    squares = [*(1.0 + 2.0 * float(rotation[i, i]) - trace for i in range(3)), 1.0 + trace]
    largest = int(np.argmax(squares))
    found = [0.0] * 4
    found[largest] = size = 0.5 * math.sqrt(squares[largest])
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        if largest == 3:
            found[i] = float(rotation[k, j] - rotation[j, k]) / (4.0 * size)
        elif largest == i:
            found[3] = float(rotation[k, j] - rotation[j, k]) / (4.0 * size)
            found[j] = float(rotation[j, i] + rotation[i, j]) / (4.0 * size)
            found[k] = float(rotation[k, i] + rotation[i, k]) / (4.0 * size)
    return found[0], found[1], found[2], found[3]


def _vector(values: Sequence[float]) -> dict[str, float]:
    return dict(zip("xyz", values, strict=True))


def _pose(position: Sequence[float], orientation: Sequence[float]) -> Json:
    return {
        "position": _vector(position),
        "orientation": dict(zip("xyzw", orientation, strict=True)),
    }


def _color(color: Sequence[float]) -> dict[str, float]:
    return dict(zip("rgba", color, strict=True))


def _beam(end: Floats, color: Sequence[float]) -> Json:
    """Return a bar from a frame's origin to a point in it."""
    length = float(np.linalg.norm(end))
    turn = (0.0, 0.0, 0.0, 1.0)
    if length:
        # The shortest turn from x to the end.
        x, y, z = (end / length).tolist()
        turn = (0.0, -z, y, 1.0 + x) if x > -1.0 + 1e-9 else (0.0, 0.0, 1.0, 0.0)
        size = math.sqrt(sum(each * each for each in turn))
        turn = (turn[0] / size, turn[1] / size, turn[2] / size, turn[3] / size)
    return {
        "pose": _pose((0.5 * end).tolist(), turn),
        "size": _vector([max(length, BEAM), BEAM, BEAM]),
        "color": _color(color),
    }


def _axle(color: Sequence[float]) -> Json:
    return {
        "pose": _pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)),
        "size": _vector([BEAM, BEAM, 2.0 * CAB]),
        "bottom_scale": 1.0,
        "top_scale": 1.0,
        "color": _color(color),
    }


def _ball(color: Sequence[float]) -> Json:
    return {
        "pose": _pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)),
        "size": _vector([CAB, CAB, CAB]),
        "color": _color(color),
    }


def _arrow(turn: Sequence[float], color: Sequence[float]) -> Json:
    return {
        "pose": _pose((0.0, 0.0, 0.0), turn),
        "shaft_length": 0.75 * ARROW,
        "shaft_diameter": 0.08 * ARROW,
        "head_length": 0.25 * ARROW,
        "head_diameter": 0.16 * ARROW,
        "color": _color(color),
    }
