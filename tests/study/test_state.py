"""The report of a state agrees with itself across frames, for any machine."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.model.motion import Motion
from des_cli.study.closed_forms import seat_turn
from des_cli.study.state import StateReport, report_motion, report_states
from des_cli.units import STANDARD_GRAVITY_M_S2


@pytest.fixture
def report(case, rng) -> StateReport:
    angle, rate, acceleration = rng.uniform(-3.0, 3.0, (3, 50, 3))
    return report_states(case.machine, case.seat, angle, rate, acceleration)


def in_ground(report: StateReport, vectors: np.ndarray) -> np.ndarray:
    return np.einsum("ncs,ns->nc", report.t_0_17[:, :3, :3], vectors)


def test_the_same_vector_in_every_frame(case, report) -> None:
    for ground, seat in (
        (report.w_ground, report.w_seat),
        (report.angular_ground, report.angular_seat),
        (report.coriolis_ground, report.coriolis_seat),
        (report.parts_ground[:, 3], report.parts_seat[:, 3] * STANDARD_GRAVITY_M_S2),
    ):
        np.testing.assert_allclose(in_ground(report, seat), ground, rtol=0, atol=1e-11)
    np.testing.assert_allclose(report.w_eq32, report.w_ground @ seat_turn(case.seat).T, atol=1e-13)


def test_determinants_and_singular_values_are_common(report) -> None:
    for jacobian in (report.ground_jacobian, report.body_jacobian, report.j2):
        np.testing.assert_allclose(
            np.linalg.det(jacobian), report.orientation_determinant, rtol=0, atol=1e-13
        )
        np.testing.assert_allclose(
            np.linalg.svd(jacobian)[1], report.singular_values, rtol=0, atol=1e-13
        )


def test_force_is_acceleration_against_gravity(case, report) -> None:
    felt = in_ground(report, report.specific_force) * STANDARD_GRAVITY_M_S2
    felt[:, 2] -= case.machine.gravity
    np.testing.assert_allclose(felt, report.parts_ground[:, 3], rtol=0, atol=1e-10)
    np.testing.assert_array_equal(report.g_vector, report.specific_force * [1, 1, -1])


def test_velocity_and_acceleration_are_derivatives_along_a_motion(case) -> None:
    """Central differences of the position over a motion with constant acceleration."""
    start, rate, acceleration = np.array([[0.3, -0.4, 0.9], [1.2, 0.7, -1.1], [0.5, -0.8, 0.4]])
    h = 1e-4
    t = np.array([-h, 0.0, h])
    angle = start + np.outer(t, rate) + 0.5 * np.outer(t**2, acceleration)
    speed = rate + np.outer(t, acceleration)
    motion = Motion(t, angle, speed[:-1], speed[1:])
    found = report_motion(case.machine, case.seat, motion)
    x = found.position
    np.testing.assert_allclose((x[2] - x[0]) / (2 * h), found.velocity[1], rtol=1e-6)
    second = (x[2] - 2 * x[1] + x[0]) / h**2
    np.testing.assert_allclose(second, found.parts_ground[1, 3], rtol=1e-5, atol=1e-5)


def test_a_step_of_the_rate_is_the_mean_of_both_sides(case) -> None:
    t, angle = np.array([0.0, 1.0, 2.0]), np.zeros((3, 3))
    start, end = np.ones((2, 3)), np.ones((2, 3))
    start[1], end[1] = 3.0, 5.0
    found = report_motion(case.machine, case.seat, Motion(t, angle, start, end))
    np.testing.assert_array_equal(found.rate[:, 0], [1.0, 2.0, 5.0])
    np.testing.assert_array_equal(found.acceleration[:, 0], [0.0, 1.0, 2.0])
