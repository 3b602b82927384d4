"""Rows that are too far apart are divided; the others, and the recorded ones, stay."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator
from scipy.spatial.transform import Rotation

from des_cli.kinematics.chain import chain_of, seat_rotation
from des_cli.kinematics.commanded_motion import make_desired
from des_cli.kinematics.orientation import body_jacobian
from des_cli.kinematics.refinement import TOLERANCE
from des_cli.model.arrays import Floats
from des_cli.model.gaps import find_gaps
from des_cli.model.motion import Motion
from des_cli.model.profile import Profile
from des_cli.profiles_in.load import load_profile
from des_cli.reduction.limits import find_violations

COARSE_DEG = np.array(
    [[0, 0, 0], [1, 0.5, 1], [-1, 0.5, 2], [1, -0.5, 1], [-1, -0.5, 2], [1, 0.5, 1], [0, 0, 0]]
)


def profile_of(t: Floats, rates: Floats, *settings: str, attitude: Floats | None = None) -> Profile:
    header = "t_s,p_rad_s,q_rad_s,r_rad_s" + (",q0,q1,q2,q3" if attitude is not None else "")
    table = np.column_stack([t, rates, *([attitude] if attitude is not None else [])])
    rows = "\n".join(",".join(repr(float(cell)) for cell in row) for row in table)
    return load_profile("-", stdin=f"{header}\n{rows}\n".encode(), settings=settings)


def coarse() -> tuple[Floats, Floats]:
    return np.arange(0.0, 70.0, 10.0), np.radians(COARSE_DEG.astype(float))


def noisy(seed: int = 0) -> tuple[Floats, Floats]:
    """A record at about 80 Hz with the noise of a gyroscope."""
    rng = np.random.default_rng(seed)
    t = np.cumsum(rng.choice([0.008, 0.012, 0.016], 1500))
    rates = np.column_stack([0.3 * np.sin(1.1 * t), 0.2 * np.cos(0.7 * t), 0.3 * np.sin(0.4 * t)])
    return t, rates + rng.normal(0.0, 0.03, rates.shape)


def with_gap() -> tuple[Floats, Floats]:
    t, rates = noisy(1)
    kept = (t < 4.0) | (t > 6.5)
    return t[kept], rates[kept]


def rates_between(profile: Profile, motion: Motion, parts: Floats) -> Floats:
    """Seat rates of a motion whose joint rates are linear, at parts of each interval."""
    s, h = parts[None, :, None], motion.step[:, None, None]
    change = (motion.rate_end - motion.rate_start)[:, None]
    rate = motion.rate_start[:, None] + s * change
    angle = motion.angle[:-1, None] + h * s * (motion.rate_start[:, None] + 0.5 * s * change)
    jacobian = body_jacobian(chain_of(profile.machine, profile.seat), angle)
    return np.asarray((jacobian @ rate[..., None])[..., 0])


def test_between_coarse_rows_the_seat_turns_as_the_interpolant_does() -> None:
    t, rates = coarse()
    profile = profile_of(t, rates)
    desired = make_desired(profile)
    motion = desired.motion
    rms = np.sqrt(np.mean(np.sum(rates**2, axis=1)))
    parts = np.linspace(0.0, 1.0, 9)
    want = PchipInterpolator(t, rates)(motion.t[:-1, None] + motion.step[:, None] * parts)
    error = np.linalg.norm(rates_between(profile, motion, parts) - want, axis=-1)
    assert error.max() < 1.2 * TOLERANCE * rms
    recorded = np.searchsorted(motion.t, t)
    np.testing.assert_array_equal(motion.t[recorded], t)
    at_rows = rates_between(profile, motion, np.zeros(1))[recorded[:-1], 0]
    np.testing.assert_allclose(at_rows, rates[:-1], rtol=0, atol=1e-15)
    assert find_violations(profile.machine, motion, "desired") == ()
    assert find_gaps(motion.t) == []


def test_the_remark_tells_how_far_apart_the_rows_were_and_are() -> None:
    desired = make_desired(profile_of(*coarse()))
    (remark,) = desired.remarks
    shortest = f"{desired.motion.step.min():.3g} s"
    assert remark.startswith(f"rows up to 10 s apart were refined to {shortest}, to hold")
    assert remark.endswith(f"7 rows became {len(desired.motion.t)}")


def test_a_record_that_resolves_its_motion_keeps_its_rows() -> None:
    t, rates = noisy()
    desired = make_desired(profile_of(t, rates))
    np.testing.assert_array_equal(desired.motion.t, t)
    assert desired.remarks == ()


def test_a_record_that_stands_still_keeps_its_rows() -> None:
    t = np.arange(0.0, 50.0, 10.0)
    desired = make_desired(profile_of(t, np.zeros((5, 3))))
    np.testing.assert_array_equal(desired.motion.t, t)


def test_rows_are_added_in_a_bridged_gap_so_that_the_table_has_none() -> None:
    t, rates = with_gap()
    motion = make_desired(profile_of(t, rates, "gap=bridge")).motion
    assert len(find_gaps(t)) == 1
    assert find_gaps(motion.t) == []
    assert set(t) <= set(motion.t)


def test_a_turn_about_the_arm_alone_is_divided_where_its_rate_is_curved() -> None:
    t = np.arange(0.0, 50.0, 10.0)
    rates = np.outer([0.0, 0.1, 0.1, 0.3, 0.0], [0.0, 0.0, 1.0])
    motion = make_desired(profile_of(t, rates)).motion
    assert 10.0 not in motion.step[motion.t[:-1] < 10.0]
    trapezoids = np.cumsum(0.5 * motion.step * (motion.rate_start + motion.rate_end)[:, 0])
    whole = PchipInterpolator(t, rates[:, 2]).integrate(0.0, 40.0)
    assert trapezoids[-1] == pytest.approx(float(whole), rel=2e-4)


@pytest.mark.parametrize("record", [coarse, noisy, with_gap], ids=["coarse", "noisy", "gap"])
def test_the_attitude_is_that_of_an_independent_integration(record) -> None:
    t, rates = record()
    profile = profile_of(t, rates, "gap=bridge")
    motion = make_desired(profile).motion
    flown = seat_rotation(chain_of(profile.machine, profile.seat), motion.angle)
    interpolant = PchipInterpolator(t, rates)
    # Short turns by Gauss's two points, of which the rest is of the fourth order.
    pieces = np.maximum(2, np.ceil(motion.step / 0.01).astype(int))
    attitude = Rotation.from_matrix(flown[0])
    worst = 0.0
    for k, count in enumerate(pieces):
        h = motion.step[k] / count
        starts = motion.t[k] + h * np.arange(count)
        points = [interpolant(starts + h * (0.5 + x)) for x in (-(3**-0.5) / 2, 3**-0.5 / 2)]
        for turn in Rotation.from_rotvec(0.5 * h * (points[0] + points[1])):
            attitude = attitude * turn
        error = attitude.inv() * Rotation.from_matrix(flown[k + 1])
        worst = max(worst, float(np.degrees(error.magnitude())))
    assert worst < 0.005


def test_a_recorded_attitude_is_compared_at_the_recorded_rows() -> None:
    t, rates = coarse()
    motion = make_desired(profile_of(t, rates)).motion
    profile = profile_of(t, rates)
    flown = seat_rotation(chain_of(profile.machine, profile.seat), motion.angle)
    recorded = Rotation.from_matrix(flown[np.searchsorted(motion.t, t)]).as_quat()[:, [3, 0, 1, 2]]
    found = make_desired(profile_of(t, rates, attitude=recorded))
    assert found.recorded_attitude_error is not None
    assert found.recorded_attitude_error < 1e-6


def test_rows_that_are_added_hold_the_angular_acceleration() -> None:
    """Slow rates 10 s apart: what the table turns the seat by is theirs, not its steps'."""
    t, rates = coarse()
    profile = profile_of(t, rates)
    motion = make_desired(profile).motion
    rate = rates_between(profile, motion, np.array([0.0, 1.0]))
    turning = (rate[:, 1] - rate[:, 0]) / motion.step[:, None]
    exact = PchipInterpolator(t, rates)(0.5 * (motion.t[:-1] + motion.t[1:]), 1)
    halves = rates_between(profile, motion, np.array([0.0, 0.05, 0.95, 1.0]))
    begin = (halves[:, 1] - halves[:, 0]) / (0.05 * motion.step[:, None])
    assert np.max(np.linalg.norm(turning - exact, axis=1)) < 1e-3
    assert np.max(np.linalg.norm(begin - exact, axis=1)) < 0.01
