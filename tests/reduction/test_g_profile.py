"""The machine's motion for a requested G: how near it is, and that it keeps every limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.seat_forms import by_closed_forms

from des_cli.errors import NotReleasedError, UsageError
from des_cli.kinematics.response import respond
from des_cli.model.machine import DHRow, Machine, Seat
from des_cli.model.machines import COVISART, DES, JOHNSVILLE
from des_cli.model.motion import DesiredMotion, Motion
from des_cli.model.profile import BodyRates, GCommand, Profile, Reduction
from des_cli.model.response import Response
from des_cli.pipeline import reduce_profile
from des_cli.reduction.desired import find_desired, require_makeable
from des_cli.reduction.limits import find_violations
from tests.support.felt_reference import Table, by_parabolas, gauss_points

FORWARD = Seat(yaw=np.radians(270))
GRADUAL = ((0, 1.4), (5, 1.4), (81, 9), (91, 9), (106.2, 1.4), (111.2, 1.4))
RAPID = ((0, 1.4), (5, 1.4), (5 + 7.6 / 6, 9), (20, 9), (20 + 7.6 / 6, 1.4), (30, 1.4))


def profile_of(requested: np.ndarray, t: np.ndarray, machine: Machine = DES, **more) -> Profile:  # type: ignore[no-untyped-def]
    seat = Seat(yaw=0.0) if machine in (JOHNSVILLE, COVISART) else FORWARD
    return Profile("g", t, GCommand(requested[:-1], requested[1:], **more), machine, seat)


def along_spine(*corners: tuple[float, float], machine: Machine = DES) -> Profile:
    """A profile of Gz with straight lines between (time, G)."""
    t = np.round(np.arange(0.0, corners[-1][0] + 0.01, 0.02), 6)
    gz = np.interp(t, *np.array(corners).T)
    return profile_of(np.column_stack([0 * t, 0 * t, gz]), t, machine)


def follow(profile: Profile) -> tuple[DesiredMotion, Response, np.ndarray]:
    """The motion inside all limits, its response, and its G less the asked one [g]."""
    found = find_desired(profile)
    assert find_violations(profile.machine, found.motion, "modified") == ()
    response = respond(profile.machine, profile.seat, found.motion)
    assert found.shortfall is not None
    np.testing.assert_allclose(
        response.seat_g + found.shortfall.seat_g, profile.command.sides, atol=1e-12
    )
    return found, response, -found.shortfall.seat_g


def reference_g(motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    """Times and G by the evaluation that shares no code, from the command table alone."""
    rate = np.append(motion.rate_start[:, 0], motion.rate_end[-1, 0])
    states = by_parabolas(Table(motion.t, rate, motion.angle[:, 1:]))
    t, _ = gauss_points(motion.t)
    return t, by_closed_forms(*states(t), FORWARD.yaw, FORWARD.pitch).g


@pytest.mark.parametrize(
    ("gz", "words"), [(0.0, "asks for no G at all, and no"), (0.5, "asks for 0.5 g at most, and")]
)
def test_less_than_gravity_throughout_is_refused_in_a_sentence_of_its_own(
    gz: float, words: str
) -> None:
    with pytest.raises(NotReleasedError, match=words):
        reduce_profile(along_spine((0, gz), (2, gz)))


def test_a_little_less_than_gravity_or_what_is_allowed_is_followed() -> None:
    require_makeable(along_spine((0, 0.95), (2, 0.95)))
    require_makeable(along_spine((0, 0.2), (2, 1.2)))
    allowed = Reduction(allow_change=1.5)
    require_makeable(replace(along_spine((0, 0.5), (2, 0.5)), reduction=allowed))


def test_gradual_onset_is_followed() -> None:
    found, _, off = follow(along_spine(*GRADUAL))
    assert np.sqrt(np.mean(off[..., 2] ** 2)) < 0.01
    assert np.abs(off).max() < 0.06
    t, g = reference_g(found.motion)
    assert np.sqrt(np.mean((g[:, 2] - np.interp(t, *np.array(GRADUAL).T)) ** 2)) < 0.01
    assert np.abs(g[:, 1]).max() < 0.05
    assert np.abs(g[:, 0]).max() < 0.05
    assert found.g_offset is not None
    assert found.g_offset.onset_made == pytest.approx(0.5, abs=0.05)


def test_in_a_rapid_onset_only_the_magnitude_lags() -> None:
    found, response, off = follow(along_spine(*RAPID))
    _, g = reference_g(found.motion)
    assert np.abs(g[:, 1]).max() < 0.05
    assert np.abs(g[:, 0]).max() < 0.12
    # the arm is at its acceleration, and makes what follows from it: dG/dt = 2 rho w w'/g
    assert np.abs(found.motion.acceleration[:, 0]).max() == pytest.approx(0.63, rel=2e-3)
    told = found.g_offset
    assert told is not None
    assert told.onset_asked == pytest.approx(6.0, rel=1e-9)
    assert 2.0 < told.onset_made < 3.5
    length = np.linalg.norm(off, axis=-1)
    assert told.largest == pytest.approx(length.max(), rel=1e-12)
    assert told.rms == pytest.approx(np.sqrt(np.mean(length**2)), rel=1e-3)
    held = (found.motion.t[:-1] > 14) & (found.motion.t[:-1] < 15)
    np.testing.assert_allclose(response.seat_g[held, 0, 2], 9.0, atol=0.1)


def test_all_components_are_followed() -> None:
    t = np.arange(0.0, 20.01, 0.02)
    requested = np.column_stack([0.4 * np.sin(t), 0.3 * np.cos(t), np.linspace(1.4, 4.0, len(t))])
    for machine in (DES, JOHNSVILLE):
        _, _, off = follow(profile_of(requested, t, machine))
        assert np.abs(off).max() < 0.01


def test_a_step_is_taken_as_fast_as_the_arm_can() -> None:
    t = np.arange(0.0, 20.01, 0.02)
    requested = np.column_stack([0 * t, 0 * t, np.where(t < 8, 1.4, 4.0)])
    found, _, off = follow(profile_of(requested, t))
    assert np.abs(off[..., :2]).max() < 0.12
    calm = (t[:-1] < 5) | (t[:-1] > 13)
    assert np.abs(off[calm]).max() < 0.02
    assert np.abs(found.motion.acceleration[:, 0]).max() > 0.6


def test_rest_is_the_least_and_the_arms_rate_the_most() -> None:
    found, response, _ = follow(along_spine((0, 0.5), (10, 0.5)))
    np.testing.assert_allclose(response.seat_g[..., 2], 1.0, atol=1e-6)
    assert found.g_offset is not None
    assert found.g_offset.rms == pytest.approx(0.5, abs=1e-6)
    found, response, _ = follow(along_spine((0, 15), (15, 30), (30, 30)))
    assert found.motion.rate[-1, 0] == pytest.approx(5.86, rel=2e-3)
    assert 20.0 < response.seat_g[-1, 1, 2] < 30.0
    assert np.abs(response.seat_g[..., :2]).max() < 0.1


def test_without_an_arm_only_the_direction_is_made() -> None:
    _, response, _ = follow(along_spine((0, 1.4), (5, 1.4), (10, 3), (20, 3), machine=COVISART))
    np.testing.assert_allclose(response.seat_g[..., 2], 1.0, atol=1e-6)


def test_less_than_gravity_on_the_way_is_passed_through() -> None:
    found, response, _ = follow(
        along_spine((0, 1.4), (5, 1.4), (7, 0.2), (9, 0.2), (11, 3), (20, 3))
    )
    assert np.abs(response.seat_g[..., :2]).max() < 0.15
    assert response.seat_g[-1, 1, 2] == pytest.approx(3.0, abs=0.02)
    assert found.g_offset is not None


def test_the_machine_starts_as_the_first_g_asks() -> None:
    found, response, _ = follow(along_spine((0, 3), (10, 3)))
    np.testing.assert_allclose(response.seat_g[0, 0], [0, 0, 3], atol=1e-3)
    assert found.motion.angle[0, 0] == pytest.approx(0.0, abs=1e-12)
    assert found.motion.rate_start[0, 0] > 2.0


def test_a_roll_rate_is_followed_at_first_and_then_gives_way() -> None:
    t = np.arange(0.0, 24.01, 0.02)
    requested = np.column_stack([0 * t, 0 * t, np.full_like(t, 2.0)])
    roll = np.radians(10.0) * np.clip((t - 5.0) / 2.0, 0.0, 1.0)
    rates = np.column_stack([roll, 0 * t, 0 * t])
    middle = 0.5 * (rates[1:] + rates[:-1])
    command = BodyRates(rates[:-1], middle, rates[1:])
    found, response, off = follow(profile_of(requested, t, rates=command, washout=3.0))
    _, still, _ = follow(profile_of(requested, t))
    added = (response.seat_rate - still.seat_rate)[:, 0, 0]
    early = (t[:-1] > 5.2) & (t[:-1] < 5.7)
    np.testing.assert_allclose(added[early], roll[:-1][early], rtol=0.25, atol=0.005)
    assert np.abs(added[-100:]).max() < 0.25 * roll[-1]
    # the seat rolled right sees the push from its left: Gy, and less of it at the end
    assert 0.1 < np.abs(off[..., 1]).max() < 1.0
    assert np.abs(off[-50:, :, 1]).max() < 0.1
    assert found.g_offset is not None
    assert found.g_offset.roll_rate_rms is not None


def test_a_direction_out_of_reach_is_made_as_near_as_gravity_lets_it() -> None:
    # with this seat Gx is along the cab's axis, where there is gravity alone
    t = np.arange(0.0, 10.01, 0.02)
    requested = np.column_stack([np.full_like(t, 2.0), 0 * t, np.full_like(t, 3.0)])
    _, response, _ = follow(profile_of(requested, t))
    held = response.seat_g[len(t) // 2, 0]
    assert held[0] == pytest.approx(1.0, abs=0.02)
    assert held[1] == pytest.approx(0.0, abs=0.1)
    assert held[2] == pytest.approx(3.0, abs=0.5)


def test_a_turn_upside_down_ends_where_it_is_asked() -> None:
    _, response, _ = follow(along_spine((0, 1.4), (5, 1.4), (7, -1.5), (15, -1.5)))
    np.testing.assert_allclose(response.seat_g[-1, 1], [0.0, 0.0, -1.5], atol=0.05)


def test_a_tilted_arm_is_refused_in_words() -> None:
    tilted = Machine("tilted", (DHRow(alpha=0.2), *DES.rows), DES.limits)
    with pytest.raises(UsageError, match="does not turn about the vertical"):
        find_desired(along_spine((0, 2), (5, 2), machine=tilted))


def test_an_asked_g_goes_through_to_a_released_run() -> None:
    run = reduce_profile(along_spine((0, 1.4), (3, 1.4), (8, 4), (12, 4)))
    run.require_release()
    assert run.metrics["asked_g"]["rms_g"] < 0.02
    assert not run.metrics["executable"]["replaced"]
    assert any("G that is asked" in notice.text for notice in run.notices)
