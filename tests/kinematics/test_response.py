from __future__ import annotations

import numpy as np

from des_cli.kinematics.chain import seat_rotation
from des_cli.kinematics.coriolis import coriolis
from des_cli.kinematics.response import respond
from des_cli.kinematics.seat import pilot_g
from des_cli.model.machine import Machine, Seat
from des_cli.model.machines import DES
from des_cli.model.motion import Motion
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
        response.seat_parts[0, 0],
        [parts[name] for name in ("tangential", "centripetal", "coriolis")],
    )
    same(response.seat_g[0, 0], pilot_g(state["specific_force_body_g_with_gravity"]))


def test_both_sides_agree_where_nothing_steps(case, rng):
    motion = smooth_motion(*rng.uniform(-1.0, 1.0, (3, 3)), np.array([0.0, 0.2, 0.5, 0.6]))
    response = respond(case.machine, case.seat, motion)
    for name in ("coriolis_report", "coriolis_seat", "seat_rate", "seat_parts", "seat_g"):
        sides = getattr(response, name)
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
    assert not response.seat_parts[..., 0, :].any()  # no acceleration is invented at the step


def test_seat_quantities_do_not_depend_on_the_azimuth(rng):
    motion = smooth_motion(*rng.uniform(-1.0, 1.0, (3, 3)), np.array([0.0, 0.2, 0.5]))
    turned = Motion(
        motion.t, motion.angle + np.array([0.65, 0.0, 0.0]), motion.rate_start, motion.rate_end
    )
    seat = Seat(0.8, 0.3)
    here, there = respond(DES, seat, motion), respond(DES, seat, turned)
    for name in ("coriolis_seat", "seat_rate", "seat_parts", "seat_g"):
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


def test_local_gravity_is_the_machines():
    still = Motion(np.arange(2.0), np.zeros((2, 3)), np.zeros((1, 3)), np.zeros((1, 3)))
    moon = Machine("moon", DES.rows, DES.limits, gravity=STANDARD_GRAVITY_M_S2 / 6)
    seat = Seat()
    gz = respond(moon, seat, still).seat_g[..., 2]
    np.testing.assert_allclose(gz, 1 / 6, rtol=1e-14)
