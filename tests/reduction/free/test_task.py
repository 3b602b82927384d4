"""What a free motion is to be: what a task takes of a profile, and what it becomes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from des_cli.kinematics.response import respond
from des_cli.model.machine import Machine, OccupantBounds, Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion, Record, Shortfall
from des_cli.model.profile import Reduction
from des_cli.reduction.free.task import FreeTask, turned_seat, unlimited
from des_cli.solver.spline import SplineGrid
from tests.support.claims import profile_of
from tests.support.free_motions import smooth, task_of

DESIRED, TABLE = smooth(40), smooth(40, amplitude=((0.6, 0.0), (0.1, 0.3), (-0.2, 0.1)))
BOUNDED = replace(DES, occupant=OccupantBounds(gx=(-1.0, 1.0), g_onset=0.7))
GRID = SplineGrid(0.0, 0.4, 10)


def shortfall_of(size: float) -> Shortfall:
    """The same missing of everything at any time."""
    sides = size * np.ones((40, 2, 3))
    return Shortfall(sides, 2.0 * sides, 3.0 * sides, np.zeros((41, 3)))


@pytest.mark.parametrize(
    ("limits", "machine_limits", "occupant"),
    [
        ("enforce", DES.limits, BOUNDED.occupant),
        ("check", unlimited(), OccupantBounds()),
        ("warn", unlimited(), OccupantBounds()),
    ],
)
def test_limits_and_bounds_hold_where_they_are_enforced(
    limits: Any, machine_limits: object, occupant: OccupantBounds
) -> None:
    task = FreeTask.of(profile_of(DESIRED, Reduction(limits=limits), BOUNDED), DESIRED)
    assert task.limits == machine_limits
    assert task.occupant == occupant


@pytest.mark.parametrize("missing", [None, shortfall_of(0.1)], ids=["all made", "some missing"])
def test_what_is_asked_is_what_the_reference_makes_and_what_it_misses(
    missing: Shortfall | None,
) -> None:
    seat = Seat(0.3, -0.2)
    profile = replace(profile_of(DESIRED, Reduction()), seat=seat)
    task = FreeTask.of(profile, DESIRED, missing)
    found, made = task.requested(), respond(DES, seat, DESIRED)
    assert found is task.response
    for name, times in (("seat_rate", 1), ("seat_angular_acceleration", 2), ("seat_g", 3)):
        more = 0.0 if missing is None else 0.1 * times
        expected = getattr(made, name) + more
        np.testing.assert_allclose(getattr(found, name), expected, rtol=0, atol=1e-12)
    assert task.held == Record(DESIRED, missing)
    assert task.recorded == task.held


def test_round_a_table_budgets_hold_against_it_and_the_record_stays() -> None:
    missing = shortfall_of(0.1)
    task = FreeTask.of(profile_of(DESIRED, Reduction()), DESIRED, missing)
    once = task.around(TABLE)
    assert once.held == Record(TABLE)
    assert once.recorded == task.around(TABLE).around(DESIRED).recorded == Record(DESIRED, missing)
    made = respond(DES, Seat(), TABLE)
    np.testing.assert_allclose(once.requested().seat_g, made.seat_g, rtol=0, atol=1e-12)


def with_noise(motion: Motion) -> Motion:
    """A motion whose rates jump up and down from sample to sample."""
    noise = 0.1 * (-1.0) ** np.arange(len(motion.t))[:, None]
    rate = motion.rate + noise
    return Motion(motion.t, motion.angle, rate[:-1], rate[1:])


def test_noise_is_rough_unless_it_is_the_table_of_the_base_itself() -> None:
    noisy = with_noise(DESIRED)
    assert not task_of(DESIRED, {}).rough(GRID)
    assert task_of(noisy, {}).rough(GRID)
    assert not task_of(DESIRED, {}).around(noisy).rough(GRID)
    assert not task_of(noisy, {}).rough(SplineGrid(0.0, 0.01, 400))  # finer than the samples


ENDS = {
    "free": (0, 0, 0),
    "match-start": (1, 0, 0),
    "match-rates": (1, 0, 1),
    "match-both": (1, 1, 1),
}


@pytest.mark.parametrize(("name", "kept"), ENDS.items(), ids=list(ENDS))
def test_ends(name: str, kept: tuple[int, int, int]) -> None:
    task = task_of(DESIRED, {}, ends=name, optimise=("cab_start",), hold=frozenset({"fork"}))
    ends, base = task.ends, task.base_ends
    np.testing.assert_array_equal(ends.start_value, [True, True, False])
    np.testing.assert_array_equal(ends.held, [False, True, False])
    for flags, expected in zip((ends.start_rate, ends.end_value, ends.end_rate), kept, strict=True):
        np.testing.assert_array_equal(flags, bool(expected))
    assert np.all(base.start_value)  # the executable motion starts where it is asked to
    assert not np.any(base.held)
    np.testing.assert_array_equal(base.end_rate, ends.end_rate)


def test_seats_turn_in_the_chains_order() -> None:
    task = task_of(DESIRED, {}, optimise=("seat_pitch", "seat_yaw"))
    turned = turned_seat(task, np.array([0.1, -0.2]))
    assert (turned.yaw, turned.pitch) == pytest.approx((np.pi / 2 + 0.1, -0.2))
    alone = task_of(DESIRED, {}, seat=Seat(0.3, 0.4), optimise=("seat_pitch",))
    turned = turned_seat(alone, np.array([0.5]))
    assert (turned.yaw, turned.pitch) == pytest.approx((0.3, 0.9))


def test_a_seat_without_free_angles_stays_and_takes_none() -> None:
    task = task_of(DESIRED, {}, seat=Seat(0.3, 0.4), optimise=("cab_start",))
    assert turned_seat(task, np.zeros(0)) == Seat(0.3, 0.4)
    with pytest.raises(ValueError, match="argument"):
        turned_seat(task, np.array([0.5]))


def test_a_machine_without_a_row_for_the_yaw_turns_its_seat_in_pitch_alone() -> None:
    rows = tuple(row for row in DES.rows if row.variable != "seat_yaw")
    machine = Machine("no yaw", rows, DES.limits)
    task = task_of(DESIRED, {}, machine, Seat(0.0, 0.4), optimise=("seat_yaw", "seat_pitch"))
    turned = turned_seat(task, np.array([0.5]))
    assert (turned.yaw, turned.pitch) == pytest.approx((0.0, 0.9))
