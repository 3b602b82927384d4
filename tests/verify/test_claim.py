"""A claim's motions: which one is felt by which seat, and what round what is measured."""

from __future__ import annotations

import gc
import weakref
from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.response import respond
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion, Record, Shortfall
from des_cli.model.profile import BodyRates, LimitsPolicy
from des_cli.verify.felt import Felt
from tests.reduction.conftest import make_uneven, make_wave
from tests.support.claims import claim_of
from tests.support.free_case import with_rates

MODIFIED = make_wave([[0.6, 0.1], [0.1, 0.3], [0.1, -0.2]])
REQUESTED = make_wave([[0.5, 0.1], [0.1, 0.2], [0.0, -0.2]])
DESIRED = make_wave([[0.5, 0.0], [0.1, 0.1], [0.0, -0.1]])
SEAT = Seat(0.4, -0.3)


def shortfall(n: int, seed: int = 1) -> Shortfall:
    draw = np.random.default_rng(seed)
    return Shortfall(*draw.normal(size=(3, n - 1, 2, 3)), draw.normal(size=(n, 3)))


def assert_felt(felt: Felt, motion: Motion, seat: Seat) -> None:
    """By the program's own kinematics."""
    other = respond(DES, seat, motion)
    for found, expected in ((felt.rate, other.seat_rate), (felt.g, other.seat_g)):
        sides = np.stack(np.split(found.T, 2), axis=1)
        np.testing.assert_allclose(sides, expected, rtol=0, atol=1e-12)


def test_each_motion_is_felt_in_its_own_seat() -> None:
    claim = replace(claim_of(MODIFIED, requested=REQUESTED, desired=DESIRED), seat=SEAT)
    assert_felt(claim.before, REQUESTED, Seat())
    assert_felt(claim.executable, DESIRED, Seat())
    assert_felt(claim.after, MODIFIED, SEAT)


def test_the_executable_motion_lacks_what_the_joints_do_not_make() -> None:
    n = len(MODIFIED.t)
    missing = shortfall(n)
    claim = claim_of(MODIFIED, requested=REQUESTED, further={"shortfall": missing})
    made = claim_of(MODIFIED, requested=REQUESTED)
    assert made.executable is made.before
    np.testing.assert_array_equal(claim.executable.g, made.before.g)
    g = np.concatenate([missing.seat_g[:, 0], missing.seat_g[:, 1]]).T
    np.testing.assert_allclose(claim.before.g - made.before.g, g, atol=1e-12)


def test_recorded_rates_are_asked_for_where_the_profile_has_them() -> None:
    n = len(MODIFIED.t)
    rates = np.random.default_rng(4).normal(size=(3, n - 1, 3))
    claim = claim_of(MODIFIED, requested=REQUESTED, further={"shortfall": shortfall(n)})
    claim = replace(claim, profile=replace(claim.profile, command=BodyRates(*rates)))
    np.testing.assert_array_equal(claim.before.rate[:, : n - 1].T, rates[0])
    np.testing.assert_array_equal(claim.before.rate[:, n - 1 :].T, rates[2])
    other = replace(claim, from_profile=False)
    assert not np.allclose(other.before.rate, claim.before.rate)


def test_what_was_reduced_takes_the_place_of_the_record() -> None:
    n = len(MODIFIED.t)
    own, held = shortfall(n), shortfall(n, seed=2)
    claim = claim_of(MODIFIED, requested=REQUESTED, further={"shortfall": own})
    for same in (claim, replace(claim, held=Record(REQUESTED, own))):
        assert same.reduced is same
    for other in (Record(DESIRED, held), Record(REQUESTED, held), Record(DESIRED, own)):
        reduced = replace(claim, held=other).reduced
        assert reduced.requested is other.motion
        assert reduced.shortfall is other.shortfall
        assert not reduced.from_profile
        assert reduced.solution is claim.solution
        assert reduced.profile is claim.profile


def test_the_table_is_the_modified_motion_unless_it_has_leads() -> None:
    claim = claim_of(MODIFIED, requested=REQUESTED)
    assert claim.table is claim.modified is MODIFIED
    assert replace(claim, commands=DESIRED).table is DESIRED


@pytest.mark.parametrize(
    ("limits", "enforced"), [("enforce", True), ("check", False), ("warn", False)]
)
def test_limits_are_enforced_where_the_reduction_says_so(
    limits: LimitsPolicy, enforced: bool
) -> None:
    assert claim_of(MODIFIED, limits=limits).enforced is enforced


def test_weights_integrate_what_is_linear_between_samples() -> None:
    motion = make_uneven()
    claim = claim_of(motion)
    assert claim.duration == pytest.approx(motion.t[-1] - motion.t[0])
    assert np.sum(claim.weight) == pytest.approx(claim.duration)
    states = np.concatenate([motion.t[:-1], motion.t[1:]])
    square = 0.5 * (motion.t[-1] ** 2 - motion.t[0] ** 2)
    assert claim.weight @ states == pytest.approx(square)


@pytest.mark.parametrize(("samples", "rough"), [(24, True), (26, False)])
def test_waves_of_few_samples_are_rough(samples: int, rough: bool) -> None:
    # the boundary is at a wave of 2 pi / sqrt(2 sqrt(1e-3)), or 25 samples
    t = 0.01 * np.arange(8 * samples + 1)
    rate = np.zeros((len(t), 3))
    rate[:, 0] = np.sin(2.0 * np.pi * np.arange(len(t)) / samples)
    claim = claim_of(with_rates(t, np.zeros(3), rate))
    assert claim.rough is rough


def test_two_samples_are_never_rough() -> None:
    rate = np.outer([1.0, -1.0], np.ones(3))
    assert not claim_of(with_rates(np.array([0.0, 1.0]), np.zeros(3), rate)).rough
    rate = np.outer([1.0, -1.0, 1.0], np.ones(3))
    assert claim_of(with_rates(np.array([0.0, 1.0, 2.0]), np.zeros(3), rate)).rough


@pytest.mark.parametrize("at", [1, 40, 79])
def test_one_sample_that_is_off_is_rough(at: int) -> None:
    t = 0.01 * np.arange(81)
    rate = np.ones((81, 3))
    for off, rough in ((0.1, False), (0.5, True)):
        moved = rate.copy()
        moved[at, 0] += off
        assert claim_of(with_rates(t, np.zeros(3), moved * [1.0, 0.0, 0.0])).rough is rough


def test_a_claim_that_is_done_with_holds_nothing() -> None:
    """What is felt of long motions is let go at once, and not when garbage is collected."""
    claim = claim_of(MODIFIED, requested=REQUESTED)
    assert claim.reduced is claim
    felt = weakref.ref(claim.after)
    gc.disable()
    try:
        del claim
        assert felt() is None
    finally:
        gc.enable()
