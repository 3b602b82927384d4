from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of, seat_rotation
from des_cli.kinematics.commanded_motion import make_desired
from des_cli.kinematics.coriolis import coriolis
from des_cli.kinematics.response import (
    BLOCK,
    _by_chain,
    _by_screws,
    acceleration_parts,
    respond,
    respond_on,
)
from des_cli.kinematics.seat import pilot_g
from des_cli.kinematics.twist import seat_forms
from des_cli.model.machine import Machine, Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion, integrate_sides
from des_cli.profiles_in.load import load_profile
from des_cli.units import STANDARD_GRAVITY_M_S2


def smooth_motion(q, qd, qdd, times):
    """Constant acceleration from a state, sampled at irregular times."""
    t = times[:, None]
    rate = qd + qdd * t
    return Motion(times, q + qd * t + 0.5 * qdd * t**2, rate[:-1], rate[1:])


def test_reference_states(state, same):
    motion = smooth_motion(state["q"], state["qd"], state["qdd"], np.array([0.0, 0.1, 0.3]))
    response = respond(DES, state.seat, motion)
    same(response.coriolis_report[0, 0], state["Wc_dot_22_24"])
    same(response.coriolis_seat[0, 0], state["Wc_dot_body"])
    same(response.seat_rate[0, 0], state["W_body"])
    parts = state["a_body_g_no_gravity"]
    same(
        acceleration_parts(chain_of(DES, state.seat), motion)[0, 0],
        [parts[name] for name in ("tangential", "centripetal", "coriolis")],
    )
    same(response.seat_g[0, 0], pilot_g(state["specific_force_body_g_with_gravity"]))


def test_both_sides_agree_where_nothing_steps(case, rng):
    motion = smooth_motion(*rng.uniform(-1.0, 1.0, (3, 3)), np.array([0.0, 0.2, 0.5, 0.6]))
    response = respond(case.machine, case.seat, motion)
    names = ("coriolis_report", "coriolis_seat", "seat_rate", "seat_angular_acceleration")
    named = {name: getattr(response, name) for name in (*names, "seat_g")}
    for name, sides in (named | {"parts": acceleration_parts(case.chain, motion)}).items():
        assert sides.shape[:2] == (3, 2)
        np.testing.assert_allclose(sides[:-1, 1], sides[1:, 0], rtol=0, atol=1e-12, err_msg=name)
    inertial = np.linalg.norm(response.coriolis_report, axis=-1)
    felt = np.linalg.norm(response.coriolis_seat, axis=-1)
    np.testing.assert_allclose(felt, inertial, rtol=0, atol=1e-13)


def test_a_rate_step_stays_a_step(case):
    angle = np.array([[0.0, 0.3, 0.1], [0.5, 0.3, 0.2], [1.0, 0.3, 0.1]])
    forth, back = [0.5, 0.0, 0.1], [0.5, 0.0, -0.1]
    motion = Motion(np.arange(3.0), angle, np.array([forth, back]), np.array([forth, back]))
    response = respond(case.machine, case.seat, motion)
    before = coriolis(case.chain, angle[1], np.array(forth), "seat")
    after = coriolis(case.chain, angle[1], np.array(back), "seat")
    assert np.abs(after - before).max() > 0.01
    np.testing.assert_allclose(response.coriolis_seat[0, 1], before, rtol=0, atol=1e-14)
    np.testing.assert_allclose(response.coriolis_seat[1, 0], after, rtol=0, atol=1e-14)
    assert not acceleration_parts(case.chain, motion)[
        ..., 0, :
    ].any()  # no acceleration is invented at the step


def test_screws_and_chain_agree_in_every_block(case, rng):
    """Two derivations of what is felt: the twist of screw axes, and partials of the pose."""
    n = BLOCK + 3
    motion = smooth_motion(*rng.uniform(-1.0, 1.0, (3, 3)), np.cumsum(rng.uniform(1e-4, 1e-3, n)))
    gravity = case.machine.gravity
    forms = seat_forms(case.chain, gravity)
    one, other = _by_screws(forms, motion), _by_chain(case.chain, gravity, motion)
    for name, values in vars(other).items():
        if name == "seat_g" and not forms.vertical:
            continue
        np.testing.assert_allclose(getattr(one, name), values, rtol=0, atol=1e-12, err_msg=name)
    expected = one if forms.vertical else other
    np.testing.assert_array_equal(respond_on(case.chain, gravity, motion).seat_g, expected.seat_g)


def test_an_arm_that_is_not_vertical_takes_the_seat_through_gravity():
    rows = (replace(DES.rows[0], alpha=0.3), *DES.rows[1:])
    tilted = Machine("tilted", rows, DES.limits)
    turn = np.array([[0.0, 0.0, 0.0], [np.pi, 0.0, 0.0]])
    creep = Motion(np.array([0.0, 1e9]), turn, np.zeros((1, 3)), np.zeros((1, 3)))
    g = respond(tilted, Seat(), creep).seat_g[0]
    np.testing.assert_allclose(np.linalg.norm(g, axis=-1), 1.0, rtol=1e-12)
    assert np.linalg.norm(g[1] - g[0]) == pytest.approx(2.0 * np.sin(0.3), rel=1e-12)


def test_seat_quantities_do_not_depend_on_the_azimuth(rng):
    motion = smooth_motion(*rng.uniform(-1.0, 1.0, (3, 3)), np.array([0.0, 0.2, 0.5]))
    turned = Motion(
        motion.t, motion.angle + np.array([0.65, 0.0, 0.0]), motion.rate_start, motion.rate_end
    )
    seat = Seat(0.8, 0.3)
    here, there = respond(DES, seat, motion), respond(DES, seat, turned)
    one, other = (acceleration_parts(chain_of(DES, seat), each) for each in (motion, turned))
    np.testing.assert_allclose(other, one, rtol=0, atol=1e-13)
    names = ("coriolis_seat", "seat_rate", "seat_angular_acceleration", "seat_g")
    for name in names:
        np.testing.assert_allclose(getattr(there, name), getattr(here, name), rtol=0, atol=1e-13)
    assert np.abs(there.coriolis_report - here.coriolis_report).max() > 0.01


def test_seat_rate_turns_the_seat(case, rng):
    """R(t + h) = R(t) (1 + h [W x]): body rates from a difference of attitudes."""
    q, qd, qdd = rng.uniform(-1.0, 1.0, (3, 3))
    h = 1e-4
    motion = smooth_motion(q, qd, qdd, np.array([0.0, h, 2 * h]))
    r = seat_rotation(case.chain, motion.angle)
    skew = r[1].T @ (r[2] - r[0]) / (2 * h)
    rate = respond(case.machine, case.seat, motion).seat_rate[1, 0]
    found = [skew[2, 1], skew[0, 2], skew[1, 0]]
    np.testing.assert_allclose(rate, found, rtol=0, atol=1e-6)


def test_the_total_angular_acceleration_is_the_derivative_of_the_seat_rate(case, rng):
    q, qd, qdd = rng.uniform(-1.0, 1.0, (3, 3))
    h = 1e-4
    response = respond(
        case.machine, case.seat, smooth_motion(q, qd, qdd, np.array([0.0, h, 2 * h]))
    )
    rate = np.append(response.seat_rate[:, 0], response.seat_rate[-1:, 1], axis=0)
    found = response.seat_angular_acceleration[1, 0]
    np.testing.assert_allclose(found, (rate[2] - rate[0]) / (2 * h), rtol=0, atol=1e-7)
    assert np.abs(found - response.coriolis_seat[1, 0]).max() > 0.01


def test_the_total_angular_acceleration_at_the_studys_seat(rng):
    """J_b theta'' + c written out for seat yaw 90 degrees, pitch 0."""
    q, qd, qdd = rng.uniform(-1.0, 1.0, (3, 3))
    response = respond(DES, Seat(), smooth_motion(q, qd, qdd, np.array([0.0, 0.1])))
    (s2, s3), (c2, c3) = np.sin(q[1:]), np.cos(q[1:])
    arm, fork, cab = qd
    jacobian = np.array([[-s2, 0.0, -1.0], [-c2 * s3, c3, 0.0], [c2 * c3, s3, 0.0]])
    cross = [
        -c2 * fork * arm,
        (s2 * s3 * fork - c2 * c3 * cab) * arm - s3 * cab * fork,
        (-s2 * c3 * fork - c2 * s3 * cab) * arm + c3 * cab * fork,
    ]
    total = response.seat_angular_acceleration[0, 0]
    np.testing.assert_allclose(total, jacobian @ qdd + cross, rtol=0, atol=1e-14)


def test_the_cobra_turns_the_pilot_as_an_independent_study_found():
    """0.462 rad/s^2 rms and 0.539 at most (CasADi, 4-point Gauss), two-sided at t = 5 s."""
    motion = make_desired(load_profile("cobra")).motion
    size = np.linalg.norm(respond(DES, Seat(), motion).seat_angular_acceleration, axis=-1)
    rms = np.sqrt(integrate_sides(motion.step, size**2) / motion.step.sum())
    assert abs(rms - 0.462) < 5e-4
    assert abs(size.max() - 0.539) < 5e-4


def test_local_gravity_is_the_machines():
    still = Motion(np.arange(2.0), np.zeros((2, 3)), np.zeros((1, 3)), np.zeros((1, 3)))
    moon = Machine("moon", DES.rows, DES.limits, gravity=STANDARD_GRAVITY_M_S2 / 6)
    seat = Seat()
    gz = respond(moon, seat, still).seat_g[..., 2]
    np.testing.assert_allclose(gz, 1 / 6, rtol=1e-14)
