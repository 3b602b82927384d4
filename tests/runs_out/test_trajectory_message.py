"""A JointTrajectory, read by a reader of YAML that knows nothing of it, against its definition.

https://docs.ros.org/en/jazzy/p/trajectory_msgs/msg/JointTrajectoryPoint.html: float64[] positions,
velocities, accelerations [rad, rad/s, rad/s^2] in the order of joint_names, and
builtin_interfaces/Duration time_from_start: int32 sec, uint32 nanosec.
"""

from __future__ import annotations

import numpy as np
from ruamel.yaml import YAML

from des_cli.runs_out.trajectory_message import encode_trajectory
from tests.support.joint_rows import rows


def test_it_is_a_joint_trajectory() -> None:
    given = rows(count=40, hz=30.0)
    message = YAML(typ="safe").load(encode_trajectory(given))
    assert set(message) == {"header", "joint_names", "points"}
    assert message["header"] == {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    assert message["joint_names"] == ["arm", "fork", "cab"]
    fields = {"positions", "velocities", "accelerations", "time_from_start"}
    assert all(set(point) == fields for point in message["points"])
    for name, values in (
        ("positions", given.angle),
        ("velocities", given.rate),
        ("accelerations", given.acceleration),
    ):
        found = [point[name] for point in message["points"]]
        assert all(type(value) is float for row in found for value in row)
        np.testing.assert_array_equal(found, values)


def test_its_times_are_whole_nanoseconds_that_rise_from_zero() -> None:
    given = rows(count=400, hz=130.0)
    message = YAML(typ="safe").load(encode_trajectory(given))
    times = [point["time_from_start"] for point in message["points"]]
    assert all(type(time["sec"]) is type(time["nanosec"]) is int for time in times)
    assert all(0 <= time["nanosec"] < 10**9 for time in times)
    seconds = np.array([time["sec"] + 1e-9 * time["nanosec"] for time in times])
    np.testing.assert_allclose(seconds, np.arange(400) / 130.0, atol=1e-9)
    assert np.all(np.diff(seconds) > 0.0)
