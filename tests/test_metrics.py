"""The metrics have the promised keys, and values that plain sums give too."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.profile import BodyRates, JointCommands, Profile, Reduction
from des_cli.pipeline import reduce_profile
from des_cli.results.felt import tilt_error
from des_cli.study.closed_forms import closed_form_coriolis, closed_form_transform

JOINTS = ("arm", "fork", "cab")
WEIGHTS = Reduction(control="scalar", axes="seat", limits="warn", ends="free", budget=())
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
    },
    "changes": {"damping", "smoothing"},
    "baseline": {"report_sweep", "constant_p"},
    "limits": {"desired", "modified"},
    "singularity": {"min_abs_cos_fork", "damped_samples", "max_residual_rad_s"},
}  # fmt: skip


def sway(intervals=300):
    """A maneuver of all joints, whose cab turns back at once half-way: its rate steps."""
    t = np.linspace(0.0, 6.0, intervals + 1)
    first = t < 3.0 - 1e-9
    cab_rate = np.where(first, -0.06, 0.05)[:-1]
    fork_rate = -0.5 * np.sin(0.9 * t)
    position = np.stack(
        [0.5 / 0.9 * (np.cos(0.9 * t) - 1.0), 0.3 + np.where(first, -0.06 * t, 0.05 * t - 0.33)],
        axis=1,
    )
    command = JointCommands(
        arm_rate=0.8 - 0.1 * np.cos(t),
        position=position,
        rate_start=np.stack([fork_rate[:-1], cab_rate], axis=1),
        rate_end=np.stack([fork_rate[1:], cab_rate], axis=1),
    )
    reduction = replace(WEIGHTS, control="per-joint", r2=np.full(3, 0.2))
    return Profile("sway", t, command, DES, reduction=reduction, sha256="ab" * 32)


@pytest.fixture(scope="module")
def run():
    return reduce_profile(sway())


@pytest.fixture(scope="module")
def unreduced():
    """A weight that forbids any change: the factors stay one."""
    profile = sway(60)
    return reduce_profile(
        replace(profile, reduction=replace(profile.reduction, r2=np.full(3, 1e9)))
    )


def integral(motion, sides):
    """Trapezoids of values at both ends of every interval."""
    total = 0.0
    for k, h in enumerate(np.diff(motion.t)):
        total = total + 0.5 * h * (sides[k, 0] + sides[k, 1])
    return total


def on_sides(motion):
    """Angles and rates at both ends of every interval, (n - 1, 2, 3) each."""
    angle = np.stack([motion.angle[:-1], motion.angle[1:]], axis=1)
    return angle, np.stack([motion.rate_start, motion.rate_end], axis=1)


def frames(motion):
    """R_0^17 by the closed forms of (10)."""
    angle = on_sides(motion)[0]
    return closed_form_transform(DES.lengths, Seat(), angle)[..., :3, :3]


def coriolis_parts(motion):
    """Each part of the Coriolis vector by (22)-(24), on sides."""
    report = closed_form_coriolis(*on_sides(motion))
    seat = np.einsum("ksij,ksi->ksj", frames(motion), report)
    parts = dict(zip(("ab3", "bb3", "cb3"), np.moveaxis(report, -1, 0), strict=True))
    parts |= dict(zip(("seat_x", "seat_y", "seat_z"), np.moveaxis(seat, -1, 0), strict=True))
    return parts | {"vector": np.linalg.norm(report, axis=-1)}


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


@pytest.mark.parametrize("part", PARTS)
def test_coriolis(run, part):
    wanted, made = run.desired, run.solution.modified
    before, after = coriolis_parts(wanted)[part], coriolis_parts(made)[part]
    found = run.metrics["coriolis"][part]
    energies = [integral(wanted, side**2) for side in (before, after)]
    assert found["reduction"] == pytest.approx(1.0 - energies[1] / energies[0], rel=1e-9)
    assert found["rms_before_rad_s2"] == pytest.approx(math.sqrt(energies[0] / 6.0), rel=1e-9)
    assert found["rms_after_rad_s2"] == pytest.approx(math.sqrt(energies[1] / 6.0), rel=1e-9)
    assert found["peak_before_rad_s2"] == pytest.approx(np.abs(before).max(), rel=1e-9)
    assert found["peak_after_rad_s2"] == pytest.approx(np.abs(after).max(), rel=1e-9)


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


def test_felt_fidelity(run):
    wanted, made = run.desired, run.solution.modified
    fidelity = run.metrics["fidelity"]

    def seat_rate(motion):
        """W by J_in and the closed rotation, on sides."""
        angle, rate = on_sides(motion)
        (s1, s2), (c1, c2) = (np.moveaxis(f(angle[..., :2]), -1, 0) for f in (np.sin, np.cos))
        d1, d2, d3 = np.moveaxis(rate, -1, 0)
        w = np.stack([c1 * d2 - s1 * c2 * d3, -s1 * d2 - c1 * c2 * d3, -d1 - s2 * d3], axis=-1)
        return np.einsum("ksij,ksi->ksj", frames(motion), w)

    def relative(one, other):
        off = integral(wanted, np.sum((other - one) ** 2, axis=-1))
        return math.sqrt(off / integral(wanted, np.sum(one**2, axis=-1)))

    assert fidelity["seat_rate_deviation_relative"] == pytest.approx(
        relative(seat_rate(wanted), seat_rate(made)), rel=1e-9
    )
    before, after = run.before.seat_g, run.after.seat_g
    assert fidelity["seat_g_deviation_relative"] == pytest.approx(relative(before, after))
    error = math.sqrt(integral(wanted, np.sum((after - before) ** 2, axis=-1)) / 6.0)
    assert fidelity["seat_g_rms_error_g"] == pytest.approx(error)
    cosine = 0.5 * (np.einsum("ksij,ksij->ks", frames(wanted), frames(made)) - 1.0)
    largest = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)).max())
    assert fidelity["attitude_error_max_deg"] == pytest.approx(largest, rel=1e-6)


def turning(motion):
    """dW/dt in seat axes: W by a matrix written out, and its chain rule by differences."""
    angle, rate = on_sides(motion)

    def seat_rate(q, qd):
        (s2, s3), (c2, c3) = (np.moveaxis(f(q[..., 1:]), -1, 0) for f in (np.sin, np.cos))
        a, f, k = np.moveaxis(qd, -1, 0)
        return np.stack([-s2 * a - k, -c2 * s3 * a + c3 * f, c2 * c3 * a + s3 * f], axis=-1)

    h, qdd = 1e-6, motion.acceleration[:, None]
    ahead, behind = (seat_rate(angle + s * rate, rate + s * qdd) for s in (h, -h))
    return seat_rate(angle, rate), (ahead - behind) / (2 * h)


def test_what_is_felt_before_and_after(run):
    record = run.asked.motion
    before, after = turning(record), turning(run.solution.modified)
    for section, unit, old, new in (
        ("seat_rate", "rad_s", before[0], after[0]),
        ("seat_angular_acceleration", "rad_s2", before[1], after[1]),
    ):
        found = run.metrics["felt"][section]
        names = "pqr" if section == "seat_rate" else "xyz"
        assert set(found) == {*names, "magnitude"}
        for when, vectors in (("before", old), ("after", new)):
            columns = [*np.moveaxis(vectors, -1, 0), np.linalg.norm(vectors, axis=-1)]
            for name, sides in zip((*names, "magnitude"), columns, strict=True):
                rms = math.sqrt(integral(record, sides**2) / 6.0)
                assert found[name][f"rms_{when}_{unit}"] == pytest.approx(rms, rel=1e-7)
                peak = np.abs(sides).max()
                assert found[name][f"peak_{when}_{unit}"] == pytest.approx(peak, rel=1e-7)
    fidelity = run.metrics["fidelity"]
    off = integral(record, np.sum((after[1] - before[1]) ** 2, axis=-1))
    size = integral(record, np.sum(before[1] ** 2, axis=-1))
    assert fidelity["seat_angular_acceleration_rms_error_rad_s2"] == pytest.approx(
        math.sqrt(off / 6.0), rel=1e-7
    )
    assert fidelity["seat_angular_acceleration_deviation_relative"] == pytest.approx(
        math.sqrt(off / size), rel=1e-7
    )


def test_the_g_vector_by_axis(run):
    for index, axis in enumerate(("gx", "gy", "gz")):
        found = run.metrics["felt"]["seat_g"][axis]
        for when, response in (("before", run.before), ("after", run.after)):
            sides = response.seat_g[..., index]
            jump = [abs(sides[k + 1, 0] - sides[k, 1]) for k in range(len(sides) - 1)]
            assert found[f"jump_{when}_g"] == pytest.approx(max(jump))
            assert found[f"min_{when}_g"] == sides.min()
            assert found[f"max_{when}_g"] == sides.max()
            assert found[f"peak_{when}_g"] == max(-sides.min(), sides.max())
            # the samples lie 0.02 s apart: five of them are the onset's window, whose
            # ends lie just before or just after the jumps at two samples
            rise = [
                abs(sides[k + 5, side] - sides[k, side]) / 0.1
                for k in range(len(sides) - 5)
                for side in (0, 1)
            ]
            assert found[f"onset_{when}_g_s"] == pytest.approx(max(rise), rel=1e-6)
        off = run.after.seat_g[..., index] - run.before.seat_g[..., index]
        rms = math.sqrt(integral(run.desired, off**2) / 6.0)
        assert found["rms_error_g"] == pytest.approx(rms)


def test_tilt_is_the_angle_between_the_g_vectors(run):
    before, after = run.before.seat_g, run.after.seat_g
    cosine = np.sum(before * after, axis=-1)
    cosine /= np.linalg.norm(before, axis=-1) * np.linalg.norm(after, axis=-1)
    angle = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
    fidelity = run.metrics["fidelity"]
    assert fidelity["tilt_error_max_deg"] == pytest.approx(angle.max(), rel=1e-6)
    rms = math.sqrt(integral(run.asked.motion, angle**2) / 6.0)
    assert fidelity["tilt_error_rms_deg"] == pytest.approx(rms, rel=1e-6)


def test_a_weightless_pilot_has_no_down_that_could_tilt():
    step = np.array([1.0, 3.0])
    down, sideways, hardly = [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.05, 0.0]
    before = np.array([[down, down], [down, hardly]])
    found = tilt_error(step, before, np.array([[down, sideways], [hardly, down]]))
    # the first interval alone counts: half of it upright, half of it on the side
    assert found["tilt_error_max_deg"] == pytest.approx(90.0)
    assert found["tilt_error_rms_deg"] == pytest.approx(90.0 / math.sqrt(2.0))
    nothing = tilt_error(step, 0.05 * before, before)
    assert nothing == {"tilt_error_max_deg": None, "tilt_error_rms_deg": None}


def test_what_is_felt_is_measured_against_the_record():
    """The cab turns back at once; rounded off, the motion is no longer what was recorded."""
    profile = sway(120)
    hold = replace(profile.reduction, r2=np.full(3, 1e9), limits="enforce")
    run = reduce_profile(replace(profile, reduction=hold))
    assert run.desired is not run.asked.motion
    record, modified = turning(run.asked.motion), turning(run.solution.modified)
    executable = turning(run.desired)
    motion = run.asked.motion

    def error(one, other):
        return math.sqrt(integral(motion, np.sum((other - one) ** 2, axis=-1)) / 6.0)

    found = run.metrics["fidelity"]["seat_angular_acceleration_rms_error_rad_s2"]
    assert found == pytest.approx(error(record[1], modified[1]), rel=1e-6)
    cost = run.metrics["executable"]
    key = "seat_angular_acceleration_rms_error_rad_s2"
    assert cost["replaced"] is True
    assert cost[key] == pytest.approx(error(record[1], executable[1]), rel=1e-6)
    assert cost[key] > 0.1
    size = integral(motion, np.sum(record[0] ** 2, axis=-1))
    assert cost["seat_rate_deviation_relative"] == pytest.approx(
        error(record[0], executable[0]) / math.sqrt(size / 6.0), rel=1e-6
    )
    # nothing but the limits moved it
    for measure in (key, "seat_rate_deviation_relative", "seat_g_rms_error_g"):
        assert run.metrics["fidelity"][measure] == pytest.approx(cost[measure], rel=1e-3)


def test_a_motion_that_is_not_replaced_costs_nothing(run):
    assert run.metrics["executable"] == {
        "replaced": False,
        "breaks_limits": True,  # its cab's rate steps, and limits are only warned of
        "joint_change_relative": 0.0,
        "joint_change_max_rad": dict.fromkeys(JOINTS, 0.0),
        "seat_rate_deviation_relative": 0.0,
        "seat_g_rms_error_g": 0.0,
        "seat_angular_acceleration_rms_error_rad_s2": 0.0,
        "attitude_error_max_deg": 0.0,
    }
    assert run.metrics["changes"] == {"damping": None, "smoothing": None}


def test_jerk_and_sign_changes(run):
    for which, motion in (("desired", run.asked.motion), ("modified", run.solution.modified)):
        for j, joint in enumerate(JOINTS):
            found = run.metrics["limits"][which][joint]
            middle = 0.5 * (motion.t[1:] + motion.t[:-1])
            slope = np.diff(motion.acceleration[:, j]) / np.diff(middle)
            smooth = np.abs(motion.rate_start[1:, j] - motion.rate_end[:-1, j]) < 1e-9
            assert smooth.all() == (joint != "cab")
            assert found["jerk_peak_rad_s3"] == pytest.approx(np.abs(slope[smooth]).max())
            assert found["acceleration_sign_changes"] == changes(
                motion.acceleration[:, j], 0.01 * DES.limits[j].acceleration
            )
    # a cosine's rate: its acceleration is a sine, up and down within 6 s
    assert run.metrics["limits"]["desired"]["arm"]["acceleration_sign_changes"] == 1


def changes(values, least):
    last, count = 0.0, 0
    for value in values:
        if abs(value) > least:
            count += last * value < 0.0
            last = value
    return count


def test_a_machine_without_a_jerk_limit_has_none():
    limits = tuple(replace(limit, jerk=math.inf) for limit in DES.limits)
    profile = replace(sway(60), machine=replace(DES, limits=limits))
    found = reduce_profile(profile).metrics["limits"]["modified"]
    assert all(found[joint]["jerk_limit_rad_s3"] is None for joint in JOINTS)
    limits = tuple(replace(limit, jerk=7.5) for limit in DES.limits)
    profile = replace(profile, machine=replace(DES, limits=limits))
    found = reduce_profile(profile).metrics["limits"]["modified"]
    assert all(found[joint]["jerk_limit_rad_s3"] == 7.5 for joint in JOINTS)


def test_the_time_at_the_acceleration_limit(run):
    motion = run.solution.modified
    for j, joint in enumerate(JOINTS):
        full = np.abs(motion.acceleration[:, j]) >= 0.99 * DES.limits[j].acceleration
        share = sum(motion.step[full]) / 6.0
        found = run.metrics["limits"]["modified"][joint]["at_acceleration_limit"]
        assert found == pytest.approx(share)


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


def test_limits(run):
    for which, motion in (("desired", run.desired), ("modified", run.solution.modified)):
        for j, joint in enumerate(JOINTS):
            found = run.metrics["limits"][which][joint]
            peak = max(np.abs(motion.rate_start[:, j]).max(), np.abs(motion.rate_end[:, j]).max())
            assert found["rate_peak_rad_s"] == pytest.approx(peak)
            assert found["rate_limit_rad_s"] == DES.limits[j].rate
            assert found["acceleration_limit_rad_s2"] == DES.limits[j].acceleration
            named = {(v.motion, v.joint) for v in run.violations}
            assert found["ok"] is ((which, joint) not in named)
    # the cab turns back at once, which no limit admits
    assert run.metrics["limits"]["desired"]["cab"]["ok"] is False


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
    assert any("damped" in notice for notice in run.notices)
