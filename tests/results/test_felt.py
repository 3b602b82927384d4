"""What is felt, by plain sums over closed forms."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from des_cli.pipeline import reduce_profile
from des_cli.results.felt import tilt_error
from tests.support.sway import frames, integral, on_sides, reduced_sway, sway


@pytest.fixture
def run():
    return reduced_sway()


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
    most, rms = tilt_error(step, before, np.array([[down, sideways], [hardly, down]]))
    # the first interval alone counts: half of it upright, half of it on the side
    assert most == pytest.approx(90.0)
    assert rms == pytest.approx(90.0 / math.sqrt(2.0))
    assert tilt_error(step, 0.05 * before, before) == (None, None)


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
