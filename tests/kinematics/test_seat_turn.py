"""What the seat's fixing changes, against differences of seats that are fixed otherwise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.seat_turn import mixed_force, mixed_force_slope, seat_turns
from des_cli.kinematics.twist import VARIABLES, seat_forms
from des_cli.model.machine import DHRow, Seat
from des_cli.model.machines import COVISART, DES, JOHNSVILLE
from tests.support.states import CASES

FIELDS = {"seat_yaw": "yaw", "seat_pitch": "pitch"}
STEP = 1e-6
TWISTS = ("twist", "products", "twist_rate", "twist_slope", "products_slope", "twist_rate_slope")


def _pitch_first():
    """A chain whose seat pitches before it yaws, with lengths between the two."""
    rows = list(DES.rows)
    yaw, pitch = (next(k for k, row in enumerate(rows) if row.variable == name) for name in FIELDS)
    rows[yaw], rows[pitch] = (
        replace(rows[pitch], a=0.3, d=-0.2),
        replace(rows[yaw], a=-0.1, d=0.4),
    )
    return replace(DES, name="pitch-first", rows=tuple(rows))


MACHINES = (DES, JOHNSVILLE, COVISART, _pitch_first())


@pytest.fixture(params=MACHINES, ids=lambda machine: machine.name)
def machine(request):
    return request.param


@pytest.fixture(params=[Seat(), Seat(0.7, -0.4)], ids=["study", "turned"])
def seat(request):
    return request.param


@pytest.fixture
def z(rng):
    return rng.uniform(-2.0, 2.0, (VARIABLES, 12))


def motion_of(machine, seat, z):
    return seat_forms(chain_of(machine, seat), machine.gravity).at(z)


def by_difference(function, seat, name):
    """The derivative of a function of the seat by one of its angles."""
    field = FIELDS[name]
    ahead, behind = (
        function(replace(seat, **{field: getattr(seat, field) + sign * STEP}))
        for sign in (1.0, -1.0)
    )
    return (ahead - behind) / (2.0 * STEP)


def test_first_derivatives(machine, seat, z):
    for name, turn in seat_turns(machine, seat).items():
        turned = turn.of(motion_of(machine, seat, z))
        for quantity in TWISTS:
            expected = by_difference(
                lambda at, q=quantity: getattr(motion_of(machine, at, z), q), seat, name
            )
            np.testing.assert_allclose(getattr(turned, quantity), expected, rtol=1e-7, atol=2e-7)
        expected = by_difference(lambda at: motion_of(machine, at, z).gravity[0], seat, name)
        np.testing.assert_allclose(turned.gravity[0], expected, rtol=1e-7, atol=2e-7)


def test_the_force_mixes_both(machine, seat, z):
    here = motion_of(machine, seat, z)
    for name, turn in seat_turns(machine, seat).items():
        turned = turn.of(here)
        for found, quantity in (
            (mixed_force(here, turned), "force"),
            (mixed_force_slope(here, turned), "force_slope"),
        ):
            expected = by_difference(
                lambda at, q=quantity: getattr(motion_of(machine, at, z), q), seat, name
            )
            np.testing.assert_allclose(found, expected, rtol=1e-6, atol=2e-6)


def test_second_derivatives(machine, seat, z):
    """The outer turn acts on what the inner one, or itself, has changed."""
    turns = seat_turns(machine, seat)
    names = list(turns)
    for inner, outer in ((0, 0), (0, 1), (1, 1)):
        twice = turns[names[outer]].of(turns[names[inner]].of(motion_of(machine, seat, z)))

        def once(at, inner=inner, quantity=""):
            turn = seat_turns(machine, at)[names[inner]]
            return getattr(turn.of(motion_of(machine, at, z)), quantity)

        for quantity in TWISTS:
            expected = by_difference(
                lambda at, q=quantity, once=once: once(at, quantity=q), seat, names[outer]
            )
            np.testing.assert_allclose(getattr(twice, quantity), expected, rtol=1e-6, atol=1e-6)


def test_the_outermost_angle_of_the_chain_is_last():
    assert list(seat_turns(DES, Seat())) == ["seat_yaw", "seat_pitch"]
    assert list(seat_turns(_pitch_first(), Seat())) == ["seat_pitch", "seat_yaw"]


def test_an_angle_that_the_machine_does_not_have_is_left_out(z):
    rows = tuple(row for row in DES.rows if row.variable != "seat_yaw")
    assert list(seat_turns(replace(DES, rows=rows), Seat())) == ["seat_pitch"]
    # an angle before the last joint does not fix the seat in the cab
    case = CASES["arbitrary"]
    turns = seat_turns(case.machine, case.seat)
    assert list(turns) == ["seat_pitch"]
    turned = turns["seat_pitch"].of(motion_of(case.machine, case.seat, z))
    expected = by_difference(
        lambda at: motion_of(case.machine, at, z).twist_rate, case.seat, "seat_pitch"
    )
    np.testing.assert_allclose(turned.twist_rate, expected, rtol=1e-6, atol=2e-6)


def test_rows_beyond_the_seats_do_not_turn_with_it(z):
    """A fixed row behind the seat's angles moves the head off their axes."""
    longer = replace(DES, rows=(*DES.rows, DHRow(alpha=0.4, a=0.5, d=-0.3, offset=0.2)))
    for name, turn in seat_turns(longer, Seat()).items():
        turned = turn.of(motion_of(longer, Seat(), z))
        expected = by_difference(lambda at: motion_of(longer, at, z).twist_rate, Seat(), name)
        np.testing.assert_allclose(turned.twist_rate, expected, rtol=1e-6, atol=2e-6)
