"""One builder of runs for the tests of what is made of a run."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, JointLimits, Machine, Seat
from des_cli.model.machines import DES
from des_cli.model.motion import DesiredMotion, Motion
from des_cli.model.profile import Control, JointCommands, Profile, Reduction
from des_cli.model.response import Response
from des_cli.model.run import Run
from des_cli.model.solution import Solution
from des_cli.results.reading import read_metrics

# The joint limits of Table 1 of the study.
LIMITS = (
    JointLimits(math.inf, 5.86, 0.63),
    JointLimits(2 * math.pi, 3.14, 2.5),
    JointLimits(2 * math.pi, 3.14, 5.0),
)


def make_run(
    samples: int = 101, *, name: str = "cobra", control: Control = "scalar", leads: float = 0.0
) -> Run:
    """Return a run of closed forms: it tests what is written and drawn, not how it was solved.

    Parameters
    ----------
    samples : int
        Over 10 s.
    name : str
        The profile's.
    control : {"scalar", "per-joint", "free"}
        A free motion has neither factors nor an adjoint.
    leads : float
        Time [s] for which the command table stands still before and after the maneuver.
    """
    t = np.linspace(0.0, 10.0, samples)
    # Steepest where the fork is fastest; 1 at both ends, as an optimum's is.
    dip = np.sin(math.pi * t / 10) ** 2 * (0.7 + 0.3 * np.cos(2 * math.pi * t / 5))
    factor = 1 - dip[:, None] * np.array([0.4] * 3 if control == "scalar" else [0.28, 0.45, -0.12])
    desired, modified = _motion(t, np.ones((samples, 3))), _motion(t, factor)
    before, after = _response(desired), _response(modified)
    metrics = _metrics(name, control, before, after)
    metrics["limits"] = {"desired": _limits(desired), "modified": _limits(modified)}
    solver = metrics["solver"]
    adjoint = np.stack([0.01 * np.sin(t), (10 - t) * np.sin(t) / 20, 0 * t], axis=1)
    commands = JointCommands(
        arm_rate=desired.rate[:, 0],
        position=desired.angle[:, 1:],
        rate_start=desired.rate_start[:, 1:],
        rate_end=desired.rate_end[:, 1:],
    )
    return Run(
        profile=Profile(
            name=name,
            t=t,
            command=commands,
            machine=Machine("des", DES.rows, LIMITS),
            reduction=Reduction(
                control=control,
                axes="report",
                r1=np.diag([0.0, 2.0, 0.0]),
                limits="warn",
                budget=(),
            ),
            sha256="5c" * 32,
        ),
        asked=DesiredMotion(
            desired, np.ones(samples), np.zeros(samples, dtype=bool), np.zeros((samples, 3))
        ),
        desired=desired,
        seat=Seat(),
        solution=Solution(
            status="converged",
            message=solver["message"],
            control=factor[:, : {"scalar": 1, "per-joint": 3, "free": 0}[control]],
            modified=modified,
            adjoint=adjoint[:, : 0 if control == "free" else 3],
            cost=solver["cost"],
            cost_unreduced=solver["cost_unreduced"],
            optimality=solver["optimality"],
            iterations=solver["iterations"],
        ),
        commands=_with_leads(modified, leads),
        before=before,
        after=after,
        checks=(),
        violations=(),
        results=read_metrics(metrics),
    )


def _with_leads(motion: Motion, duration: float) -> Motion:
    """A motion with a standstill of one interval before it and after it."""
    if not duration:
        return motion
    still = np.zeros((1, 3))
    return Motion(
        t=np.concatenate([motion.t[:1] - duration, motion.t, motion.t[-1:] + duration]),
        angle=np.concatenate([motion.angle[:1], motion.angle, motion.angle[-1:]]),
        rate_start=np.concatenate([still, motion.rate_start, still]),
        rate_end=np.concatenate([still, motion.rate_end, still]),
    )


def _motion(t: Floats, factor: Floats) -> Motion:
    """A Cobra-like motion whose rates are slowed by a factor per sample and joint."""
    rpm = 2 * math.pi / 60
    arm = np.where(t < 5, 8.8 - 0.66 * t, 5.5 + 0.66 * (t - 5)) * rpm
    fork = np.radians(-60) * math.pi / 5 * np.sin(math.pi * t / 5)
    cab = np.where(0.5 * (t[:-1] + t[1:]) < 5, -1.0, 1.0) * math.radians(2.5)
    start = np.stack([arm[:-1], fork[:-1], cab], axis=1) * factor[:-1]
    end = np.stack([arm[1:], fork[1:], cab], axis=1) * factor[1:]
    steps = 0.5 * np.diff(t)[:, None] * (start + end)
    angle = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    return Motion(t, angle + np.radians([0, 0, 30]), start, end)


def _response(motion: Motion) -> Response:
    """The Coriolis vector by (22)-(24); at the seat something of the right size."""
    sin, cos = np.sin(motion.angle_sides), np.cos(motion.angle_sides)
    s1, s2, c1, c2 = sin[..., 0], sin[..., 1], cos[..., 0], cos[..., 1]
    r1, r2, r3 = np.moveaxis(motion.rate_sides, -1, 0)
    ab3 = -s1 * r1 * r2 + (-c1 * c2 * r1 + s1 * s2 * r2) * r3
    bb3 = -c1 * r1 * r2 + (s1 * c2 * r1 + c1 * s2 * r2) * r3
    cb3 = -c2 * r2 * r3
    seat = np.stack([c1 * ab3 - s1 * bb3, s1 * ab3 + c1 * bb3, cb3], axis=-1)
    rate = motion.rate_sides
    gravity = np.stack([s2, np.zeros_like(s2), -c2], axis=-1)
    report = np.stack([ab3, bb3, cb3], axis=-1)
    total = 0.3 * motion.acceleration[:, None, :] + seat
    g = 0.1 * rate + 0.6 * rate**2 + 0.05 * seat + gravity
    return Response(seat, rate, total, g, report)


def _component(before: Floats, after: Floats) -> dict[str, float]:
    rms_before, rms_after = (math.sqrt(np.mean(np.square(side))) for side in (before, after))
    return {
        "reduction": 1 - (rms_after / rms_before) ** 2,
        "rms_before_rad_s2": rms_before,
        "rms_after_rad_s2": rms_after,
        "peak_before_rad_s2": float(np.abs(before).max()),
        "peak_after_rad_s2": float(np.abs(after).max()),
    }


def _sizes(names: str, before: Floats, after: Floats, unit: str) -> dict[str, dict[str, float]]:
    found = {}
    for index, name in enumerate((*names, "magnitude")):
        part = {}
        for when, vectors in (("before", before), ("after", after)):
            length = np.linalg.norm(vectors, axis=-1)
            sides = length if name == "magnitude" else vectors[..., index]
            part[f"rms_{when}_{unit}"] = math.sqrt(np.mean(np.square(sides)))
            part[f"peak_{when}_{unit}"] = float(np.abs(sides).max())
        found[name] = part
    return found


def _limits(motion: Motion) -> dict[str, dict[str, Any]]:
    rate = np.abs(motion.rate_sides).max(axis=(0, 1)).tolist()
    acceleration = np.abs(motion.acceleration).max(axis=0).tolist()
    return {
        joint: {
            "rate_peak_rad_s": rate[i],
            "rate_limit_rad_s": LIMITS[i].rate,
            "acceleration_peak_rad_s2": acceleration[i],
            "acceleration_limit_rad_s2": LIMITS[i].acceleration,
            "jerk_peak_rad_s3": 1.1,
            "jerk_limit_rad_s3": None,
            "rate_step_rad_s": 0.0,
            "at_acceleration_limit": 0.0,
            "acceleration_sign_changes": 3,
            "ok": rate[i] <= LIMITS[i].rate and acceleration[i] <= LIMITS[i].acceleration,
        }
        for i, joint in enumerate(JOINTS)
    }


def _metrics(name: str, control: str, before: Response, after: Response) -> dict[str, Any]:
    """The content of ``metrics.json``; what is not computed here is the right size."""
    coriolis = {
        key: _component(before.coriolis_report[..., i], after.coriolis_report[..., i])
        for key, i in (("bb3", 1), ("ab3", 0), ("cb3", 2))
    }
    norms = [np.linalg.norm(each.coriolis_report, axis=-1) for each in (before, after)]
    coriolis["vector"] = _component(*norms)
    for i, axis in enumerate("xyz"):
        seat = (before.coriolis_seat[..., i], after.coriolis_seat[..., i])
        coriolis[f"seat_{axis}"] = _component(*seat)
    coriolis["objective"] = {"reduction": coriolis["bb3"]["reduction"]}
    return {
        "profile": {"name": name, "sha256": "5c" * 32, "samples": 1001, "duration_s": 10.0},
        "solver": {
            "method": "minimum",
            "algorithm": "optimum",
            "control": control,
            "axes": "report",
            "jacobian": "desired",
            "r1": [[0.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.0]],
            "r2": [1.0, 1.0, 1.0],
            "tracking": [0.0, 0.0, 0.0],
            "limits": "warn",
            "budget": None,
            "status": "converged",
            "converged": True,
            "iterations": 6,
            "cost": 0.2590558,
            "cost_unreduced": 0.538436,
            "optimality": 3.1e-12,
            "message": "The first-order conditions hold to rounding.",
        },
        "parameters": None,
        "asked_g": None,
        "coriolis": coriolis,
        "fidelity": {
            "joint_deviation_relative": 0.128,
            "joint_deviation_relative_squared": 0.0163,
            "mean_square_one_minus_p": 0.0512,
            "joint_rms_rad": {"arm": 0.47, "fork": 0.11, "cab": 0.02},
            "end_error_rad": {"arm": -1.2, "fork": -0.01, "cab": 0.03},
            "seat_rate_deviation_relative": 0.214,
            "seat_g_deviation_relative": 0.0871,
            "seat_g_rms_error_g": 0.131,
            "attitude_error_max_deg": 31.2,
            "seat_angular_acceleration_deviation_relative": 0.31,
            "seat_angular_acceleration_rms_error_rad_s2": 0.143,
            "seat_angular_acceleration_rms_ratio": 0.968,
            "seat_angular_acceleration_peak_ratio": 1.041,
            "tilt_error_max_deg": 6.4,
            "tilt_error_rms_deg": 2.7,
            "start_error": {
                **{f"{joint}_rad": 0.0 for joint in JOINTS},
                **{f"{joint}_rad_s": 0.0 for joint in JOINTS},
            },
            "end_error_rad_s": {"arm": 0.02, "fork": 0.0, "cab": 0.0},
        },
        "felt": {
            "seat_rate": _sizes("pqr", before.seat_rate, after.seat_rate, "rad_s"),
            "seat_angular_acceleration": _sizes(
                "xyz",
                before.seat_angular_acceleration,
                after.seat_angular_acceleration,
                "rad_s2",
            ),
            "seat_g": {
                axis: {
                    "peak_before_g": 1.4,
                    "peak_after_g": 1.2,
                    "min_before_g": -1.4,
                    "min_after_g": -1.2,
                    "max_before_g": 0.9,
                    "max_after_g": 0.8,
                    "onset_before_g_s": 0.8,
                    "onset_after_g_s": 0.7,
                    "jump_before_g": 0.0,
                    "jump_after_g": 0.01,
                    "rms_error_g": 0.08,
                }
                for axis in ("gx", "gy", "gz")
            },
        },
        "executable": {
            "replaced": False,
            "joint_change_relative": 0.0,
            "joint_change_max_rad": {"arm": 0.0, "fork": 0.0, "cab": 0.0},
        },
        "baseline": {
            "report_sweep": {"reduction": 0.639, "joint_deviation_relative": 0.24},
            "constant_p": {"p": 0.747, "joint_deviation_relative": 0.253},
        },
        "singularity": {
            "min_abs_cos_fork": 0.0021,
            "min_singular_value": 0.0015,
            "damped_samples": 0,
            "max_residual_rad_s": 0.0,
            "integration_error_max_deg": 0.0,
        },
        "violations": [],
        "notices": [],
    }
