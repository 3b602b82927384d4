"""A result with metrics of round numbers, and one of them changed."""

from __future__ import annotations

import copy
from typing import Any

from des_cli.batch.job import JobResult

METRICS = {
    "solver": {
        "method": "minimum",
        "algorithm": "optimum",
        "control": "scalar",
        "axes": "report",
        "status": "converged",
        "iterations": 6,
    },
    "coriolis": {
        key: {"reduction": value}
        for key, value in {
            "ab3": 0.3,
            "bb3": 0.689,
            "cb3": 0.1,
            "vector": 0.458,
            "seat_x": 0.401,
            "seat_y": 0.34,
            "seat_z": -0.031,
        }.items()
    },
    "fidelity": {
        "joint_deviation_relative": 0.1277,
        "joint_deviation_relative_squared": 0.0163,
        "seat_rate_deviation_relative": 0.0911,
        "seat_g_deviation_relative": 0.042,
        "seat_g_rms_error_g": 0.0834,
        "tilt_error_max_deg": 4.5,
        "start_error": {
            **{f"{joint}_rad": 0.0 for joint in ("arm", "fork", "cab")},
            **{"arm_rad_s": 0.001, "fork_rad_s": 0.0, "cab_rad_s": -0.01},
        },
        "end_error_rad": {"arm": -0.5, "fork": 0.1, "cab": 0.0},
        "end_error_rad_s": {"arm": 0.0, "fork": 0.0, "cab": 0.0},
    },
    "felt": {
        "seat_angular_acceleration": {
            "magnitude": {
                "rms_before_rad_s2": 0.462,
                "rms_after_rad_s2": 0.447,
                "peak_before_rad_s2": 0.539,
                "peak_after_rad_s2": 0.561,
            }
        },
        "seat_g": {
            axis: {
                "peak_before_g": 0.37,
                "peak_after_g": 0.45,
                "onset_before_g_s": before,
                "onset_after_g_s": before + 0.09,
            }
            for axis, before in (("gx", 0.5), ("gy", 0.6), ("gz", 0.7))
        },
    },
    "limits": {
        "modified": {
            joint: {
                "rate_peak_rad_s": 0.5,
                "rate_limit_rad_s": limit,
                "acceleration_peak_rad_s2": 0.5,
                "acceleration_limit_rad_s2": limit,
                "jerk_peak_rad_s3": 0.5,
                "jerk_limit_rad_s3": None,
            }
            for joint, limit in (("arm", 1.0), ("fork", 2.0), ("cab", 5.0))
        }
    },
    "baseline": {
        "report_sweep": {"reduction": 0.639, "joint_deviation_relative": 0.24},
        "constant_p": {"p": 0.767, "joint_deviation_relative": 0.233},
    },
}


def result(**changes: object) -> JobResult:
    values = {"source": "c.yaml", "name": "c", "metrics": METRICS, "objective": ("bb3",)}
    return JobResult(**values | {"written": "runs/c"} | changes)  # type: ignore[arg-type]


def with_change(path: str, value: object) -> JobResult:
    metrics = copy.deepcopy(METRICS)
    *parents, last = path.split(".")
    place: Any = metrics
    for key in parents:
        place = place[key]
    place[last] = value
    return result(metrics=metrics)
