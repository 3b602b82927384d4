"""Test directions are motions of a table, and keep clear of what holds the solution."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machines import DES
from des_cli.verify.directions import FEWEST, SHORTEST, find_directions
from tests.reduction.conftest import make_cobra, make_wave
from tests.support.claims import claim_of

WAVE = make_wave(
    [[0.6, 0.1, 0.05], [0.0, 0.3, -0.1], [0.1, -0.2, 0.15]], intervals=240, duration=8.0
)


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
