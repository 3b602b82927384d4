"""Rows as a ROS 2 message ``trajectory_msgs/msg/JointTrajectory``, in YAML.

A point is a line in the flow style that YAML shares with JSON: any reader of YAML reads it, and a
long one is not slow.
"""

from __future__ import annotations

import json

import numpy as np

from des_cli.model.joint_rows import JointRows
from des_cli.model.machine import JOINTS

HEAD = (
    "header:\n  stamp: {sec: 0, nanosec: 0}\n  frame_id: ''\n"
    f"joint_names: [{', '.join(JOINTS)}]\npoints:\n"
)
"""Above the points; a stamp of 0 is to be started at once."""

POINT = "- "
"""Before each."""

NANO = 1_000_000_000
"""Nanoseconds in a second."""


def encode_trajectory(rows: JointRows) -> bytes:
    """Return the message: positions [rad], velocities [rad/s] and accelerations [rad/s^2].

    Parameters
    ----------
    rows : JointRows
        The time of a point counts from the first row.
    """
    elapsed = np.rint((rows.t - rows.t[0]) * NANO).astype(np.int64).tolist()
    columns = (rows.angle.tolist(), rows.rate.tolist(), rows.acceleration.tolist())
    lines = [HEAD]
    for time, angle, rate, acceleration in zip(elapsed, *columns, strict=True):
        point = {
            "positions": angle,
            "velocities": rate,
            "accelerations": acceleration,
            "time_from_start": {"sec": time // NANO, "nanosec": time % NANO},
        }
        lines.append(f"{POINT}{json.dumps(point)}\n")
    return "".join(lines).encode()
