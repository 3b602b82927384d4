"""The fidelity metrics against an evaluation that shares no code, and by hand."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.metric import METRICS
from des_cli.model.motion import Motion
from des_cli.reduction.executable import integrate_rates
from des_cli.reduction.fidelity import Deviation
from tests.support.cobra import States, cobra
from tests.support.felt_reference import evaluate

TURNED = Seat(np.radians(87.1), np.radians(-12.0))
ROWS = np.linspace(0.0, 10.0, 2001)


def offsets(t):
    """A smooth deviation of each joint: angle, rate, acceleration."""
    size = np.array([0.2, 0.05, -0.1])
    w = np.array([0.9, 1.7, 2.3])
    s, c = np.sin(t[:, None] * w), np.cos(t[:, None] * w)
    return size * s, size * w * c, -size * w**2 * s


def modified(t) -> States:
    return tuple(a + b for a, b in zip(cobra(t), offsets(t), strict=True))  # type: ignore[return-value]


def motion_of(states) -> Motion:
    """Samples of a path, with both rates where it steps."""
    half = 1e-9
    angle = states(ROWS)[0]
    return Motion(ROWS, angle, states(ROWS[:-1] + half)[1], states(ROWS[1:] - half)[1])


def deviation_of(seat=None, control=None):
    chains = chain_of(DES, Seat()), chain_of(DES, seat or Seat())
    return Deviation.between(motion_of(cobra), motion_of(modified), chains, DES.gravity, control)


@pytest.mark.parametrize("seat", [None, TURNED], ids=["same", "turned"])
def test_against_the_independent_evaluation(seat):
    found = deviation_of(seat)
    where = None if seat is None else (seat.yaw, seat.pitch)
    expected = evaluate(modified, ROWS, modified_seat=where)
    for metric, value in {
        "joint_deviation_relative": expected.joint_deviation_relative,
        "joint_deviation_relative_squared": expected.joint_deviation_relative**2,
        "seat_rate_deviation_relative": expected.seat_rate_deviation_relative,
        "seat_g_rms_error_g": expected.seat_g_rms_error_g,
        "seat_angular_acceleration_rms_error_rad_s2": expected.turning_rms_error,
        "seat_angular_acceleration_deviation_relative": expected.turning_rms_error
        / expected.turning_rms_before,
        "seat_angular_acceleration_rms_ratio": expected.turning_rms_after
        / expected.turning_rms_before,
        "seat_angular_acceleration_peak_ratio": expected.turning_peak_after
        / expected.turning_peak_before,
        "attitude_error_max_deg": expected.attitude_error_max_deg,
    }.items():
        # the table's trapezoids, and piecewise constant accelerations
        assert found.value(metric) == pytest.approx(value, rel=3e-3), metric


def test_the_relative_deviation_of_g():
    found = deviation_of()
    off, size = found.after.seat_g - found.before.seat_g, found.before.seat_g
    weight = 0.5 * np.diff(ROWS)[:, None]
    expected = np.sqrt(
        np.sum(weight * np.sum(off**2, axis=-1)) / np.sum(weight * np.sum(size**2, axis=-1))
    )
    assert found.value("seat_g_deviation_relative") == pytest.approx(expected, rel=1e-12)


def test_no_deviation():
    chain = chain_of(DES, Seat())
    motion = motion_of(cobra)
    same = Deviation.between(motion, motion, (chain, chain), DES.gravity, np.ones((len(ROWS), 3)))
    for metric in METRICS:
        expected = 1.0 if metric.endswith("_ratio") else 0.0
        assert same.value(metric) == pytest.approx(expected, abs=1e-12), metric


def test_a_turned_seat_alone_changes_the_attitude_by_its_turn():
    motion = motion_of(cobra)
    chains = chain_of(DES, Seat()), chain_of(DES, Seat(pitch=np.radians(-12.0)))
    found = Deviation.between(motion, motion, chains, DES.gravity)
    assert found.value("attitude_error_max_deg") == pytest.approx(12.0, rel=1e-9)
    # the joints turn it by the same vector, seen from other axes
    assert found.value("seat_angular_acceleration_rms_ratio") == pytest.approx(1.0, rel=1e-12)
    assert found.value("joint_deviation_relative") == 0.0
    assert found.value("seat_rate_deviation_relative") > 0.05


def test_factors_are_measured_where_there_are_any():
    factor = np.linspace(0.5, 1.0, len(ROWS))[:, None]
    found = deviation_of(control=factor).value("mean_square_one_minus_p")
    assert found == pytest.approx(0.25 / 3.0, rel=1e-5)
    assert np.isnan(deviation_of().value("mean_square_one_minus_p"))
    none = np.zeros((len(ROWS), 0))
    assert np.isnan(deviation_of(control=none).value("mean_square_one_minus_p"))


def test_a_reference_without_any_motion():
    t = np.linspace(0.0, 1.0, 11)
    still = integrate_rates(t, np.zeros(3), np.zeros((11, 3)))
    chain = chain_of(DES, Seat())
    found = Deviation.between(still, still, (chain, chain), DES.gravity)
    assert found.value("seat_rate_deviation_relative") == 0.0
    assert found.value("joint_deviation_relative") == 0.0
