"""The bounds for the occupant, one by one, on values that are known."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.onset import largest_onset
from des_cli.kinematics.response import respond_on
from des_cli.model.arrays import Floats
from des_cli.model.machine import OccupantBounds, Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.verify.felt import Attitudes, Felt, SeatChain
from des_cli.verify.occupant import TOGETHER, check_occupant, excesses, largest_onsets, steepness
from tests.support.claims import failing, values_of
from tests.support.free_case import Case, with_rates

T = np.linspace(0.0, 1.0, 6)
STATES = 10
COMPONENTS = ("gx", "gy", "gz")


def table(t: Floats = T) -> Motion:
    return with_rates(t, np.zeros(3), np.zeros((len(t), 3)))


def felt_of(**fields: Floats) -> Felt:
    """What is felt where only some of it is anything."""
    m = next(iter(fields.values())).shape[1]
    zero = np.zeros((3, m))
    rest: dict[str, Any] = dict.fromkeys(("rate", "cross", "turning", "g"), zero)
    attitudes = Attitudes(SeatChain(DES, Seat()), np.zeros((m, 3)))
    return Felt(**{**rest, "attitudes": attitudes, **fields})


def g_at(component: int, state: int, value: float) -> Felt:
    g = np.zeros((3, STATES))
    g[component, state] = value
    return felt_of(g=g)


def onset_of(t: Floats, g: Floats) -> Floats:
    """The onset [g/s] at the states of a component of G at both sides, (2 (n - 1),)."""
    values = np.zeros((3, len(g)))
    values[1] = g
    bound = 1.0
    ((key, _, excess),) = excesses(OccupantBounds(g_onset=bound), table(t), felt_of(g=values))
    assert key == "onset"
    return excess + bound


@pytest.mark.parametrize("component", [0, 1, 2])
@pytest.mark.parametrize("state", [0, 4, 5, 9])
@pytest.mark.parametrize("bound", [0.5, 2.0, 8.0])
def test_a_component_of_g_is_between_its_least_and_most(
    component: int, state: int, bound: float
) -> None:
    name = COMPONENTS[component]
    for excess, broken in ((-1e-3, False), (5e-10, False), (2e-9, True), (0.25, True)):
        value = bound + excess * max(1.0, bound)
        for sign, interval in ((1.0, (-np.inf, bound)), (-1.0, (-bound, np.inf))):
            bounds = OccupantBounds(**{name: interval})
            checks = check_occupant(bounds, table(), g_at(component, state, sign * value))
            assert values_of(checks) == {f"occupant.{name}": pytest.approx(excess, abs=1e-15)}
            assert failing(checks) == ({f"occupant.{name}"} if broken else set())
            assert (
                failing(check_occupant(bounds, table(), g_at(component, state, -value * sign)))
                == set()
            )


def test_both_bounds_of_a_component_hold_together() -> None:
    # at rest Gz is 1: it may be from 0.5 to 3
    bounds = OccupantBounds(gz=(0.5, 3.0))
    for value, excess in ((1.0, -0.5), (3.3, 0.1), (0.2, 0.3)):
        g = np.zeros((3, STATES))
        g[2] = value
        checks = check_occupant(bounds, table(), felt_of(g=g))
        assert values_of(checks) == {"occupant.gz": pytest.approx(excess)}


def test_excesses_are_those_of_each_state() -> None:
    g = np.zeros((3, STATES))
    g[2] = np.linspace(-1.0, 1.25, STATES)
    ((key, name, excess),) = excesses(OccupantBounds(gz=(-0.5, 0.5)), table(), felt_of(g=g))
    assert (key, name) == ("gz", "Gz")
    np.testing.assert_allclose(excess, np.abs(g[2]) - 0.5, atol=1e-15)


def test_a_least_value_above_zero_is_a_bound_too() -> None:
    for value, excess in ((3.0, -0.5), (1.0, 0.5)):
        g = np.full((3, STATES), value)
        for bounds in (OccupantBounds(gx=(2.0, np.inf)), OccupantBounds(gx=(2.0, 9.0))):
            (check,) = check_occupant(bounds, table(), felt_of(g=g))
            assert check.value == pytest.approx(excess)


def test_a_bound_is_on_its_own_component() -> None:
    g = np.outer([1.0, 2.0, 3.0], np.ones(STATES))
    bounds = OccupantBounds(gx=(-9.0, 1.5), gy=(-9.0, 1.5), gz=(-9.0, 1.5))
    assert failing(check_occupant(bounds, table(), felt_of(g=g))) == {"occupant.gy", "occupant.gz"}


def test_what_is_not_bounded_is_not_measured() -> None:
    felt = felt_of(g=np.full((3, STATES), 50.0), turning=np.full((3, STATES), 50.0))
    assert check_occupant(OccupantBounds(), table(), felt) == []


@pytest.mark.parametrize("bound", [0.5, 4.0])
@pytest.mark.parametrize("state", [0, 9])
def test_the_size_of_the_angular_acceleration_is_bounded(bound: float, state: int) -> None:
    bounds = OccupantBounds(angular_acceleration=bound)
    for excess, broken in ((5e-10, False), (2e-9, True)):
        turning = np.zeros((3, STATES))
        size = bound + excess * max(1.0, bound)
        turning[:, state] = size * np.array([2.0, -3.0, 6.0]) / 7.0
        checks = check_occupant(bounds, table(), felt_of(turning=turning))
        assert failing(checks) == ({"occupant.angular_acceleration"} if broken else set())


@pytest.mark.parametrize("component", [0, 1, 2])
@pytest.mark.parametrize("bound", [0.4, 4.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_onset_of_each_component_is_bounded(component: int, bound: float, sign: float) -> None:
    for excess, broken in ((-1e-8, False), (1e-8, True)):
        slope = bound + excess * max(1.0, bound)
        g = np.zeros((3, STATES))
        g[component] = sign * slope * np.concatenate([T[:-1], T[1:]])
        checks = check_occupant(OccupantBounds(g_onset=bound), table(), felt_of(g=g))
        assert failing(checks) == ({"occupant.onset"} if broken else set())


@pytest.mark.parametrize("at", [0, 1, 2, 3, 4])
def test_a_jump_at_a_sample_is_an_onset_over_a_tenth_of_a_second(at: int) -> None:
    # G is 0.05 g more in one interval: it jumps at either side, but at the motion's ends
    g = np.zeros(STATES)
    g[[at, at + 5]] = 0.05
    onset = onset_of(T, g)
    assert np.max(onset) == pytest.approx(0.5)
    beside = {at, at - 1 + STATES // 2} if at > 0 else set()
    beside |= {at + STATES // 2, at + 1} if at < 4 else set()
    assert set(np.flatnonzero(onset > 0.25)) == beside


def test_onset_is_over_a_tenth_of_a_second_whatever_the_steps() -> None:
    # a ramp of 3 g/s, with a step of 0.01 g at a sample beside which another is very near
    t = np.array([0.0, 0.1, 0.2, 0.20001, 0.3, 0.4])
    g = 3.0 * np.concatenate([t[:-1], t[1:]])
    g[3:5] += 0.01
    g[7:] += 0.01
    onset = onset_of(t, g)
    assert np.max(onset) == pytest.approx(3.1, abs=1e-6)
    assert np.min(onset) == pytest.approx(3.0, abs=1e-6)


def test_a_change_that_goes_back_within_the_window_is_less_of_an_onset() -> None:
    # a peak of 0.1 g, up in 0.02 s and down in 0.02 s: 5 g/s, and 1 g/s over a tenth
    t = np.array([0.0, 0.2, 0.22, 0.24, 0.5])
    g = np.array([0.0, 0.0, 0.1, 0.0])
    onset = onset_of(t, np.concatenate([g, [0.0, 0.1, 0.0, 0.0]]))
    assert np.max(onset) == pytest.approx(1.0)


@pytest.mark.parametrize("length", [0.04, 0.1])
@pytest.mark.parametrize("begin", [0.0, 3.7])
def test_a_motion_that_is_not_longer_than_the_window_is_one_window(
    length: float, begin: float
) -> None:
    # the kinematics' onset has it so too
    t = begin + np.linspace(0.0, length, 3)
    onset = onset_of(t, np.array([0.0, 0.1, 0.1, 0.2]))
    np.testing.assert_allclose(onset[[0, -1]], 0.2 / length, rtol=1e-6)
    assert np.max(onset) == pytest.approx(onset[0])
    assert np.max(onset_of(t, np.array([0.0, -0.1, -0.3, -0.1]))) == pytest.approx(0.1 / length)


def test_the_slope_within_an_interval_is_that_of_its_samples() -> None:
    # by 0.2, -0.4, 0 and 1 g in steps of 0.1, 0.1, 0.3 and 0.5 s; of the other side nothing
    t = np.array([0.0, 0.1, 0.2, 0.5, 1.0])
    g = np.zeros((3, 8))
    g[1] = [0.0, 0.2, -0.2, -0.2, 9.0, 9.0, 9.0, 0.8]
    for bound, unit in ((0.5, 1.0), (2.0, 2.0)):
        expected = (np.array([2.0, 4.0, 0.0, 2.0]) - bound) / unit
        found = steepness(OccupantBounds(g_onset=bound), table(t), felt_of(g=g))
        np.testing.assert_allclose(found, expected, atol=1e-12)


@pytest.mark.parametrize("component", [0, 1, 2])
@pytest.mark.parametrize("side", ["least", "most"])
def test_a_component_of_an_optimums_g_beyond_its_bound(
    case: Case, component: int, side: str
) -> None:
    key, name = f"occupant.{COMPONENTS[component]}", COMPONENTS[component]
    chain = chain_of(DES, case.seat)
    values = respond_on(chain, DES.gravity, case.solution.modified).seat_g[..., component]
    for slack, broken in ((1e-6, False), (-1e-6, True)):
        bounds = (-np.inf, float(values.max()) + slack)
        if side == "least":
            bounds = (float(values.min()) - slack, np.inf)
        machine = replace(DES, occupant=OccupantBounds(**{name: bounds}))
        assert (key in case.failed(machine=machine)) is broken
        assert key not in {c.key for c in case.checks(machine=machine, limits="check")}


def test_onset_and_angular_acceleration_of_an_optimum_beyond_their_bounds(case: Case) -> None:
    motion = case.solution.modified
    response = respond_on(chain_of(DES, case.seat), DES.gravity, motion)
    onset = float(np.max(largest_onset(motion.t, response.seat_g)))
    turning = float(np.max(np.linalg.norm(response.seat_angular_acceleration, axis=-1)))
    for share, broken in ((1.0 + 1e-6, False), (1.0 - 1e-6, True)):
        for key, bounds in (
            ("occupant.onset", OccupantBounds(g_onset=share * onset)),
            (
                "occupant.angular_acceleration",
                OccupantBounds(angular_acceleration=share * turning),
            ),
        ):
            assert (key in case.failed(machine=replace(DES, occupant=bounds))) is broken


def test_the_onset_of_a_motion_longer_than_what_is_measured_at_once() -> None:
    """By the program's own measure, on uneven steps with a jump at every sample."""
    draw = np.random.default_rng(9)
    t = np.cumsum(draw.uniform(0.5e-3, 1.5e-3, 2 * TOGETHER + 5))
    sides = np.sin(7.0 * t)[:-1, None, None] + 0.01 * draw.normal(size=(len(t) - 1, 2, 3))
    felt = felt_of(g=np.concatenate([sides[:, 0], sides[:, 1]]).T)
    found = largest_onsets(table(t), felt)
    np.testing.assert_allclose(found, largest_onset(t, sides), rtol=1e-12)


@pytest.mark.parametrize("together", [1, 3, 50])
def test_where_the_largest_onset_is_looked_for_is_where_it_is(
    together: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The largest of all states, of records that jump and that do not."""
    monkeypatch.setattr("des_cli.verify.occupant.TOGETHER", together)
    for seed in range(8):
        draw = np.random.default_rng(seed)
        t = np.cumsum(draw.choice([0.001, 0.01, 0.04], 150))
        jumps = draw.normal(size=(3, 298)) * draw.choice([0.0, 0.1, 1.0], (1, 298))
        g = np.sin(3.0 * np.concatenate([t[:-1], t[1:]])) + jumps
        ((_, _, excess),) = excesses(OccupantBounds(g_onset=1.0), table(t), felt_of(g=g))
        found = largest_onsets(table(t), felt_of(g=g))
        assert np.max(found) - 1.0 == np.max(excess)
        sides = np.stack([g[:, :149].T, g[:, 149:].T], axis=1)
        np.testing.assert_allclose(found, largest_onset(t, sides), rtol=1e-12)
