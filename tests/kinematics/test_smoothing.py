"""Smoothing against the Butterworth's closed form, and on what it must leave alone."""

from __future__ import annotations

import math

import numpy as np
import pytest

from des_cli.kinematics.smoothing import smooth_command, smooth_samples, why_not_smooth
from des_cli.model.profile import BodyRates, JointCommands

STEP, CUTOFF = 0.02, 2.0
T = np.arange(1001) * STEP + 100.0
UNEVEN = np.sort(np.concatenate([T, T[::7] + 0.003]))


@pytest.mark.parametrize("t", [T, UNEVEN, T[:51]], ids=["even", "uneven", "short"])
def test_a_constant_stays_a_constant_and_a_ramp_a_ramp(t: np.ndarray) -> None:
    since = t - t[0]
    values = np.column_stack([np.full(len(t), 3.0), 5.0 - 2.0 * since])
    value, middle, slope = smooth_samples(t, values, CUTOFF)
    np.testing.assert_allclose(value, values, atol=1e-11)
    np.testing.assert_allclose(middle, 0.5 * (values[:-1] + values[1:]), atol=1e-11)
    np.testing.assert_allclose(slope, np.broadcast_to([0.0, -2.0], values.shape), atol=1e-8)


@pytest.mark.parametrize("frequency", [0.2, 1.0, 2.0, 3.0, 8.0])
def test_the_gain_is_the_butterworth_s_twice_and_nothing_is_delayed(frequency: float) -> None:
    wave = np.exp(2j * np.pi * frequency * T)
    value, _, _ = smooth_samples(T, np.column_stack([wave.real, wave.imag]), CUTOFF)
    gain = (value[:, 0] + 1j * value[:, 1]) / wave
    # |H|^2 of order 4, with the bilinear transform's warping of frequencies
    warped = math.tan(math.pi * frequency * STEP) / math.tan(math.pi * CUTOFF * STEP)
    middle = gain[300:-300]
    np.testing.assert_allclose(middle, 1.0 / (1.0 + warped**8), atol=2e-5)


def test_slow_motion_keeps_its_ends() -> None:
    values = np.sin(2 * np.pi * 0.25 * T + np.arange(6)[:, None]).T
    value, _, slope = smooth_samples(T, values, CUTOFF)
    assert np.max(np.abs(value - values)) < 0.01
    rate = 2 * np.pi * 0.25 * np.cos(2 * np.pi * 0.25 * T + np.arange(6)[:, None]).T
    assert np.max(np.abs(slope - rate)[25:-25]) < 0.01


def test_the_noise_of_the_first_sample_moves_the_first_value_by_less_than_half() -> None:
    spike = np.zeros((len(T), 1))
    spike[0] = 1.0
    value, _, _ = smooth_samples(T, spike, CUTOFF)
    assert abs(value[0, 0]) < 0.5
    assert np.max(np.abs(value[50:])) < 0.05


def test_uneven_samples_of_a_slow_motion_are_those_of_even_ones() -> None:
    def of(t: np.ndarray) -> np.ndarray:
        return smooth_samples(t, np.sin(2 * np.pi * 0.5 * (t - 100.0))[:, None], CUTOFF)[0][:, 0]

    both = np.isin(UNEVEN, T)
    assert np.max(np.abs(of(UNEVEN)[both] - of(T))) < 1e-3


def test_joint_commands_move_as_their_smoothed_positions() -> None:
    rng = np.random.default_rng(1)
    slow = np.sin(0.5 * (T - 100.0))
    position = np.column_stack([slow, 0.5 * slow]) + 1e-3 * rng.normal(size=(len(T), 2))
    rate = np.gradient(position, T, axis=0)
    found = smooth_command(T, JointCommands(slow, position, rate[:-1], rate[1:]), CUTOFF)
    assert isinstance(found, JointCommands)
    np.testing.assert_allclose(found.arm_rate, slow, atol=1e-3)
    chord = np.diff(found.position, axis=0) / STEP
    np.testing.assert_allclose(0.5 * (found.rate_start + found.rate_end), chord, atol=2e-4)
    np.testing.assert_array_equal(found.rate_end[:-1], found.rate_start[1:])
    # twenty-five times a second that noise is rates of 0.05 rad/s
    want = 0.5 * np.cos(0.5 * (T - 100.0))[100:-100]
    assert np.std(rate[100:-100, 0] - want) > 0.03
    assert np.std(found.rate_start[100:-99, 0] - want) < 0.005


def test_body_rates_are_smoothed_between_samples_too_and_keep_the_recorded_attitude() -> None:
    wave = 0.3 * np.sin(2 * np.pi * 0.5 * (T - 100.0)) + 0.1 * np.sin(2 * np.pi * 12 * T)
    rates = np.column_stack([wave, 2 * wave, 0 * wave])
    attitude = np.tile([1.0, 0, 0, 0], (len(T), 1))
    command = BodyRates(rates[:-1], 0.5 * (rates[:-1] + rates[1:]), rates[1:], attitude)
    found = smooth_command(T, command, CUTOFF)
    assert isinstance(found, BodyRates)
    middle = 0.5 * (T[:-1] + T[1:]) - 100.0
    want = 0.3 * np.sin(2 * np.pi * 0.5 * middle)
    np.testing.assert_allclose(found.middle[60:-60, 0], want[60:-60], atol=1e-4)
    np.testing.assert_array_equal(found.end[:-1], found.start[1:])
    np.testing.assert_array_equal(found.attitude, attitude)


def test_an_infinite_cutoff_changes_nothing() -> None:
    command = BodyRates(np.ones((1, 3)), np.ones((1, 3)), np.ones((1, 3)))
    assert smooth_command(T[:2], command, math.inf) is command


@pytest.mark.parametrize(
    ("t", "cutoff", "words"),
    [
        (T, 25.0, "25 Hz is not below 25 Hz, the fastest that samples 0.02 s apart can tell"),
        (T[:50], 2.0, "needs a record of 1 s or more and this one has 0.98 s; give a cutoff of"),
        (np.append(T, 1e6), 2.0, "close its gaps first"),
    ],
)
def test_what_cannot_be_smoothed_is_said_and_refused(
    t: np.ndarray, cutoff: float, words: str
) -> None:
    assert words in why_not_smooth(t, cutoff)
    with pytest.raises(ValueError, match=words.split()[-1]):
        smooth_samples(t, np.zeros((len(t), 1)), cutoff)


def test_what_can_be_smoothed_has_no_sentence() -> None:
    assert why_not_smooth(T, 24.9) == why_not_smooth(T[:51], 2.0) == ""


def test_it_is_the_grid_that_must_tell_the_cutoff() -> None:
    """The usual step is shorter than the uniform grid's, on which the cutoff is just too fast."""
    step = np.full(40, 0.2499)
    step[-6:] = 0.251
    t = np.concatenate([[0.0], np.cumsum(step)])
    assert 0.5 / np.median(step) > 2.0 > 0.5 / np.mean(step)
    assert why_not_smooth(t, 2.0).startswith("2 Hz is not below 1.999 Hz")
    smooth_samples(t, np.sin(t)[:, None], 1.99)
