"""The integrated joint angles, against scipy's integrator and plain Runge-Kutta on arrays."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from des_cli.kinematics import joint_integration
from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.joint_integration import integrate_joints
from des_cli.kinematics.orientation import body_jacobian
from des_cli.kinematics.rate_field import RateField
from des_cli.model.arrays import Floats
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.profile import BodyRates

SEAT, INITIAL = Seat(yaw=1.1, pitch=0.2), np.array([0.3, -0.4, 0.5])
CHAIN = chain_of(DES, SEAT)


def test_against_an_adaptive_integrator_on_skew_cubics(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(joint_integration, "LONGEST_TURN", 0.002)
    start, middle, end, skew = np.random.default_rng(5).normal(0.0, 0.3, (4, 3, 3))
    command, step = BodyRates(start, middle, end, skew=skew), np.array([0.1, 0.02, 0.2])
    found = integrate_joints(RateField.of(CHAIN, DES), step, command, INITIAL)
    state = INITIAL
    for k, h in enumerate(step):

        def derivative(s: float, angle: Floats, k: int = k, h: float = h) -> Floats:
            demand = (1 - s) * (1 - 2 * s) * start[k] + 4 * s * (1 - s) * middle[k]
            demand += s * (2 * s - 1) * end[k] + s * (1 - s) * (1 - 2 * s) * skew[k]
            return np.asarray(h * np.linalg.solve(body_jacobian(CHAIN, angle), demand))

        solution = solve_ivp(derivative, (0.0, 1.0), state, "DOP853", rtol=1e-12, atol=1e-13)
        state = solution.y[:, -1]
        np.testing.assert_allclose(found[k + 1], state, rtol=0, atol=1e-8)


def test_plain_floats_take_the_steps_that_arrays_would() -> None:
    t = np.arange(0.0, 4.0, 0.01)
    rates = np.column_stack([0.2 * np.sin(2 * t), 0.2 * np.cos(t), 0.1 + 0.1 * np.sin(t)])
    start, end = rates[:-1], rates[1:]
    command = BodyRates(start, 0.5 * (start + end), end)
    found = integrate_joints(RateField.of(CHAIN, DES), np.diff(t), command, INITIAL)

    def field(angle: Floats, demand: Floats) -> Floats:
        return np.asarray(np.linalg.solve(body_jacobian(CHAIN, angle), demand))

    angle, h = INITIAL, 0.01
    for k in range(len(t) - 1):
        k1 = field(angle, start[k])
        k2 = field(angle + 0.5 * h * k1, command.middle[k])
        k3 = field(angle + 0.5 * h * k2, command.middle[k])
        k4 = field(angle + h * k3, end[k])
        angle = angle + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        np.testing.assert_allclose(found[k + 1], angle, rtol=0, atol=1e-12)
