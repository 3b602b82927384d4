"""The verification's own evaluation of the seat, against codes that share nothing with it."""

from __future__ import annotations

import ast
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import des_cli.verify
from des_cli.kinematics.response import respond
from des_cli.model.machine import DHRow, Seat
from des_cli.model.machines import DES, JOHNSVILLE
from des_cli.model.motion import Motion
from des_cli.verify.felt import CHUNK, SeatChain
from tests.reduction.conftest import make_uneven
from tests.support.pose_derivatives import by_product_rule
from tests.support.seat_forms import by_closed_forms

SEATS = [(90.0, 0.0), (0.0, 0.0), (87.1, -12.0), (-40.0, 65.0)]


def random_states(count=40):
    draw = np.random.default_rng(11).normal(size=(3, count, 3))
    return 2.0 * draw[0], draw[1], draw[2]


@pytest.mark.parametrize("degrees", SEATS)
def test_the_closed_forms_of_the_des(degrees):
    yaw, pitch = np.radians(degrees)
    states = random_states()
    felt = SeatChain(DES, Seat(yaw, pitch)).at(*states)
    forms = by_closed_forms(*states, yaw, pitch)
    for found, expected in (
        (felt.rate.T, forms.rate),
        (felt.cross.T, forms.cross),
        (felt.turning.T, forms.turning),
        (felt.g.T, forms.g),
        (np.moveaxis(felt.rotation, -1, 0), forms.attitude),
    ):
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(felt.angle.T, states[0])


def oblique(draw):
    """A machine of rows with no angle and no length left out, whose arm does not stand upright."""
    named = (None, "arm", None, "fork", "cab", "seat_yaw", None, "seat_pitch")
    rows = tuple(
        DHRow(*draw.normal(size=4), variable=variable, sign=int(draw.choice([-1, 1])))
        for variable in named
    )
    return replace(DES, rows=rows)


@pytest.mark.parametrize("seed", range(6))
def test_any_rows_by_the_product_rule_alone(seed):
    """No frame that turns is named there, and no angular velocity is composed of others."""
    draw = np.random.default_rng(seed)
    machine, seat = oblique(draw), Seat(*draw.normal(size=2))
    angle, rate, acceleration = random_states(7)
    chain = SeatChain(machine, seat)
    felt, coasting = chain.at(angle, rate, acceleration), chain.at(angle, rate, 0.0 * rate)
    axes = chain.axes(angle)
    for i, state in enumerate(zip(angle, rate, acceleration, strict=True)):
        expected = by_product_rule(machine, seat, *state)
        for found, value in (
            (felt.rate[:, i], expected.rate),
            (felt.turning[:, i], expected.turning),
            (felt.g[:, i], expected.g),
            (felt.rotation[..., i], expected.rotation),
            (axes[i] @ rate[i], expected.rate),
        ):
            np.testing.assert_allclose(found, value, rtol=0, atol=1e-11)
        still = by_product_rule(machine, seat, angle[i], rate[i], np.zeros(3))
        for cross in (felt.cross[:, i], coasting.cross[:, i], coasting.turning[:, i]):
            np.testing.assert_allclose(cross, still.turning, rtol=0, atol=1e-11)


def test_attitudes_of_a_motion_are_those_of_its_states():
    """At starts and at ends, of all and of some, and with a further turn."""
    motion = make_uneven()
    felt = SeatChain(JOHNSVILLE, Seat(0.3, -0.2)).along(motion)
    turn = np.random.default_rng(3).normal(size=motion.angle.shape)
    turned = replace(felt, attitudes=replace(felt.attitudes, turn=turn))
    count = len(motion.step)
    some = np.array([0, 3, count - 1, count, count + 1, 2 * count - 1])
    for each in (felt, turned):
        assert each.rotation.shape == (3, 3, 2 * count)
        np.testing.assert_array_equal(each.rotation[..., 1:count], each.rotation[..., count:-1])
        np.testing.assert_array_equal(each.part(some).rotation, each.rotation[..., some])
        ground = np.einsum("ijm,jm->im", each.rotation, each.cross)
        np.testing.assert_allclose(each.cross_ground, ground, rtol=0, atol=1e-14)
        np.testing.assert_allclose(
            each.part(some).cross_ground, ground[:, some], rtol=0, atol=1e-14
        )
        for block in (slice(1, count), slice(count, count + 2)):
            for name in ("g", "rotation", "cross_ground"):
                found, expected = getattr(each.block(block), name), getattr(each, name)
                np.testing.assert_allclose(found, expected[..., block], rtol=0, atol=1e-14)
    assert np.max(np.abs(turned.rotation - felt.rotation)) > 0.1


def test_dw_dt_and_cross_coupling_are_differences_of_the_angular_velocity():
    chain = SeatChain(JOHNSVILLE, Seat(0.3, -0.2))
    angle, rate, acceleration = random_states(20)
    felt, h = chain.at(angle, rate, acceleration), 1e-5
    for expected, joint_acceleration in (
        (felt.turning, acceleration),
        (felt.cross, 0.0 * acceleration),
    ):
        ahead, behind = (
            chain.at(
                angle + s * rate + 0.5 * s**2 * joint_acceleration,
                rate + s * joint_acceleration,
                joint_acceleration,
            ).rate
            for s in (h, -h)
        )
        np.testing.assert_allclose((ahead - behind) / (2.0 * h), expected, rtol=0, atol=1e-8)


@pytest.mark.parametrize("machine", [DES, JOHNSVILLE], ids=lambda m: m.name)
def test_along_a_motion_with_steps_of_the_rate(machine):
    motion, seat = make_uneven(), Seat(1.1, 0.4)
    felt, other = SeatChain(machine, seat).along(motion), respond(machine, seat, motion)
    for found, expected in (
        (felt.rate, other.seat_rate),
        (felt.cross, other.coriolis_seat),
        (felt.cross_ground, other.coriolis_report),
        (felt.turning, other.seat_angular_acceleration),
        (felt.g, other.seat_g),
    ):
        sides = np.stack(np.split(found.T, 2), axis=1)
        np.testing.assert_allclose(sides, expected, rtol=0, atol=1e-12)


def test_a_motion_longer_than_what_is_evaluated_at_once():
    """Its ground axes too, whose blocks are of samples and not of states."""
    count = 2 * CHUNK + 2
    draw = np.random.default_rng(5).normal(size=(3, count, 3))
    motion = Motion(np.arange(count) * 0.1, draw[0], draw[1, 1:], draw[2, 1:])
    felt, other = SeatChain(DES, Seat()).along(motion), respond(DES, Seat(), motion)
    for found, expected in (
        (felt.turning, other.seat_angular_acceleration),
        (felt.cross_ground, other.coriolis_report),
        (felt.g, other.seat_g),
    ):
        sides = np.stack(np.split(found.T, 2), axis=1)
        np.testing.assert_allclose(sides, expected, rtol=0, atol=1e-11)


def test_more_states_than_are_evaluated_at_once():
    states = [np.tile(each, (CHUNK // 20, 1)) for each in random_states(40)]
    felt, one = (SeatChain(DES, Seat()).at(*each) for each in (states, random_states(40)))
    for name in ("rate", "g", "rotation"):
        values, expected = getattr(felt, name), getattr(one, name)
        np.testing.assert_allclose(values[..., -40:], expected, rtol=0, atol=1e-14)
    np.testing.assert_array_equal(felt.part(np.arange(40)).g, felt.g[:, :40])


def test_nothing_is_shared_but_the_model_and_the_problem_as_data():
    shared = ("des_cli.model", "des_cli.units", "des_cli.verify", "des_cli.reduction.problem")
    for path in Path(des_cli.verify.__file__).parent.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("des_cli"):
                assert (node.module or "").startswith(shared), f"{path.name}: {node.module}"
