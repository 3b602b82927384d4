"""What rows do to a pilot, against motions in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.model.command_table import CommandTable
from des_cli.model.felt import Felt, GSizes
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.verify.harm import find_harms, find_start, start_offsets

SEAT = Seat()
T = np.linspace(0.0, 6.0, 601)
W = math.pi / 3


def cab_swings(size: float, t: Floats = T) -> CommandTable:
    """Only the cab turns, as size cos(w t): dW/dt is size w^2 cos(w t)."""
    return CommandTable(t, 0 * t, np.column_stack([0 * t, size * np.cos(W * t)]))


def arm_spins_up(t: Floats, jerk: float = math.inf) -> CommandTable:
    """The arm turns at 1 rad/s, and from 3 s on it gains 0.6 rad/s^2, at once or by a jerk."""
    late = np.maximum(t - 3.0, 0.0)
    ramp = 0.6 / jerk
    rate = (
        np.where(late < ramp, 0.5 * jerk * late**2, 0.6 * (late - 0.5 * ramp))
        if ramp
        else (0.6 * late)
    )
    return CommandTable(t, 1.0 + rate, np.zeros((len(t), 2)))


def names(table: CommandTable, desired: CommandTable, onset: float | None = None) -> dict[str, str]:
    told = Felt(seat_g={axis: GSizes(onset_after_g_s=onset) for axis in ("gx", "gy", "gz")})
    found = find_harms(table, desired, DES, SEAT, told)
    return {notice.name: notice.text for notice in found}


def test_a_ride_as_the_desired_one_does_no_harm() -> None:
    assert names(cab_swings(0.5), cab_swings(0.5)) == {}
    assert names(cab_swings(0.4), cab_swings(0.5)) == {}


def test_more_turning_than_desired_is_told_from_a_twentieth_on() -> None:
    assert names(cab_swings(0.52), cab_swings(0.5)) == {}
    found = names(cab_swings(0.53), cab_swings(0.5))
    assert list(found) == ["turning"]
    assert "peak" not in found["turning"]
    both = names(cab_swings(0.56), cab_swings(0.5))["turning"]
    assert both.endswith(" rad/s^2")
    numbers = [float(word) for word in both.replace(",", "").split() if word[0].isdigit()]
    rms, peak = W**2 / math.sqrt(2), W**2
    assert numbers == pytest.approx([0.5 * rms, 0.56 * rms, 0.5 * peak, 0.56 * peak], rel=0.005)


@pytest.mark.parametrize("step", [0.01, 0.02, 0.05])
def test_a_step_of_the_arms_acceleration_is_a_jump_of_g(step: float) -> None:
    """Of 0.6 rad/s^2 on 5.79 m, which is 0.354 g; a jerk of 1.26 rad/s^3 is an onset."""
    t = np.linspace(0.0, 6.0, round(6.0 / step) + 1)
    at_rest = CommandTable(t, 1.0 + 0.0 * t, np.zeros((len(t), 2)))
    found = names(arm_spins_up(t), at_rest)
    size = 0.6 * math.hypot(DES.lengths["L2"], DES.lengths["Lx"]) / DES.gravity
    assert "g-jump" in found
    told = float(found["g-jump"].split(" by ")[1].split(" g")[0])
    assert told == pytest.approx(size, rel=0.25)
    assert "g-jump" not in names(arm_spins_up(t, jerk=1.26), at_rest, onset=0.8)
    assert "g-jump" not in names(arm_spins_up(t), arm_spins_up(t))


def test_the_onset_that_is_told_is_no_jump() -> None:
    coarse = np.linspace(0.0, 6.0, 31)
    at_rest = CommandTable(coarse, 1.0 + 0.0 * coarse, np.zeros((31, 2)))
    soft = arm_spins_up(coarse, jerk=1.26)
    assert "g-jump" in names(soft, at_rest, onset=None)
    assert "g-jump" not in names(soft, at_rest, onset=2.0)


def test_two_rows_tell_no_acceleration() -> None:
    two = cab_swings(1.0, np.array([0.0, 0.1]))
    assert names(two, cab_swings(0.1)) == {}


def test_a_start_elsewhere_is_told_joint_by_joint() -> None:
    table = cab_swings(0.5)
    there = table.values[0, 1:]
    assert list(find_start(there, table)) == []
    assert list(find_start(there + np.array([0.019, 0.009, -0.009]), table)) == []
    (notice,) = find_start(there - np.array([0.021, 0.0, -0.011]), table)
    assert notice.name == "start"
    assert notice.text.endswith(": arm +0.021 rad/s, cab -0.011 rad")
    assert list(find_start(there + np.array([0.0, 0.0, 0.5]), table, ("cab_start",))) == []


def test_a_start_that_nobody_knows_is_not_compared() -> None:
    table = cab_swings(0.5)
    offsets = start_offsets(np.array([math.nan, 0.25, math.nan]), table)
    assert [(joint, off) for joint, _, off, _ in offsets] == [("fork", -0.25)]


def test_a_jump_is_beside_what_the_onset_explains_over_two_intervals() -> None:
    t = np.linspace(0.0, 6.0, 301)
    at_rest = CommandTable(t, 1.0 + 0.0 * t, np.zeros((len(t), 2)))
    plain, explained = (names(arm_spins_up(t), at_rest, onset)["g-jump"] for onset in (0.0, 1.0))
    sizes = [float(text.split(" by ")[1].split(" g")[0]) for text in (plain, explained)]
    # 1 g/s along each of three axes, over two steps of 0.02 s
    assert sizes[0] - sizes[1] == pytest.approx(math.sqrt(3.0) * 0.04, abs=0.011)
