"""Slopes along directions are those of the whole integral, whatever part of it is evaluated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.verify.budgets import integrand
from des_cli.verify.directions import Direction, find_directions
from des_cli.verify.felt import Felt, SeatChain
from des_cli.verify.slopes import STEP, Sampled, slopes_along, slopes_by_seat
from tests.reduction.conftest import make_wave
from tests.support.claims import claim_of

WAVE = make_wave(
    [[0.6, 0.1, 0.05], [0.0, 0.3, -0.1], [0.1, -0.2, 0.15]], intervals=240, duration=8.0
)


@pytest.mark.parametrize("metric", ["seat_g_rms_error_g", "joint_deviation_relative"])
def test_slopes_are_those_of_the_whole_integral(metric: str) -> None:
    requested = make_wave([[0.6, 0.1], [0.0, 0.3], [0.1, -0.2]], intervals=240, duration=8.0)
    claim = claim_of(WAVE, requested=requested, ends="free", limits="warn")
    directions = find_directions(claim)
    functions = [
        lambda felt, before: np.sum(felt.cross**2, axis=0),
        lambda felt, before: integrand(metric, felt, before),
    ]
    found = slopes_along(claim, WAVE, claim.chain, directions, functions)
    for slopes, d in zip(found, directions, strict=True):
        values = []
        for sign in (STEP, -STEP):
            angle, rate = WAVE.angle.copy(), np.vstack([WAVE.rate_start, WAVE.rate_end[-1:]])
            at = slice(d.first, d.first + len(d.rate))
            angle[at, d.joint] += sign * d.angle
            rate[at, d.joint] += sign * d.rate
            moved = replace(WAVE, angle=angle, rate_start=rate[:-1], rate_end=rate[1:])
            felt = claim.chain.along(moved)
            values.append([claim.weight @ f(felt, claim.before) for f in functions])
        whole = np.subtract(*values) / (2.0 * STEP)
        np.testing.assert_allclose(slopes, whole, rtol=1e-6, atol=1e-9)


def test_long_windows_are_sampled() -> None:
    fine = make_wave([[0.6, 0.1], [0.0, 0.3], [0.1, -0.2]], intervals=9600, duration=8.0)
    coarse = make_wave([[0.6, 0.1], [0.0, 0.3], [0.1, -0.2]], intervals=960, duration=8.0)
    functions = [lambda felt, before: np.sum(felt.cross**2, axis=0)]
    found = []
    for motion in (coarse, fine):
        claim = claim_of(motion, ends="match-both", limits="warn")
        directions = sorted(
            find_directions(claim),
            key=lambda d: (d.joint, round(len(d.rate) * 8.0 / len(claim.weight), 1), d.first),
        )
        assert max(len(d.sampled) for d in directions) <= 256
        found.append(slopes_along(claim, motion, claim.chain, directions, functions))
    scale = np.max(np.abs(found[0]))
    np.testing.assert_allclose(found[0], found[1], rtol=0, atol=5e-3 * scale)


@pytest.mark.parametrize("angle", ["yaw", "pitch"])
def test_the_slope_by_a_seat_angle(angle: str) -> None:
    requested = make_wave([[0.6, 0.1], [0.0, 0.3], [0.1, -0.2]], intervals=240, duration=8.0)
    claim = claim_of(WAVE, requested=requested, limits="warn")
    functions = [lambda felt, before: felt.g[1], lambda felt, before: (felt.g - before.g)[2] ** 2]
    fixed = Seat(0.2, -0.3)
    found = slopes_by_seat(claim, WAVE, SeatChain(DES, fixed), angle, functions)
    h = 1e-5
    ahead, behind = (
        SeatChain(DES, replace(fixed, **{angle: getattr(fixed, angle) + s})).along(WAVE).g
        for s in (h, -h)
    )
    expected = [
        claim.weight @ (ahead - behind)[1],
        claim.weight @ ((ahead - claim.before.g) ** 2 - (behind - claim.before.g) ** 2)[2],
    ]
    assert found.shape == (1, 2)
    np.testing.assert_allclose(found[0], np.array(expected) / (2.0 * h), rtol=1e-6, atol=1e-9)
    assert np.max(np.abs(found)) > 0.1


def still(felt: Felt, before: Felt) -> np.ndarray:
    return np.sum(felt.angle**2, axis=0)


def off(felt: Felt, before: Felt) -> np.ndarray:
    return np.sum((felt.angle - before.angle) ** 2, axis=0)


def test_the_slope_of_a_polynomial_by_hand_on_uneven_steps() -> None:
    # the cab's angle rises by (0, 0, 1, 1) on the steps 0.2, 0.1, 0.3: by 2 angle times that,
    # the trapezoidal rule's weights of the four samples are 0.1, 0.15, 0.2 and 0.15
    t = np.array([0.0, 0.5, 0.7, 0.8, 1.1, 2.0])
    angle = np.array([[0.1, 0.2, a] for a in (0.3, 1.0, 2.0, 4.0, 5.0, 7.0)])
    motion = replace(make_wave([[0.1], [0.1], [0.1]], intervals=5), t=t, angle=angle)
    requested = replace(motion, angle=angle - 0.5)
    claim = claim_of(motion, requested=requested)
    direction = Direction(2, 1, np.zeros(4), np.array([0.0, 0.0, 1.0, 1.0]))
    other = Direction(1, 0, np.zeros(2), np.array([1.0, 0.0]))
    found = slopes_along(claim, motion, claim.chain, [direction, other], [still, off])
    np.testing.assert_allclose(found[0], [0.2 * 8.0 + 0.15 * 10.0, 0.2 + 0.15], rtol=1e-9)
    np.testing.assert_allclose(found[1], [0.25 * 0.4, 0.25], rtol=1e-9)


def test_intervals_that_are_left_out_are_stood_for_by_the_others() -> None:
    step = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    rate = np.array([0.0, 1.0, 3.0, 6.0, 10.0])
    at = Sampled.of([Direction(1, 1, rate, 2.0 * rate, most=2)], step)
    np.testing.assert_array_equal(at.interval, [1, 3])
    np.testing.assert_allclose(np.sum(2.0 * at.weight), np.sum(step[1:5]))
    assert at.weight[1] / at.weight[0] == pytest.approx(2.0)
    np.testing.assert_array_equal(at.rate, [0.0, 3.0, 1.0, 6.0])
    np.testing.assert_array_equal(at.angle, 2.0 * at.rate)
    np.testing.assert_allclose(at.acceleration, [5.0, 7.5] * 2)


def test_a_rates_change_is_an_acceleration_too() -> None:
    # the arm alone, from rest: all that its seat turns by is the arm's acceleration
    t = np.linspace(0.0, 1.0, 6)
    motion = replace(make_wave([[0.0], [0.0], [0.0]], intervals=5, duration=1.0), t=t)
    claim = claim_of(motion)

    def upward(felt: Felt, before: Felt) -> np.ndarray:
        return np.sum(felt.rotation[2] * felt.turning, axis=0)

    # one interval of 0.2 s with the rate from 0 to 1, and then one back; it turns clockwise
    rise = Direction(0, 2, np.array([0.0, 1.0]), np.array([0.0, 0.1]))
    both = Direction(0, 2, np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.1, 0.2]))
    found = slopes_along(claim, motion, claim.chain, [rise, both], [upward])
    np.testing.assert_allclose(found, [[-1.0], [0.0]], atol=1e-9)


def test_no_directions_have_no_slopes() -> None:
    claim = claim_of(WAVE)
    assert slopes_along(claim, WAVE, claim.chain, [], [still, off]).shape == (0, 2)
