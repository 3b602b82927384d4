"""Rows on a clock: inside all limits by differences of their own, and what is told otherwise."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from des_cli.errors import UsageError
from des_cli.model.command_table import CommandTable
from des_cli.model.joint_rows import JointRows
from des_cli.model.machine import Machine, OccupantBounds, Seat
from des_cli.release.clocked import Clock
from des_cli.release.playback import Playback
from des_cli.verify.table import check_against
from tests.support.tables import DES, resting, riding, swaying, swaying_at, uneven

TABLES = {
    "swaying": swaying(),
    "resting": resting(),
    "riding": riding(),
    "uneven": uneven(swaying(200.0)),
    "cut": swaying_at(np.append(swaying().t[:-1], swaying().t[-2] + 0.003)),
}


def play(table: CommandTable, machine: Machine = DES) -> Playback:
    assert all(check.ok for check in check_against(machine, Seat(), table))
    return Playback(table, machine, Seat())


def peaks(rows: JointRows) -> np.ndarray:
    """Largest rate, acceleration and jerk of arm, fork and cab by plain differences, (3, 3)."""
    step = np.diff(rows.t)
    h = step[0]
    assert np.allclose(step, h, rtol=1e-9)
    arm = [np.diff(rows.rate[:, 0], order) / h**order for order in (0, 1, 2)]
    others = [[np.diff(rows.angle[:, j], order) / h**order for order in (1, 2, 3)] for j in (1, 2)]
    return np.array([[np.max(np.abs(each)) for each in joint] for joint in (arm, *others)])


def bounds(machine: Machine = DES) -> np.ndarray:
    return np.array([[each.rate, each.acceleration, each.jerk] for each in machine.limits])


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize(
    ("hz", "rate", "end"),
    [
        *itertools.product([50.0, 100.0, 130.0, 400.0], [1.0, 0.7], ["ramp", "stop"]),
    ],
)
def test_rows_keep_every_limit_by_differences(name: str, hz: float, rate: float, end: str) -> None:
    clocked = play(TABLES[name]).on(Clock(hz, rate, end))  # type: ignore[arg-type]
    assert clocked.failed == ()
    # Differences of doubles: at 400 Hz 1e-15 rad are 2e-7 rad/s^3.
    assert np.all(peaks(clocked.rows) <= bounds() * (1 + 1e-6))
    assert np.allclose(clocked.rows.t[:2], TABLES[name].t[0] + np.array([0.0, 1.0]) / hz)


def test_at_its_own_rows_a_table_is_itself() -> None:
    table = swaying()
    clocked = play(table).on(Clock(100.0))
    np.testing.assert_array_equal(clocked.rows.commands.values, table.values)
    assert np.all(clocked.off < 1e-12)


def test_every_second_row_is_one_of_the_tables() -> None:
    table = swaying()
    rows = play(table).on(Clock(50.0)).rows
    np.testing.assert_array_equal(rows.commands.values, table.values[::2])


def test_rows_that_ride_a_limit_are_passed_beside_and_it_is_told_how_far() -> None:
    table = riding()
    clocked = play(table).on(Clock(130.0))
    largest = np.max(np.abs(np.diff(table.position[:, 0], 2))) / 6.0
    assert 0.1 * largest < clocked.off[1] <= largest * (1 + 1e-9)
    # The other joints go through their rows.
    assert np.all(clocked.off[[0, 2]] < 1e-12)


@pytest.mark.parametrize("name", ["swaying", "riding", "uneven"])
def test_rates_and_accelerations_are_the_derivatives(name: str) -> None:
    rows = play(TABLES[name]).on(Clock(800.0, 0.9, "ramp")).rows
    h = 1.0 / 800.0
    for values, slopes in ((rows.angle, rows.rate), (rows.rate, rows.acceleration)):
        middle = (values[2:] - values[:-2]) / (2.0 * h)
        # A third derivative of 1.26 rad/s^3 at the most steps by 2.5.
        assert np.max(np.abs(middle - slopes[1:-1])) < 2.0 * h


def test_a_slower_rate_scales() -> None:
    table = swaying()
    slow = play(table).on(Clock(100.0, 0.5)).rows
    assert len(slow.t) == 2 * len(table.t) - 1
    np.testing.assert_allclose(slow.commands.arm_rate[::2], 0.5 * table.arm_rate, atol=1e-12)
    np.testing.assert_allclose(slow.commands.position[::2], table.position, atol=1e-12)
    whole = play(table).on(Clock(100.0)).rows
    np.testing.assert_allclose(slow.angle[::2], whole.angle, atol=1e-9)
    np.testing.assert_allclose(slow.acceleration[::2], 0.25 * whole.acceleration, atol=1e-9)


def test_the_largest_rate_keeps_the_limits_and_a_larger_one_does_not() -> None:
    playback = play(swaying())
    clock = Clock(100.0, 20.0)
    assert playback.on(clock).failed
    largest = playback.largest_rate(clock)
    assert largest is not None
    assert 1.0 < largest < 20.0
    assert not playback.on(Clock(100.0, largest)).failed
    assert playback.on(Clock(100.0, largest * 1.01)).failed


def test_of_a_table_at_its_limit_the_largest_rate_is_1() -> None:
    assert play(riding()).largest_rate(Clock(100.0, 1.5)) == 1.0


def test_no_rate_keeps_a_limit_that_no_row_does() -> None:
    tight = replace(DES, limits=(DES.limits[0], replace(DES.limits[1], angle=1e-3), DES.limits[2]))
    assert Playback(swaying(), tight, Seat()).largest_rate(Clock(100.0)) is None


def test_a_ramp_ends_with_all_joints_at_rest() -> None:
    clocked = play(swaying()).on(Clock(100.0, 1.0, "ramp"))
    rows = clocked.rows
    assert clocked.table_rows == len(swaying().t)
    assert len(rows.t) > clocked.table_rows + 100
    assert np.all(rows.rate[-2:] == 0.0)
    np.testing.assert_array_equal(rows.angle[-1], rows.angle[-2])


def test_holding_repeats_the_last_row_and_the_arm_turns_on() -> None:
    table, clock = resting(), Clock(100.0, 1.0, "hold")
    clocked = play(table).on(clock)
    assert clocked.failed == ()
    more = clocked.held(clock, len(clocked.rows.t))
    whole = JointRows.joined([clocked.rows, more])
    assert np.allclose(np.diff(whole.t), 0.01)
    after = whole.commands.values[len(table.t) :, 1:]
    np.testing.assert_allclose(after, np.tile(table.values[-1, 1:], (len(after), 1)), atol=1e-12)
    np.testing.assert_allclose(np.diff(whole.angle[len(table.t) :, 0]), 0.01, atol=1e-12)


def test_holding_what_still_moves_breaks_limits() -> None:
    failed = {check.key for check in play(swaying()).on(Clock(100.0, 1.0, "hold")).failed}
    assert {"limits.fork.jerk", "limits.cab.jerk"} <= failed


def test_the_bounds_for_the_occupant_are_measured_too() -> None:
    bounded = replace(DES, occupant=OccupantBounds(angular_acceleration=0.35))
    playback = play(swaying(), bounded)
    assert not playback.on(Clock(100.0)).failed
    assert {check.key for check in playback.on(Clock(100.0, 3.0)).failed} >= {
        "occupant.angular_acceleration"
    }


@pytest.mark.parametrize("end", ["stop", "ramp"])
def test_a_table_without_two_rows_on_the_clock_is_refused(end: str) -> None:
    table = swaying(400.0, 0.005)
    with pytest.raises(
        UsageError, match=r"it lasts 0\.005 s at rate 1: less than two rows at 100 Hz"
    ):
        play(table).on(Clock(100.0, 1.0, end))  # type: ignore[arg-type]
    assert len(play(table).on(Clock(200.0)).rows.t) == 2


@pytest.mark.parametrize("rows", [2, 3, 4, 5])
def test_short_tables_are_played(rows: int) -> None:
    table = swaying_at(0.1 * np.arange(rows))
    clocked = play(table).on(Clock(100.0, 1.0, "ramp"))
    assert clocked.failed == ()
    assert clocked.table_rows == 10 * (rows - 1) + 1


def test_the_last_row_is_on_the_clock_or_the_tick_before_it_ends() -> None:
    table = swaying(100.0, 0.25)
    assert play(table).on(Clock(100.0)).rows.t[-1] == pytest.approx(0.25)
    assert play(table).on(Clock(30.0)).rows.t[-1] == pytest.approx(7 / 30)
