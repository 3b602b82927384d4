"""The oracle against itself, finite differences, and the numbers of an independent study."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest

from tests.support.cobra import RPM, States, cobra
from tests.support.felt_reference import (
    COLUMNS,
    Table,
    by_parabolas,
    by_splines,
    evaluate,
    gauss_points,
    read_table,
    sign_changes,
)
from tests.support.seat_forms import LT, LX, Floats, G, by_chain, by_closed_forms, transform

SEATS = ((90.0, 0.0), (0.0, 0.0), (87.1, -12.0), (-40.0, 65.0))


def random_states(count: int = 40) -> States:
    draw = np.random.default_rng(7).normal(size=(3, count, 3))
    return 2 * draw[0], draw[1], draw[2]


@pytest.mark.parametrize("degrees", SEATS)
def test_the_two_ways_agree(degrees: tuple[float, float]) -> None:
    seat = np.radians(degrees)
    one = by_closed_forms(*random_states(), *seat)
    other = by_chain(*random_states(), *seat)
    for key, value in vars(one).items():
        np.testing.assert_allclose(value, getattr(other, key), rtol=0, atol=1e-12)


def test_derivatives_of_the_transform_are_those_of_finite_differences() -> None:
    angle, rate, acceleration = random_states()
    step = 1e-4

    def along(s: float) -> Floats:
        place = angle + s * rate + s**2 / 2 * acceleration
        return transform(place, rate, acceleration, 0.4, -0.3)[0]

    _, first, second = transform(angle, rate, acceleration, 0.4, -0.3)
    ahead, now, behind = along(step), along(0.0), along(-step)
    np.testing.assert_allclose((ahead - behind) / (2 * step), first, rtol=0, atol=2e-5)
    np.testing.assert_allclose((ahead - 2 * now + behind) / step**2, second, rtol=0, atol=1e-3)


def test_an_upright_seat_on_a_turning_arm_feels_its_weight_and_the_centrifugal_push() -> None:
    # facing along j0 with the arm along i0: the push outwards is to the pilot's right
    still = np.zeros((1, 3))
    spin = np.array([[1.2, 0.0, 0.0]])
    felt = by_closed_forms(still, spin, still)
    np.testing.assert_allclose(felt.g[0, 2], 1.0)
    np.testing.assert_allclose(felt.rate[0], [0.0, 0.0, 1.2])
    radius = np.linalg.norm(transform(still, still, still)[0][0, :2, 3])
    np.testing.assert_allclose(np.hypot(*felt.g[0, :2]), 1.2**2 * radius / G)
    height = transform(still, still, still)[0][0, 2, 3]
    np.testing.assert_allclose(height, LT - LX, atol=0.03)


def test_the_cobra_has_the_numbers_of_an_independent_study() -> None:
    rows = np.linspace(0.0, 10.0, 501)
    found = evaluate(cobra, rows)
    assert found.reduction == 0.0
    assert found.cross_rms_before == pytest.approx(0.351, abs=5e-4)
    assert found.turning_rms_before == pytest.approx(0.462, abs=5e-4)
    assert found.turning_peak_before == pytest.approx(0.539, abs=5e-4)


def test_the_cobra_joins_and_its_rates_are_its_derivatives() -> None:
    t, step = np.linspace(0.05, 9.95, 100), 1e-5  # none within a step of 5 s
    ahead, now, behind = cobra(t + step), cobra(t), cobra(t - step)
    for k in (0, 1):
        slope = (ahead[k] - behind[k]) / (2 * step)
        np.testing.assert_allclose(slope, now[k + 1], rtol=0, atol=1e-8)
    np.testing.assert_allclose(*(cobra(np.array([5 + s]))[0] for s in (-1e-9, 0)), atol=1e-8)


def write(path: Path, t: Floats, states: States) -> Path:
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        columns = (t, states[1][:, 0] / RPM, *np.degrees(states[0][:, 1:]).T)
        writer.writerows(zip(*(each.tolist() for each in columns), strict=True))
    return path


def test_a_table_of_the_cobra_is_the_cobra(tmp_path: Path) -> None:
    t = np.linspace(0.0, 10.0, 1001)
    table = read_table(write(tmp_path / "commands.csv", t, cobra(t)))
    found = evaluate(by_splines(table), table.t)
    # the spline rounds the cab's rate step at 5 s
    assert abs(found.reduction) < 1e-3
    assert found.seat_rate_deviation_relative < 5e-3
    assert found.joint_deviation_relative < 1e-5
    assert found.attitude_error_max_deg < 0.05
    np.testing.assert_allclose(found.start_rate, 0.0, atol=1e-3)


def test_parabolas_read_accelerations_that_jump_exactly() -> None:
    draw = np.random.default_rng(3)
    step = np.repeat(draw.uniform(0.005, 0.02, 8), 30)
    growth = np.repeat(draw.choice([-2.5, 2.5], (8, 3)), 30, axis=0)
    t = np.concatenate([[0.0], np.cumsum(step)])
    rate = np.concatenate([np.zeros((1, 3)), np.cumsum(growth * step[:, None], axis=0)]) + 0.3
    moves = step[:, None] * (rate[:-1] + rate[1:]) / 2
    angle = np.concatenate([np.zeros((1, 3)), np.cumsum(moves, axis=0)])
    rebuilt = by_parabolas(Table(t, rate[:, 0], angle[:, 1:]))
    found = rebuilt((t[:-1] + t[1:]) / 2)
    np.testing.assert_allclose(found[2], growth, atol=1e-8)
    np.testing.assert_allclose(rebuilt(t[1:] - 1e-9)[0], angle[1:], atol=1e-8)


def test_both_rebuilds_find_the_rates_of_a_smooth_motion() -> None:
    def smooth(t: Floats) -> States:
        wave = np.array([0.3, 0.7, 1.1])
        phase = t[:, None] * wave
        return np.sin(phase), wave * np.cos(phase), -(wave**2) * np.sin(phase)

    rows = np.linspace(0.0, 6.0, 301)
    states = smooth(rows)
    table = Table(rows, states[1][:, 0], states[0][:, 1:])
    inside, _ = gauss_points(rows[5:-5])
    for rebuild, most in ((by_parabolas, 2e-2), (by_splines, 1e-4)):
        for found, exact in zip(rebuild(table)(inside), smooth(inside), strict=True):
            np.testing.assert_allclose(found, exact, rtol=0, atol=most)
    jerk = evaluate(by_splines(table), rows, desired=smooth, kinks=()).jerk_peak
    np.testing.assert_allclose(jerk, np.array([0.3, 0.7, 1.1]) ** 3, rtol=2e-3)


def test_slower_joints_have_the_deviations_of_their_closed_forms() -> None:
    # all joints at half their rates and a quarter of their accelerations: c falls by 1/16
    def slow(t: Floats) -> States:
        angle, rate, acceleration = cobra(t)
        return angle, rate / 2, acceleration / 4

    found = evaluate(slow, np.linspace(0.0, 10.0, 101))
    assert found.reduction == pytest.approx(15 / 16)
    assert found.seat_rate_deviation_relative == pytest.approx(0.5)
    assert found.joint_deviation_relative == found.attitude_error_max_deg == 0.0


def test_a_turn_of_the_arm_is_the_attitude_error() -> None:
    def turned(t: Floats) -> States:
        angle, rate, acceleration = cobra(t)
        return angle + np.array([math.radians(3.0), 0.0, 0.0]), rate, acceleration

    found = evaluate(turned, np.linspace(0.0, 10.0, 101))
    assert found.attitude_error_max_deg == pytest.approx(3.0)
    assert found.seat_g_rms_error_g == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(np.degrees(found.start_angle), [3.0, 0.0, 0.0], atol=1e-9)


def test_sign_changes_leave_rounding_out() -> None:
    assert sign_changes(np.array([1.0, 1e-9, -1e-9, 1.0, -1.0, -0.5, 2.0])) == 2
    assert sign_changes(np.zeros(4)) == 0
