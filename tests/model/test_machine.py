"""A machine is bounded by what it says, and by nothing that it leaves out."""

import math
from dataclasses import FrozenInstanceError

import pytest

from des_cli.model.machine import JointLimits, Machine, OccupantBounds, Seat

LIMITS = (JointLimits(math.inf, 1.0, 1.0),) * 3


@pytest.mark.parametrize(
    "bounds",
    [
        {"gx": (-1.0, math.inf)},
        {"gy": (-math.inf, 1.0)},
        {"gz": (0.5, 4.0)},
        {"g_onset": 3.0},
        {"angular_acceleration": 2.0},
    ],
    ids=lambda bounds: next(iter(bounds)),
)
def test_any_bound_bounds_the_occupant(bounds: dict) -> None:
    assert OccupantBounds(**bounds).bounded


def test_a_silent_machine_bounds_nobody_and_stands_on_earth() -> None:
    machine = Machine("own", (), LIMITS)
    assert not machine.occupant.bounded
    assert machine.gravity == pytest.approx(32.2 * 0.3048)  # as the study takes it
    assert {limit.jerk for limit in machine.limits} == {math.inf}
    assert Seat() == Seat(yaw=math.radians(90), pitch=0.0)


def test_two_machines_share_nothing_that_can_be_changed() -> None:
    one, other = Machine("own", (), LIMITS), Machine("own", (), LIMITS)
    assert one == other
    assert one.lengths is not other.lengths
    with pytest.raises(FrozenInstanceError):
        one.gravity = 0.0  # type: ignore[misc]
