"""Test directions are motions of a table, and keep clear of what holds the solution."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machines import DES
from des_cli.model.profile import Reduction
from des_cli.verify.budgets import integrand
from des_cli.verify.claim import Claim
from des_cli.verify.directions import FEWEST, SHORTEST, find_directions
from des_cli.verify.felt import SeatChain
from des_cli.verify.slopes import STEP, slopes_along, slopes_by_seat
from tests.reduction.conftest import make_cobra, make_wave
from tests.support.claims import profile_of

WAVE = make_wave(
    [[0.6, 0.1, 0.05], [0.0, 0.3, -0.1], [0.1, -0.2, 0.15]], intervals=240, duration=8.0
)


def claim_of(motion, *, requested=None, machine=DES, **options):
    profile = profile_of(motion, Reduction(budget=(), **options), machine)

    class Found:
        modified = motion
        control = np.zeros((len(motion.t), 0))

    return Claim(profile, requested or motion, motion, profile.seat, Found)


@pytest.mark.parametrize("ends", ["free", "match-start", "match-rates", "match-both"])
@pytest.mark.parametrize("starts", [(), ("fork_start",)])
def test_directions_keep_the_ends_and_integrate(ends, starts):
    t = WAVE.t
    directions = find_directions(claim_of(WAVE, ends=ends, limits="warn", optimise=starts))
    assert {d.joint for d in directions} == {0, 1, 2}
    for d in directions:
        time = t[d.first : d.first + len(d.rate)]
        assert len(time) > FEWEST
        assert np.ptp(time) >= 0.99 * SHORTEST
        rise = np.cumsum(0.5 * np.diff(time) * (d.rate[:-1] + d.rate[1:]))
        np.testing.assert_allclose(d.angle - d.angle[0], [0.0, *rise], atol=1e-15)
        begins, stops = time[0] == t[0], time[-1] == t[-1]
        starts_free = begins and starts and d.joint == 1
        assert abs(d.angle[0]) < 1e-12 or starts_free
        assert abs(d.angle[-1]) < 1e-12 or (stops and ends != "match-both")
        assert abs(d.rate[0]) < 1e-12 or (begins and ends == "free")
        assert abs(d.rate[-1]) < 1e-12 or (stops and ends in ("free", "match-start"))
    moved = [
        (any(abs(d.rate[0]) > 0.1 for d in directions), ends == "free"),
        (any(abs(d.angle[0]) > 0.1 for d in directions), bool(starts)),
        (any(abs(d.rate[-1]) > 0.1 for d in directions), ends in ("free", "match-start")),
        (any(abs(d.angle[-1]) > 0.1 for d in directions), ends != "match-both"),
    ]
    assert [found for found, _ in moved] == [expected for _, expected in moved]


def test_directions_keep_clear_of_a_limit_and_of_held_joints():
    peak = float(np.max(np.abs(WAVE.acceleration[:, 1])))
    fork = replace(DES.limits[1], acceleration=peak, jerk=np.inf)
    machine = replace(DES, limits=(DES.limits[0], fork, DES.limits[2]))
    claim = claim_of(WAVE, machine=machine, hold=frozenset({"arm"}), limits="enforce")
    directions = find_directions(claim)
    assert {d.joint for d in directions} == {1, 2}
    tight = np.abs(WAVE.acceleration[:, 1]) > 0.99 * peak
    assert tight.any()
    for d in directions:
        if d.joint == 1:
            assert not tight[d.first : d.first + len(d.rate) - 1].any()


def test_directions_per_joint_keep_clear_of_standstill():
    motion = make_cobra(250)
    directions = find_directions(claim_of(motion, control="per-joint", limits="warn"))
    for d in directions:
        rate = motion.rate[d.first : d.first + len(d.rate), d.joint]
        assert np.all(np.sign(rate) == np.sign(rate[0]))
        assert np.all(np.abs(rate) > 1e-9)


@pytest.mark.parametrize("metric", ["seat_g_rms_error_g", "joint_deviation_relative"])
def test_slopes_are_those_of_the_whole_integral(metric):
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


def test_long_windows_are_sampled():
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


def test_the_slope_by_a_seat_angle():
    claim = claim_of(WAVE, limits="warn")
    functions = [lambda felt, before: felt.g[2]]
    found = slopes_by_seat(claim, WAVE, claim.chain, "pitch", functions)
    seat, h = claim.seat, 1e-6
    ahead, behind = (
        claim.weight @ SeatChain(DES, replace(seat, pitch=seat.pitch + s)).along(WAVE).g[2]
        for s in (h, -h)
    )
    assert found[0, 0] == pytest.approx((ahead - behind) / (2.0 * h), rel=1e-6)
