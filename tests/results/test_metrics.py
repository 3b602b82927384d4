"""The metrics have the promised keys, and values that plain sums give too."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machine import JOINTS
from des_cli.model.machines import DES
from des_cli.model.profile import BodyRates, JointCommands, Profile
from des_cli.pipeline import reduce_profile
from tests.support.sway import WEIGHTS, coriolis_parts, integral, on_sides, reduced_sway, sway

PARTS = ("bb3", "ab3", "cb3", "vector", "seat_x", "seat_y", "seat_z")

# The contract with those who read metrics.json; more keys may stand beside these.
CONTRACT = {
    "profile": {"name", "sha256", "samples", "duration_s"},
    "solver": {
        "method", "algorithm", "control", "axes", "jacobian", "status", "converged",
        "iterations", "cost", "cost_unreduced", "optimality", "message",
    },
    "coriolis": set(PARTS),
    "fidelity": {
        "joint_deviation_relative", "joint_deviation_relative_squared",
        "mean_square_one_minus_p", "joint_rms_rad", "end_error_rad",
        "seat_rate_deviation_relative", "seat_g_deviation_relative", "seat_g_rms_error_g",
        "seat_angular_acceleration_deviation_relative",
        "seat_angular_acceleration_rms_error_rad_s2", "attitude_error_max_deg",
        "tilt_error_max_deg", "tilt_error_rms_deg", "start_error", "end_error_rad_s",
    },
    "felt": {"seat_rate", "seat_angular_acceleration", "seat_g"},
    "executable": {
        "replaced", "breaks_limits", "joint_change_relative", "joint_change_max_rad",
        "seat_rate_deviation_relative", "seat_g_rms_error_g",
        "seat_angular_acceleration_rms_error_rad_s2", "attitude_error_max_deg",
        "coriolis_reduction",
    },
    "changes": {"damping", "machine", "smoothing"},
    "baseline": {"report_sweep", "constant_p"},
    "limits": {"desired", "modified"},
    "singularity": {"min_abs_cos_fork", "damped_samples", "max_residual_rad_s"},
}  # fmt: skip


@pytest.fixture
def run():
    return reduced_sway()


@pytest.fixture(scope="module")
def unreduced():
    """A weight that forbids any change: the factors stay one."""
    profile = sway(60)
    return reduce_profile(
        replace(profile, reduction=replace(profile.reduction, r2=np.full(3, 1e9)))
    )


def test_keys_of_the_contract(run):
    for section, keys in CONTRACT.items():
        assert keys <= set(run.metrics[section]), section
    for part in PARTS:
        assert set(run.metrics["coriolis"][part]) >= {
            "reduction", "rms_before_rad_s2", "rms_after_rad_s2",
            "peak_before_rad_s2", "peak_after_rad_s2",
        }  # fmt: skip
    baseline = run.metrics["baseline"]
    assert set(baseline["report_sweep"]) >= {"reduction", "joint_deviation_relative"}
    assert set(baseline["constant_p"]) >= {"p", "joint_deviation_relative"}
    for which in ("desired", "modified"):
        for joint in JOINTS:
            assert set(run.metrics["limits"][which][joint]) >= {
                "rate_peak_rad_s", "rate_limit_rad_s", "acceleration_peak_rad_s2",
                "acceleration_limit_rad_s2", "jerk_peak_rad_s3", "jerk_limit_rad_s3",
                "acceleration_sign_changes", "ok",
            }  # fmt: skip
    for name in ("joint_rms_rad", "end_error_rad", "end_error_rad_s"):
        assert set(run.metrics["fidelity"][name]) == set(JOINTS)


def test_they_are_plain_numbers_without_clock_or_path(run):
    text = json.dumps(run.metrics, allow_nan=False)
    assert json.loads(text) == run.metrics
    assert "/" not in text.replace("rad/s", "").replace("g/s", "")
    again = json.dumps(reduce_profile(sway()).metrics, allow_nan=False)
    assert again == text


def test_profile_and_solver(run):
    metrics, solution = run.metrics, run.solution
    assert metrics["profile"]["name"] == "sway"
    assert metrics["profile"]["sha256"] == "ab" * 32
    assert metrics["profile"]["samples"] == 301
    assert metrics["profile"]["duration_s"] == pytest.approx(6.0)
    solver = metrics["solver"]
    assert (solver["status"], solver["converged"]) == ("converged", True)
    assert (solver["control"], solver["axes"]) == ("per-joint", "seat")
    assert solver["cost"] == solution.cost < solver["cost_unreduced"]
    assert solver["iterations"] == solution.iterations


def test_joint_fidelity(run):
    wanted, made = run.desired, run.solution.modified
    off = on_sides(made)[0] - on_sides(wanted)[0]
    squares = integral(wanted, off**2)
    size = integral(wanted, on_sides(wanted)[0] ** 2)
    fidelity = run.metrics["fidelity"]
    relative = math.sqrt(squares.sum() / size.sum())
    assert fidelity["joint_deviation_relative"] == pytest.approx(relative, rel=1e-9)
    assert fidelity["joint_deviation_relative_squared"] == pytest.approx(relative**2, rel=1e-9)
    control = run.solution.control
    idle = np.stack([(1.0 - control[:-1]) ** 2, (1.0 - control[1:]) ** 2], axis=1)
    assert fidelity["mean_square_one_minus_p"] == pytest.approx(
        integral(wanted, idle).mean() / 6.0, rel=1e-9
    )
    for j, joint in enumerate(JOINTS):
        assert fidelity["joint_rms_rad"][joint] == pytest.approx(math.sqrt(squares[j] / 6.0))
        gap = made.angle[-1, j] - wanted.angle[-1, j]
        assert fidelity["end_error_rad"][joint] == pytest.approx(gap)
        gap = made.rate_end[-1, j] - wanted.rate_end[-1, j]
        assert fidelity["end_error_rad_s"][joint] == pytest.approx(gap)
        assert fidelity["start_error"][f"{joint}_rad"] == 0.0
        gap = made.rate_start[0, j] - wanted.rate_start[0, j]
        assert (abs(gap) > 1e-4) == (joint != "fork")  # which starts from rest
        assert fidelity["start_error"][f"{joint}_rad_s"] == pytest.approx(gap)


def test_the_constant_factor_has_the_solutions_reduction(run):
    wanted = run.desired
    constant = run.metrics["baseline"]["constant_p"]
    p = constant["p"]
    assert 0.0 < p < 1.0
    # Rates p times the desired ones; angles from the same start, p times as far.
    angle = wanted.angle[0] + p * (wanted.angle - wanted.angle[0])
    slowed = replace(
        wanted, angle=angle, rate_start=p * wanted.rate_start, rate_end=p * wanted.rate_end
    )
    energies = [integral(wanted, coriolis_parts(m)["vector"] ** 2) for m in (wanted, slowed)]
    assert 1.0 - energies[1] / energies[0] == pytest.approx(
        run.metrics["coriolis"]["vector"]["reduction"], rel=1e-6
    )
    off = integral(wanted, (on_sides(slowed)[0] - on_sides(wanted)[0]) ** 2).sum()
    size = integral(wanted, on_sides(wanted)[0] ** 2).sum()
    assert constant["joint_deviation_relative"] == pytest.approx(math.sqrt(off / size), rel=1e-6)


def test_no_change_is_all_zeros(unreduced):
    metrics = unreduced.metrics
    for part in PARTS:
        assert metrics["coriolis"][part]["reduction"] == pytest.approx(0.0, abs=1e-6)
    fidelity = metrics["fidelity"]
    for name in ("joint_deviation_relative", "seat_rate_deviation_relative", "seat_g_rms_error_g"):
        assert fidelity[name] == pytest.approx(0.0, abs=1e-6)
    assert max(fidelity["joint_rms_rad"].values()) < 1e-6
    assert fidelity["attitude_error_max_deg"] < 1e-5
    assert metrics["baseline"]["constant_p"]["p"] == pytest.approx(1.0, abs=1e-6)


def test_nothing_to_reduce_is_no_number():
    t = np.linspace(0.0, 1.0, 21)
    still = np.zeros((20, 2))
    command = JointCommands(np.full(21, 0.5), np.zeros((21, 2)), still, still)
    run = reduce_profile(Profile("spin", t, command, DES, reduction=WEIGHTS))
    assert all(run.metrics["coriolis"][part]["reduction"] is None for part in PARTS)
    assert run.metrics["coriolis"]["vector"]["rms_before_rad_s2"] == 0.0
    json.dumps(run.metrics, allow_nan=False)


def test_singularity_of_body_rates():
    t = np.linspace(0.0, 2.0, 81)
    rates = BodyRates(*[np.tile([0.0, 0.5, 0.1], (80, 1))] * 3)
    start = np.array([0.0, 1.35, 0.0])
    run = reduce_profile(Profile("loop", t, rates, DES, initial_angle=start, reduction=WEIGHTS))
    found = run.metrics["singularity"]
    motion = run.desired
    assert found["min_abs_cos_fork"] == pytest.approx(np.abs(np.cos(motion.angle[:, 1])).min())
    assert found["damped_samples"] == int(run.asked.damped.sum()) > 0
    residual = np.linalg.norm(run.asked.residual, axis=1).max()
    assert found["max_residual_rad_s"] == pytest.approx(residual)
    assert any("damped" in notice.text for notice in run.notices)
