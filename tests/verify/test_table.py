"""What rows alone tell of a motion, against motions in closed form."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.model.command_table import CommandTable
from des_cli.model.felt import Felt, GSizes, TurningSizes
from des_cli.model.machine import JointLimits, OccupantBounds, Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.verify.table import check_against, check_ride, check_rows, check_times

SEAT = Seat()
T = np.linspace(0.0, 6.0, 601)


def swing(t: Floats, size: float = 0.5) -> CommandTable:
    """Fork and cab swing as size cos(w t), the arm's rate likewise; w = pi / 3."""
    wave = size * np.cos(math.pi / 3 * t)
    return CommandTable(t, wave, np.column_stack([wave, wave]))


def limited(**limits: float) -> JointLimits:
    return JointLimits(**{"angle": 9.0, "rate": 9.0, "acceleration": 9.0, "jerk": 9.0} | limits)


def machine(limit: JointLimits, **changes: object):
    return replace(DES, limits=(replace(limit, angle=math.inf), limit, limit), **changes)


def failed(table: CommandTable, limit: JointLimits) -> set[str]:
    return {c.key for c in check_against(machine(limit), SEAT, table) if not c.ok}


W = math.pi / 3


@pytest.mark.parametrize(
    ("quantity", "fork", "arm"),
    [
        # peaks of 0.5 cos(w t) and its derivatives; the arm's rate is what swings
        ("angle", 0.5, None),
        ("rate", 0.5 * W, 0.5),
        ("acceleration", 0.5 * W**2, 0.5 * W),
        ("jerk", 0.5 * W**3, 0.5 * W**2),
    ],
)
def test_each_limit_is_found_just_beyond_and_not_just_within(
    quantity: str, fork: float, arm: float | None
) -> None:
    table = swing(T)
    for joints, peak in (({"fork", "cab"}, fork), ({"arm"}, arm)):
        if peak is None:
            continue
        keys = {f"limits.{joint}.{quantity}" for joint in joints}
        assert keys <= failed(table, limited(**{quantity: 0.998 * peak}))
        assert not keys & failed(table, limited(**{quantity: 1.0001 * peak}))


def test_a_motion_of_parabolas_at_its_limits_seems_to_break_none() -> None:
    """Jerks of +-1 at the samples, uneven steps: divided differences are means of them."""
    rng = np.random.default_rng(5)
    t = np.concatenate([[0.0], np.cumsum(rng.choice([0.002, 0.01, 0.05], 400))])
    step = np.diff(t)
    jerk = rng.choice([-1.0, 1.0], len(step) - 1)
    acceleration = np.concatenate([[0.0], np.cumsum(jerk * 0.5 * (step[1:] + step[:-1]))])
    rate = np.concatenate([[0.1], 0.1 + np.cumsum(acceleration * step)])
    angle = np.concatenate([[0.0], np.cumsum(0.5 * step * (rate[1:] + rate[:-1]))])
    peaks = {
        "angle": np.max(np.abs(angle)) + 9.0,
        "rate": np.max(np.abs(rate)) + 9.0,
        "acceleration": np.max(np.abs(acceleration)),
        "jerk": 1.0,
    }
    table = CommandTable(t, rate, np.column_stack([angle, angle]))
    assert failed(table, limited(**peaks)) == set()


@pytest.mark.parametrize("bound", [math.nan, -1.0])
def test_a_limit_that_is_no_number_fails(bound: float) -> None:
    assert "limits.fork.rate" in failed(swing(T), limited(rate=bound))


@pytest.mark.parametrize("column", [1, 2, 3])
@pytest.mark.parametrize("row", [1, 2, 300, 598, 599])
def test_one_row_off_by_a_thousandth_is_seen(row: int, column: int) -> None:
    values = swing(T).values.copy()
    values[row, column] += 1e-3
    table = CommandTable(values[:, 0], values[:, 1], values[:, 2:])
    joint = ("arm", "fork", "cab")[column - 1]
    assert f"limits.{joint}.jerk" in failed(table, limited())


def test_an_end_from_which_it_cannot_stop_is_found() -> None:
    """The fork rises to 0.45 of 0.5 rad at 0.4 rad/s: braking at 0.5 takes 0.16 rad and more."""
    rise = 0.45 - 0.4 * (6.0 - T)
    table = CommandTable(T, 0 * T, np.column_stack([rise, 0 * T]))
    limit = limited(angle=2.5, acceleration=0.5, jerk=math.inf)
    assert failed(table, limit) == set()
    assert failed(table, replace(limit, angle=0.6)) >= {"stopping.fork.end"}
    back = CommandTable(T, 0 * T, np.column_stack([rise[::-1], 0 * T]))
    assert failed(back, replace(limit, angle=0.6)) >= {"stopping.fork.start"}


def test_where_the_arm_stands_counts_for_an_arm_that_has_a_stop() -> None:
    limit = limited(angle=1.0)
    tied = replace(DES, limits=(limit, limited(), limited()))
    table = CommandTable(T, 0 * T + 0.1, np.zeros((601, 2)))  # it turns by 0.6 rad
    keys = {c.key for c in check_against(tied, SEAT, table, arm_start=0.5) if not c.ok}
    assert "limits.arm.angle" in keys
    assert all(c.ok for c in check_against(tied, SEAT, table, arm_start=-0.5))


def test_bounds_for_the_occupant_hold_for_the_rows() -> None:
    """The arm at 2 rad/s: w^2 L2 / g sideways, all joints else at rest."""
    table = CommandTable(T, 0 * T + 2.0, np.zeros((601, 2)))
    sideways = 4.0 * DES.lengths["L2"] / 9.80665

    def keys(gy: float, gz: float) -> set[str]:
        bounds = OccupantBounds(gy=(-gy, gy), gz=(-gz, gz))
        checks = check_against(machine(limited(), occupant=bounds), SEAT, table)
        return {check.key for check in checks if not check.ok}

    assert keys(1.001 * sideways, 1.001) == set()
    assert keys(0.98 * sideways, 1.001) == {"occupant.gy"}
    assert keys(1.001 * sideways, 0.98) == {"occupant.gz"}


def test_times_that_do_not_rise_are_counted() -> None:
    assert check_times(swing(T)).ok
    for wrong in (0.0, -1.0, math.nan):
        t = T.copy()
        t[300] = t[299] + wrong
        assert check_times(swing(t)).value >= 1.0


def motion_of(table: CommandTable) -> Motion:
    rate = np.column_stack([table.arm_rate, np.zeros((len(table.t), 2))])
    angle = np.column_stack([0 * table.t, table.position])
    return Motion(table.t, angle, rate[:-1], rate[1:])


def test_rows_are_compared_to_the_last_bits() -> None:
    table = swing(T)
    assert all(c.ok for c in check_rows(table, table))
    for column, key in enumerate(("table.t", "table.arm", "table.fork", "table.cab")):
        values = table.values.copy()
        values[17, column] += 1e-14
        off = CommandTable(values[:, 0], values[:, 1], values[:, 2:])
        assert [c.key for c in check_rows(off, table) if not c.ok] == [key]
    assert [c.key for c in check_rows(table.between(0, 5), table)] == ["table.rows"]


def test_a_ride_harder_than_it_is_told_is_found() -> None:
    """Only the cab turns, as 0.5 cos(w t): dW/dt is 0.5 w^2 cos(w t), G one g down."""
    wave = 0.5 * np.cos(W * T)
    table = CommandTable(T, 0 * T, np.column_stack([0 * T, wave]))
    peak, rms = 0.5 * W**2, 0.5 * W**2 / math.sqrt(2)

    def keys(rms: float, peak: float, gz: float) -> list[str]:
        told = Felt(
            seat_angular_acceleration={
                "magnitude": TurningSizes(rms_after_rad_s2=rms, peak_after_rad_s2=peak)
            },
            seat_g={axis: GSizes(peak_after_g=gz) for axis in ("gx", "gy", "gz")},
        )
        return [c.key for c in check_ride(told, table, DES, SEAT) if not c.ok]

    assert keys(rms, peak, 1.0) == []
    assert keys(0.93 * rms, peak, 1.0) == ["ride.turning_rms"]
    assert keys(rms, 0.93 * peak, 1.0) == ["ride.turning_peak"]
    assert keys(rms, peak, 0.93) == ["ride.gz_peak"]
