"""Joint rates at one state in plain floats, against the vectorised solution."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.orientation import body_jacobian
from des_cli.kinematics.rate_field import SURELY_REGULAR, RateField
from des_cli.model.machine import Machine, Seat
from des_cli.model.machines import DES, JOHNSVILLE

STATES = np.random.default_rng(3).uniform(-7.0, 7.0, (400, 2))
DEMANDS = np.random.default_rng(4).normal(0.0, 0.3, (400, 3))


@pytest.mark.parametrize("machine", [DES, JOHNSVILLE], ids=lambda each: each.name)
@pytest.mark.parametrize("seat", [Seat(), Seat(yaw=0.4, pitch=0.3)], ids=["study", "turned"])
def test_plain_floats_solve_what_the_arrays_solve(machine: Machine, seat: Seat) -> None:
    chain = chain_of(machine, seat)
    field = RateField.of(chain, machine)
    angle = np.column_stack([np.zeros(400), STATES])
    jacobian = body_jacobian(chain, angle)
    want, held, _ = field.rates(jacobian, DEMANDS)
    regular = 0
    for row, (fork, cab) in enumerate(STATES.tolist()):
        p, q, r = DEMANDS[row].tolist()
        rates, determinant = field.at(fork, cab, (p, q, r))
        regular += determinant > SURELY_REGULAR and not held[row]
        assert determinant == pytest.approx(abs(np.linalg.det(jacobian[row])), abs=1e-14)
        np.testing.assert_allclose(rates, want[row], rtol=1e-11, atol=1e-13)
    assert 200 < regular < 400, "both ways are taken"


def test_a_rate_over_its_limit_is_held_there() -> None:
    field = RateField.of(chain_of(DES, Seat()), DES)
    rates, _ = field.at(0.3, 0.2, (0.0, 9.0, 0.0))
    limit = [joint.rate for joint in DES.limits]
    assert rates[1] == pytest.approx(limit[1])
    assert (np.abs(rates) <= np.array(limit) * (1 + 1e-12)).all()
