"""What rows alone tell of a motion, against motions in closed form."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.model.command_table import CommandTable
from des_cli.model.felt import Felt, GSizes, TurningSizes
from des_cli.model.machine import JointLimits, OccupantBounds, Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
from des_cli.verify.table import check_against, check_ride, check_rows, check_times, ride_of

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


def value(key: str, table: CommandTable, limit: JointLimits, arm: JointLimits | None = None):
    """What is measured of a joint."""
    limits = (arm or replace(limit, angle=math.inf), limit, limit)
    checks = check_against(replace(DES, limits=limits), SEAT, table)
    (found,) = (check.value for check in checks if check.key == key)
    return found


def rows(t: Sequence[float], values: Sequence[float]) -> CommandTable:
    """The same numbers as the arm's rate and as both positions."""
    column = np.array(values)
    return CommandTable(np.array(t), column, np.column_stack([column, column]))


def test_differences_on_uneven_steps_by_hand() -> None:
    # of positions: rates 1, 3, 2; accelerations 2 / 1.5 and -1 / 1.5; jerk -2 over 2 s, the
    # longer of the step of 2 s and its neighbours' mean of 1 s
    table = rows([0.0, 1.0, 3.0, 4.0], [0.0, 1.0, 7.0, 9.0])
    unit = JointLimits(angle=1.0, rate=1.0, acceleration=1.0, jerk=1.0)
    expected = {"angle": 9.0, "rate": 3.0, "acceleration": 4.0 / 3.0, "jerk": 1.0}
    for quantity, most in expected.items():
        for joint in ("fork", "cab"):
            found = value(f"limits.{joint}.{quantity}", table, unit)
            assert found == pytest.approx(most - 1.0, rel=1e-12)
    # of rates: accelerations 1, 3, 2, jerk 2 / 1.5; angles 0.5, 8.5, 16.5
    expected = {"angle": 16.5, "rate": 9.0, "acceleration": 3.0, "jerk": 4.0 / 3.0}
    for quantity, most in expected.items():
        found = value(f"limits.arm.{quantity}", table, unit, unit)
        assert found == pytest.approx(most - 1.0, rel=1e-12)
    # a step of 1 s between two of 2 s: rates 1, 3, 2, the jerk over 2 s again
    table = rows([0.0, 2.0, 3.0, 5.0], [0.0, 2.0, 5.0, 9.0])
    assert value("limits.fork.jerk", table, unit) == pytest.approx(0.0, abs=1e-12)


def test_the_arm_begins_where_it_is_said_to_stand() -> None:
    table = rows([0.0, 1.0], [0.1, 0.3])
    limit = limited(angle=1.0)
    checks = check_against(replace(DES, limits=(limit,) * 3), SEAT, table, arm_start=0.5)
    (found,) = (check.value for check in checks if check.key == "limits.arm.angle")
    assert found == pytest.approx(0.7 - 1.0)


@pytest.mark.parametrize(
    ("joint", "quantity"),
    [
        *(("fork", each) for each in ("rate", "acceleration", "jerk")),
        *(("arm", each) for each in ("acceleration", "jerk")),
    ],
)
def test_rounding_of_every_row_breaks_no_limit(joint: str, quantity: str) -> None:
    """Rows near one that are off by what doubles may be, to either side in turn.

    A difference is off by two roundings over the step, and so on: a limit of next to nothing is
    kept by rows that are off by four bits, and not by a fifth more.
    """
    t = 1024.0 + 2.0**-20 * np.arange(6)
    for bits, inside in ((4.0, True), (5.0, False)):
        table = rows(t, 1.0 + np.array([1.0, -1.0] * 3) * bits * 2.0**-52)
        found = value(f"limits.{joint}.{quantity}", table, limited(**{quantity: 1e-300}))
        assert (found == -1.0) == inside, bits


def test_a_rate_and_its_rounding() -> None:
    table = rows([0.0, 1.0, 2.0], [4.0, 4.0, 4.0])
    almost = 4.0 * (1.0 - 2.0 * 4.0 * 2.0**-52)
    found = value("limits.arm.rate", table, limited(rate=almost))
    assert 0.5 < found / (4.0 * 2.0**-52) < 1.5


def test_states_at_the_ends_of_parabolas_on_uneven_steps() -> None:
    """At the first row and at the last, where differences are of the middles of steps.

    The fork as x = v t + a t^2 / 2 and the arm's rate as v + a t: both are exact. Before the
    first row a positive rate that falls was a^2 / 2 j faster, after the last a rising one will be.
    """
    t = np.array([0.0, 0.3, 0.4, 0.9, 1.0])
    jerk, most = 2.0, 5.0
    limit = limited(rate=most, jerk=jerk)
    for v, a in ((3.0, -1.5), (1.0, 1.5)):
        way = v * t + 0.5 * a * t**2
        table = CommandTable(t, v + a * t, np.column_stack([way, way]))
        swing = a**2 / (2.0 * jerk)
        start = v + (swing if a < 0.0 else 0.0)
        end = v + a * t[-1] + (swing if a > 0.0 else 0.0)
        for joint in ("arm", "fork", "cab"):
            for key, rate in (("start", start), ("end", end)):
                found = value(f"stopping.{joint}.{key}", table, limit)
                tight = value(f"stopping.{joint}.{key}", table, replace(limit, angle=1e6))
                assert tight == pytest.approx(rate / most - 1.0, rel=1e-9)
                assert found >= tight - 1e-12


def test_angles_at_both_ends_count() -> None:
    t = np.linspace(0.0, 1.0, 101)
    still = CommandTable(t, 0 * t, np.column_stack([0 * t + 0.4, 0 * t - 0.6]))
    limit = limited(angle=1.0)
    expected = {"fork": 0.4 - 1.0, "cab": 0.6 - 1.0}
    for joint, share in expected.items():
        for key in ("start", "end"):
            assert value(f"stopping.{joint}.{key}", still, limit) == pytest.approx(share)
    # it moves from one to the other and is at rest at both
    moved = CommandTable(t, 0 * t, np.column_stack([0.1 + 0.7 * np.round(t), 0 * t]))
    assert value("stopping.fork.start", moved, limit) == pytest.approx(0.1 - 1.0)
    assert value("stopping.fork.end", moved, limit) == pytest.approx(0.8 - 1.0)


def test_two_rows_tell_a_rate_and_no_acceleration() -> None:
    table = CommandTable(np.array([0.0, 0.5]), np.array([0.2, 0.2]), np.array([[0.0, 0], [0.1, 0]]))
    limit = limited(rate=0.25, angle=1e6)
    assert value("stopping.fork.end", table, limit) == pytest.approx(0.2 / 0.25 - 1.0)
    assert value("limits.fork.acceleration", table, limit) == -1.0
    assert value("limits.arm.jerk", table, limit) == -1.0
    bounds = OccupantBounds(gz=(-1.0, 1.0))
    keys = {c.key for c in check_against(machine(limit, occupant=bounds), SEAT, table)}
    assert not {key for key in keys if key.startswith("occupant")}
    three = rows([0.0, 0.5, 1.0], [0.0, 0.0, 0.0])
    keys = {c.key for c in check_against(machine(limit, occupant=bounds), SEAT, three)}
    assert "occupant.gz" in keys
    keys = {c.key for c in check_against(machine(limit, occupant=OccupantBounds()), SEAT, three)}
    assert "occupant.gz" not in keys
    assert check_ride(Felt(), table, DES, SEAT) == []


def test_no_limit_is_measured_that_there_is_not() -> None:
    table = swing(T)
    checks = check_against(machine(limited(rate=math.inf)), SEAT, table)
    keys = {check.key for check in checks}
    assert "limits.fork.rate" not in keys
    assert {"limits.fork.angle", "limits.fork.jerk", "limits.arm.jerk"} <= keys
    assert "limits.arm.angle" not in keys
    assert math.isnan(value("limits.fork.rate", table, limited(rate=0.0)))


@pytest.mark.parametrize("size", [3.0, -3.0])
def test_rows_may_be_off_by_what_units_and_text_round_and_times_by_nothing(size: float) -> None:
    right = rows([0.0, 1.0, 2.0], [size, 1.0, -2.0])
    bits = 3.0 * 2.0**-52
    for column, key in enumerate(("table.t", "table.arm", "table.fork", "table.cab")):
        for off, ok in ((2.0, column > 0), (-2.0, column > 0), (6.0, False), (-6.0, False)):
            values = right.values.copy()
            values[1, column] += off * bits
            found = CommandTable(values[:, 0], values[:, 1], values[:, 2:])
            checks = {check.key: check for check in check_rows(found, right)}
            assert list(checks)[1:] == ["table.t", "table.arm", "table.fork", "table.cab"]
            assert checks[key].ok == ok
            assert checks[key].value == pytest.approx(abs(off) * bits, abs=2.0**-52)
    assert [check.value for check in check_rows(right.between(0, 1), right)] == [1.0]


@pytest.mark.parametrize("count", [0, 1, 3])
def test_times_that_do_not_rise_are_counted_each(count: int) -> None:
    t = T.copy()
    t[10 : 10 + count] = t[9]
    check = check_times(swing(t))
    assert (check.value, check.tolerance) == (count, 0.0)


def test_what_is_felt_at_the_middles_of_uneven_steps() -> None:
    """The arm's rate grows by a: dW/dt is a, and G is w^2 L2 / g to the side."""
    rng = np.random.default_rng(12)
    t = np.concatenate([[0.0], np.cumsum(rng.choice([0.004, 0.01, 0.02], 200))])
    a = 0.5
    table = CommandTable(t, a * t, np.zeros((len(t), 2)))
    ride = ride_of(table, DES, SEAT)
    assert ride.turning_peak == pytest.approx(a, rel=1e-9)
    assert ride.turning_rms == pytest.approx(a, rel=1e-9)
    middles = 0.5 * (t[1:] + t[:-1])
    np.testing.assert_allclose(ride.t, 0.5 * (middles[1:] + middles[:-1]), rtol=1e-12)
    pull = DES.lengths["L2"] * a**2 / 9.80665
    side = np.abs(ride.g[1])
    m = len(ride.t)
    np.testing.assert_allclose(side[:m], pull * middles[:-1] ** 2, atol=2e-3)
    np.testing.assert_allclose(side[m:], pull * middles[1:] ** 2, atol=2e-3)
    np.testing.assert_array_equal(ride.mean_g, 0.5 * (ride.g[:, :m] + ride.g[:, m:]))


def test_a_long_step_weighs_as_long_as_it_is() -> None:
    """The cab's acceleration is 1 for a second in steps of 0.01 s, and 3 in steps of 0.1 s."""
    t = np.concatenate([np.linspace(0.0, 1.0, 101), np.linspace(1.1, 2.0, 10)])
    cab = np.where(t < 1.0, 0.5 * t**2, 0.5 + (t - 1.0) + 1.5 * (t - 1.0) ** 2)
    table = CommandTable(t, 0 * t, np.column_stack([0 * t, cab]))
    ride = ride_of(table, DES, SEAT)
    assert ride.turning_peak == pytest.approx(3.0, rel=1e-9)
    assert ride.turning_rms == pytest.approx(math.sqrt((1.0 + 9.0) / 2.0), rel=0.02)


@pytest.mark.parametrize("told", [0.0, 0.01])
def test_a_ride_of_next_to_nothing_is_measured_absolutely(told: float) -> None:
    """The cab turns at 0.06 rad/s^2: 0.01 above the twentieth from which it is relative."""
    t = np.linspace(0.0, 2.0, 201)
    table = CommandTable(t, 0 * t, np.column_stack([0 * t, 0.03 * t**2]))
    felt = Felt(seat_angular_acceleration={"magnitude": TurningSizes(peak_after_rad_s2=told)})
    (check,) = check_ride(felt, table, DES, SEAT)
    assert check.key == "ride.turning_peak"
    assert check.value == pytest.approx(0.2, rel=1e-6)
    assert check.tolerance == 0.05


def test_a_bound_on_the_angular_acceleration_of_rows() -> None:
    """The cab alone turns at 1.5 rad/s^2, in every interval."""
    t = np.linspace(0.0, 2.0, 201)
    table = CommandTable(t, 0 * t, np.column_stack([0 * t, 0.75 * t**2]))
    bounds = OccupantBounds(angular_acceleration=1.2)
    checks = check_against(machine(limited(), occupant=bounds), SEAT, table)
    (check,) = (each for each in checks if each.key.startswith("occupant"))
    assert check.value == pytest.approx(0.25, rel=1e-6)
    assert check.tolerance == 0.01
