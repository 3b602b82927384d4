"""Which records are called noisy."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.commanded_motion import make_desired
from des_cli.kinematics.noise import suggest_smoothing
from des_cli.kinematics.smoothing import smooth_command
from des_cli.model.machines import DES
from des_cli.model.profile import BodyRates, JointCommands, Profile

T = np.arange(1001) * 0.02


def suggested(rates: np.ndarray, cutoff_hz: float = np.inf) -> str:
    command: BodyRates | JointCommands = BodyRates(
        rates[:-1], 0.5 * (rates[:-1] + rates[1:]), rates[1:]
    )
    command = smooth_command(T, command, cutoff_hz)
    profile = Profile(
        "noisy", T, command, DES, initial_angle=np.array([0, 0.3, 0]), smooth_cutoff_hz=cutoff_hz
    )
    return suggest_smoothing(profile, make_desired(profile))


def slow() -> np.ndarray:
    return np.column_stack([0.1 * np.sin(0.4 * T), 0.15 * np.sin(0.3 * T), 0.2 * np.sin(0.2 * T)])


def noise(size: float) -> np.ndarray:
    return size * np.random.default_rng(4).normal(size=(len(T), 3))


@pytest.mark.parametrize("size", [0.001, 0.01])
def test_a_gyro_s_noise_is_called_noise_and_the_cure_is_named(size: float) -> None:
    sentence = suggested(slow() + noise(size))
    assert sentence.startswith("the record is noisy: the arm's acceleration or jerk is beyond")
    assert "smooth: {cutoff_hz: 2} (--smooth 2)" in sentence


def test_a_smoothed_record_is_not_suggested_to_be_smoothed() -> None:
    assert suggested(slow() + noise(0.01), 2.0) == ""


def test_a_slow_motion_is_not_called_noise() -> None:
    assert suggested(slow()) == ""


def test_the_corner_of_a_maneuver_is_not_called_noise() -> None:
    corner = slow()
    corner[500:, 1] += 0.3
    assert suggested(corner) == ""


def test_a_motion_that_is_too_fast_by_itself_is_not_called_noise() -> None:
    fast = np.column_stack([1.5 * np.sin(4 * T), 0 * T, 0.5 * np.cos(4 * T)])
    assert suggested(fast) == ""
    buzz = np.column_stack([0.3 * np.sin(20 * T), 0.3 * np.sin(21 * T), 0.3 * np.cos(20 * T)])
    assert suggested(buzz) == ""
