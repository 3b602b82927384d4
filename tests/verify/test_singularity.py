"""How near the singularity a motion comes, and what of body rates is not made, by hand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from des_cli.model.arrays import Floats
from des_cli.model.machine import JointLimits
from des_cli.model.machines import DES
from des_cli.model.metrics import Singularity
from des_cli.model.motion import Motion
from des_cli.model.profile import BodyRates
from des_cli.verify.claim import Claim
from des_cli.verify.requested import turned
from des_cli.verify.singularity import singularity_numbers
from tests.support.claims import claim_of

T = np.array([0.0, 0.5, 1.0, 2.0, 4.0])
FORK = [0.1, 0.4, -1.2, 0.9, 0.2]


def standing(fork: Sequence[float] = FORK, rate: float = 0.0) -> Motion:
    """The arm turns at a rate, the fork stands anew at every sample."""
    rates = np.zeros((len(fork) - 1, 3))
    rates[:, 0] = rate
    angle = np.stack([0.3 + 0 * T, fork, 0.7 + 0 * T], axis=1)
    return Motion(T, angle, rates, rates)


def claim_on(motion: Motion, start: Floats, end: Floats, **further: Floats) -> Claim:
    """The claim that a motion is the one asked for by body rates."""
    claim = claim_of(motion)
    middle = further.pop("middle", 0.5 * (start + end))
    command = BodyRates(start, middle, end, **further)
    return replace(claim, profile=replace(claim.profile, command=command))


def found(claim: Claim, told: Singularity | None = None) -> dict[str, float]:
    return {name: value for name, _, value in singularity_numbers(claim, told or Singularity())}


def made(motion: Motion) -> tuple[Floats, Floats]:
    """The seat's rate at the starts of the intervals and at their ends, (n - 1, 3) each."""
    start, end = np.split(claim_of(motion).made.rate.T, 2)
    return start, end


@pytest.mark.parametrize("largest", [1.2, -1.5, 0.3])
def test_joint_commands_are_made_and_their_nearness_is_a_closed_form(largest: float) -> None:
    """The singular values of the DES are 1 and the roots of 1 + s2 and of 1 - s2."""
    fork = [0.1, -0.2, largest, 0.2, 0.0]
    assert found(claim_of(standing(fork, 0.5))) == pytest.approx(
        {
            "min_abs_cos_fork": np.cos(largest),
            "min_singular_value": np.sqrt(1.0 - np.sin(abs(largest))),
            "damped_samples": 0.0,
            "max_residual_rad_s": 0.0,
            "integration_error_max_deg": 0.0,
        },
        abs=1e-12,
    )


def test_what_is_told_is_beside_what_is_found() -> None:
    told = Singularity(0.1, 0.2, 3, 0.4, 0.5, 0.6)
    motion = standing()
    attitude = np.tile([1.0, 0.0, 0.0, 0.0], (5, 1))
    names = {
        "min_abs_cos_fork": 0.1,
        "min_singular_value": 0.2,
        "damped_samples": 3,
        "max_residual_rad_s": 0.4,
        "integration_error_max_deg": 0.5,
    }
    numbers = list(singularity_numbers(claim_of(motion), told))
    assert {name: value for name, value, _ in numbers} == names
    numbers = list(singularity_numbers(claim_on(motion, *made(motion), attitude=attitude), told))
    assert {name: value for name, value, _ in numbers} == {
        **names,
        "recorded_attitude_error_max_deg": 0.6,
    }


@pytest.mark.parametrize(
    ("side", "row", "share"),
    [
        *(("start", 0, 1.0), ("start", 1, 0.5), ("start", 2, 0.5)),
        *(("end", -1, 1.0), ("end", -2, 0.5), ("end", 1, 0.5)),
    ],
)
def test_a_rate_that_is_missed_counts_as_the_mean_of_its_sides(
    side: str, row: int, share: float
) -> None:
    motion = standing(rate=0.4)
    start, end = made(motion)
    missed = np.array([0.02, -0.03, 0.06])  # 0.07 long
    (start if side == "start" else end)[row] += missed
    assert found(claim_on(motion, start, end))["max_residual_rad_s"] == pytest.approx(0.07 * share)


def test_a_rate_that_is_missed_on_both_sides_counts_whole() -> None:
    motion = standing(rate=0.4)
    start, end = made(motion)
    start[2] += [0.02, -0.03, 0.06]
    end[1] += [0.02, -0.03, 0.06]
    assert found(claim_on(motion, start, end))["max_residual_rad_s"] == pytest.approx(0.07)


NEAR = [
    # 1 - sin of the fork below 0.01: damped from 1.4293 rad on
    ([0.1, 1.4, 0.2, 0.3, 0.1], 0),
    ([0.1, 1.428, 0.2, 0.3, 0.1], 0),
    ([0.1, 1.431, 0.2, 0.3, 0.1], 1),
    ([-1.431, 0.4, 0.2, 0.3, 1.5], 2),
    ([1.5, 1.5, 1.5, 1.5, 1.5], 5),
]


@pytest.mark.parametrize(("fork", "damped"), NEAR)
def test_samples_near_the_singularity_are_damped(fork: list[float], damped: int) -> None:
    motion = standing(fork, rate=0.01)
    assert found(claim_on(motion, *made(motion)))["damped_samples"] == damped


@pytest.mark.parametrize("joint", [0, 1, 2])
@pytest.mark.parametrize(("side", "row"), [("start", 0), ("start", 2), ("end", 2), ("end", 3)])
@pytest.mark.parametrize(("share", "held"), [(1.02, 1), (0.98, 0)])
def test_samples_are_held_where_a_joint_would_be_too_fast(
    joint: int, side: str, row: int, share: float, held: int
) -> None:
    motion = standing()
    limits = [JointLimits(angle=9.0, rate=rate, acceleration=9.0) for rate in (0.5, 0.7, 0.9)]
    rates = np.zeros((4, 3))
    rates[row, joint] = -share * limits[joint].rate
    sides = {"rate_start": motion.rate_start, "rate_end": motion.rate_end}
    sides[f"rate_{side}"] = rates
    start, end = made(replace(motion, **sides))
    claim = claim_on(motion, start, end)
    machine = replace(DES, limits=tuple(limits))
    claim = replace(claim, profile=replace(claim.profile, machine=machine))
    assert found(claim)["damped_samples"] == held


def test_both_sides_of_a_sample_are_one_sample() -> None:
    motion = standing()
    rates = np.zeros((2, 4, 3))
    rates[0, 2, 0] = rates[1, 1, 0] = 2.0 * DES.limits[0].rate
    start, end = made(replace(motion, rate_start=rates[0], rate_end=rates[1]))
    assert found(claim_on(motion, start, end))["damped_samples"] == 1


@pytest.mark.parametrize(("told", "expected"), [(0, 0.0), (1, 1.0), (2, 1.0), (None, 0.0)])
def test_at_a_limit_to_rounding_either_count_is_right(told: int | None, expected: float) -> None:
    motion = standing()
    rates = np.zeros((4, 3))
    rates[1, 0] = DES.limits[0].rate
    start, end = made(replace(motion, rate_start=rates))
    claim = claim_on(motion, start, end)
    assert found(claim, Singularity(damped_samples=told))["damped_samples"] == expected


def test_an_attitude_is_off_by_what_the_seat_does_not_turn() -> None:
    """It stands still, and is asked to turn about one axis at 0.1 rad/s for 4 s."""
    motion = Motion(T, np.tile([0.3, 0.4, 0.7], (5, 1)), np.zeros((4, 3)), np.zeros((4, 3)))
    rate = np.tile(0.1 * np.array([2.0, -3.0, 6.0]) / 7.0, (4, 1))
    claim = claim_on(motion, rate, rate)
    assert found(claim)["integration_error_max_deg"] == pytest.approx(np.degrees(0.4), rel=1e-12)
    back = np.where(T[:-1, None] < 1.0, rate, -rate / 3.0)
    claim = claim_on(motion, back, back)
    assert found(claim)["integration_error_max_deg"] == pytest.approx(np.degrees(0.1), rel=1e-12)


def test_an_attitude_may_be_off_by_half_a_turn() -> None:
    rng = np.random.default_rng(7)
    motion = Motion(T, np.tile([0.3, 0.4, 0.7], (5, 1)), np.zeros((4, 3)), np.zeros((4, 3)))
    for axis in rng.normal(size=(40, 3)):
        rate = np.tile(np.pi / 4.0 * axis / np.linalg.norm(axis), (4, 1))
        off = found(claim_on(motion, rate, rate))["integration_error_max_deg"]
        assert off == pytest.approx(180.0, abs=1e-5)


def test_an_attitude_is_compared_from_where_the_seat_begins() -> None:
    """The arm turns by 0.4 rad/s, as it is asked to, and the seat is anywhere."""
    t = np.linspace(0.0, 2.0, 21)
    angle = np.stack([0.5 + 0.4 * t, 0 * t + 0.3, 0 * t - 0.8], axis=1)
    rates = np.tile([0.4, 0.0, 0.0], (20, 1))
    motion = Motion(t, angle, rates, rates)
    numbers = found(claim_on(motion, *made(motion)))
    assert numbers["integration_error_max_deg"] == pytest.approx(0.0, abs=1e-6)
    assert numbers["max_residual_rad_s"] == pytest.approx(0.0, abs=1e-12)


def test_a_record_is_compared_from_its_first_row() -> None:
    """It turns by 0.15 rad/s about an axis about which rates of 0.1 rad/s are asked."""
    motion = standing()
    axis = np.array([2.0, -3.0, 6.0]) / 7.0
    rate = np.tile(0.1 * axis, (4, 1))
    first = Rotation.from_rotvec([0.3, 0.2, -0.4])
    record = (first * Rotation.from_rotvec(np.outer(0.15 * T, axis))).as_quat()[:, [3, 0, 1, 2]]
    name = "recorded_attitude_error_max_deg"
    for size in (1.0, -1.0, 2.0):
        claim = claim_on(motion, rate, rate, attitude=size * record)
        assert found(claim)[name] == pytest.approx(np.degrees(0.2), rel=1e-9)
    for unknown, expected in (([4], 0.1), ([2, 4], 0.1), ([2], 0.2)):
        some = record.copy()
        some[unknown, 1] = np.nan
        claim = claim_on(motion, rate, rate, attitude=some)
        assert found(claim)[name] == pytest.approx(np.degrees(expected), rel=1e-9)
    some = record.copy()
    some[0, 2] = np.nan
    assert name not in found(claim_on(motion, rate, rate, attitude=some))
    assert name not in found(claim_on(motion, rate, rate))


def test_a_smooth_rate_turns_as_it_does_in_small_steps() -> None:
    """Against a hundred turns at constant rates in every interval."""
    t = np.cumsum([0.0, 0.05, 0.1, 0.05, 0.08])

    def rate(at: Floats) -> Floats:
        return np.stack([np.sin(2.0 * at), np.cos(at), 0.5 + at], axis=-1)

    middle = 0.5 * (t[:-1] + t[1:])
    attitude = turned(np.diff(t), BodyRates(rate(t[:-1]), rate(middle), rate(t[1:])))
    assert attitude.shape == (3, 3, 5)
    np.testing.assert_array_equal(attitude[..., 0], np.eye(3))
    now = Rotation.identity()
    for i, h in enumerate(np.diff(t)):
        for each in rate(t[i] + h * (np.arange(100) + 0.5) / 100.0):
            now = now * Rotation.from_rotvec(h / 100.0 * each)
        np.testing.assert_allclose(attitude[..., i + 1], now.as_matrix(), atol=1e-6)
