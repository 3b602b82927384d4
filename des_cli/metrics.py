"""What a reduction gained and what it cost: the content of ``metrics.json``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from des_cli.kinematics.attitude import geodesic_angle
from des_cli.kinematics.chain import chain_of, seat_rotation
from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, Machine
from des_cli.model.motion import DesiredMotion, Motion, integrate_sides
from des_cli.model.profile import Profile
from des_cli.model.response import Response
from des_cli.model.run import Violation
from des_cli.model.solution import Solution
from des_cli.reduction.baseline import Baselines, joint_deviation
from des_cli.reduction.limits import measure_peaks

AT_LIMIT = 0.99
"""Share of the acceleration limit from which a joint counts as being at it."""

COMPONENTS = ("ab3", "bb3", "cb3", "vector", "seat_x", "seat_y", "seat_z")
"""Names of the measured parts of the Coriolis vector, in the order of the report."""


@dataclass(frozen=True)
class Measured:
    """Everything that the metrics are taken of."""

    profile: Profile
    asked: DesiredMotion
    desired: Motion
    solution: Solution
    before: Response
    after: Response
    violations: tuple[Violation, ...]
    baselines: Baselines


def measure(run: Measured) -> dict[str, Any]:
    """Return the metrics of a run, as they stand in ``metrics.json`` beside the notices."""
    return {
        "profile": _profile(run.profile),
        "solver": _solver(run.profile, run.solution),
        "coriolis": coriolis_metrics(run.desired.step, run.before, run.after)
        | {"objective": {"reduction": run.baselines.reduction}},
        "fidelity": fidelity_metrics(run),
        "executable": _executable(run),
        "baseline": {
            "report_sweep": {
                "reduction": run.baselines.sweep_reduction,
                "joint_deviation_relative": run.baselines.sweep_deviation,
            },
            "constant_p": {
                "p": run.baselines.constant_p,
                "joint_deviation_relative": run.baselines.constant_deviation,
            },
        },
        "limits": {
            which: _limits(run.profile.machine, motion, which, run.violations)
            for which, motion in (
                ("desired", run.asked.motion),
                ("modified", run.solution.modified),
            )
        },
        "singularity": _singularity(run),
        "violations": [str(violation) for violation in run.violations],
    }


def _profile(profile: Profile) -> dict[str, Any]:
    return {
        "name": profile.name,
        "sha256": profile.sha256,
        "samples": len(profile.t),
        "duration_s": float(profile.t[-1] - profile.t[0]),
        "machine": profile.machine.name,
    }


def _solver(profile: Profile, solution: Solution) -> dict[str, Any]:
    reduction = profile.reduction
    return {
        "method": reduction.method,
        "algorithm": reduction.algorithm,
        "control": reduction.control,
        "axes": reduction.axes,
        "jacobian": reduction.jacobian,
        "r1": reduction.r1.tolist(),
        "r2": reduction.r2.tolist(),
        "tracking": reduction.tracking.tolist(),
        "limits": reduction.limits,
        "budget": {b.metric: b.most for b in reduction.budget} or None,
        "status": solution.status,
        "converged": solution.converged,
        "iterations": solution.iterations,
        "cost": solution.cost,
        "cost_unreduced": solution.cost_unreduced,
        "optimality": solution.optimality,
        "message": solution.message,
    }


def coriolis_metrics(step: Floats, before: Response, after: Response) -> dict[str, Any]:
    """Return reduction, RMS and peak of each part of the Coriolis vector.

    Parameters
    ----------
    step : (n - 1,) array
        [s]
    before, after : Response

    Returns
    -------
    dict
        Keys as in ``COMPONENTS``; reduction is 1 - int after^2 / int before^2,
        and None where there was nothing to reduce.
    """
    found = {}
    for name, old, new in zip(COMPONENTS, _parts(before), _parts(after), strict=True):
        energy_old, energy_new = integrate_sides(step, old**2), integrate_sides(step, new**2)
        duration = float(step.sum())
        found[name] = {
            "reduction": relative_reduction(float(energy_old), float(energy_new)),
            "rms_before_rad_s2": float(np.sqrt(energy_old / duration)),
            "rms_after_rad_s2": float(np.sqrt(energy_new / duration)),
            "peak_before_rad_s2": float(np.max(np.abs(old))),
            "peak_after_rad_s2": float(np.max(np.abs(new))),
        }
    return found


def _parts(response: Response) -> tuple[Floats, ...]:
    """Return AB3, BB3, CB3, the vector's magnitude, and seat x, y, z, (n - 1, 2) each."""
    report, seat = response.coriolis_report, response.coriolis_seat
    magnitude = np.linalg.norm(seat, axis=-1)
    return (*np.moveaxis(report, -1, 0), magnitude, *np.moveaxis(seat, -1, 0))


def relative_reduction(before: float, after: float) -> float | None:
    """Return 1 - after / before, None where there was nothing before."""
    return 1.0 - after / before if before > 1e-24 else None


def fidelity_metrics(run: Measured) -> dict[str, Any]:
    """Return what the reduction cost: in the joints, and as the pilot feels it."""
    wanted, made = run.desired, run.solution.modified
    step = wanted.step
    off = made.angle_sides - wanted.angle_sides
    deviation = joint_deviation(wanted, made)
    rms = np.sqrt(integrate_sides(step, off**2) / step.sum())
    felt = run.after.seat_g - run.before.seat_g
    felt_energy = float(integrate_sides(step, np.sum(felt**2, axis=-1)))
    chain = chain_of(run.profile.machine, run.profile.seat)
    turned = geodesic_angle(seat_rotation(chain, wanted.angle), seat_rotation(chain, made.angle))
    idle = (1.0 - np.stack([run.solution.control[:-1], run.solution.control[1:]], axis=1)) ** 2
    return {
        "joint_deviation_relative": deviation,
        "joint_deviation_relative_squared": deviation**2,
        "mean_square_one_minus_p": float(integrate_sides(step, idle.mean(axis=2)) / step.sum()),
        "joint_rms_rad": _by_joint(rms),
        "end_error_rad": _by_joint(made.angle[-1] - wanted.angle[-1]),
        "seat_rate_deviation_relative": _relative_norm(
            step, run.after.seat_rate - run.before.seat_rate, run.before.seat_rate
        ),
        "seat_g_deviation_relative": _relative_norm(step, felt, run.before.seat_g),
        "seat_g_rms_error_g": float(np.sqrt(felt_energy / step.sum())),
        "attitude_error_max_deg": float(np.degrees(np.max(turned))),
        "seat_g": {
            axis: _felt_component(step, run.before.seat_g[..., index], run.after.seat_g[..., index])
            for index, axis in enumerate(("gx", "gy", "gz"))
        },
    }


def _felt_component(step: Floats, before: Floats, after: Floats) -> dict[str, float]:
    """Return peaks, onset rates, jumps and RMS error of one component of the G-vector.

    The onset rate is the largest change from one sample to the next over the time
    between them. It contains the jumps, where the joints' acceleration steps: these
    are what they are on any grid, and the onset rate there grows as the step shrinks.
    """
    return {
        "peak_before_g": float(np.max(np.abs(before))),
        "peak_after_g": float(np.max(np.abs(after))),
        "onset_before_g_s": _onset(step, before),
        "onset_after_g_s": _onset(step, after),
        "jump_before_g": float(np.max(np.abs(before[1:, 0] - before[:-1, 1]), initial=0.0)),
        "jump_after_g": float(np.max(np.abs(after[1:, 0] - after[:-1, 1]), initial=0.0)),
        "rms_error_g": float(np.sqrt(integrate_sides(step, (after - before) ** 2) / step.sum())),
    }


def _onset(step: Floats, values: Floats) -> float:
    """Return the largest change from sample to sample over the time between them [g/s]."""
    at_samples = np.append(values[:, 0], values[-1, 1])
    return float(np.max(np.abs(np.diff(at_samples)) / step))


def _relative_norm(step: Floats, off: Floats, size: Floats) -> float:
    """Return sqrt(int |off|^2 / int |size|^2) of vectors on sides."""
    energy = float(integrate_sides(step, np.sum(size**2, axis=-1)))
    return float(np.sqrt(integrate_sides(step, np.sum(off**2, axis=-1)) / max(energy, 1e-300)))


def _executable(run: Measured) -> dict[str, Any]:
    """Return what keeping the limits changed of the motion that was asked for."""
    asked, desired = run.asked.motion, run.desired
    return {
        "replaced": desired is not asked,
        "joint_change_relative": joint_deviation(asked, desired),
        "joint_change_max_rad": _by_joint(np.max(np.abs(desired.angle - asked.angle), axis=0)),
    }


def _by_joint(values: Floats) -> dict[str, float]:
    return {joint: float(value) for joint, value in zip(JOINTS, values, strict=True)}


def _limits(
    machine: Machine, motion: Motion, which: str, violations: tuple[Violation, ...]
) -> dict[str, Any]:
    peaks = measure_peaks(motion)
    limit = np.array([joint.acceleration for joint in machine.limits])
    full = np.abs(motion.acceleration) >= AT_LIMIT * limit
    share = motion.step @ full / motion.step.sum()
    broken = {(v.joint) for v in violations if v.motion == which}
    return {
        joint: {
            "rate_peak_rad_s": float(peaks.rate[j]),
            "rate_limit_rad_s": machine.limits[j].rate,
            "acceleration_peak_rad_s2": float(peaks.acceleration[j]),
            "acceleration_limit_rad_s2": machine.limits[j].acceleration,
            "rate_step_rad_s": float(peaks.rate_step[j]),
            "at_acceleration_limit": float(share[j]),
            "ok": joint not in broken,
        }
        for j, joint in enumerate(JOINTS)
    }


def _singularity(run: Measured) -> dict[str, Any]:
    desired = run.asked
    found: dict[str, Any] = {
        "min_abs_cos_fork": float(np.min(np.abs(np.cos(desired.motion.angle[:, 1])))),
        "min_singular_value": float(np.min(desired.singular_value)),
        "damped_samples": int(np.sum(desired.damped)),
        "max_residual_rad_s": float(np.max(np.linalg.norm(desired.residual, axis=1))),
        "integration_error_max_deg": float(np.degrees(desired.attitude_error)),
    }
    if desired.recorded_attitude_error is not None:
        found["recorded_attitude_error_max_deg"] = float(
            np.degrees(desired.recorded_attitude_error)
        )
    return found
