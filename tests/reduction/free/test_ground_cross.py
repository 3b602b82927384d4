"""The cross-coupling in the study's axes as a cost, by the study's forms and differences."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.model.machine import Seat
from des_cli.model.machines import DES, JOHNSVILLE
from des_cli.reduction.free.ground_cross import GROUND_VARIABLES, GroundCross, squares_of

STEP = 1e-6
M = 12
COUNT = len(GROUND_VARIABLES)
UPPER = np.triu_indices(COUNT)
ROOTS = {
    "BB3": np.diag([0.0, np.sqrt(2.0), 0.0]),
    "all": np.array([[1.0, 0.2, 0.0], [0.1, 2.0, 0.3], [0.0, 0.0, 1.0]]),
}


@pytest.fixture(params=[DES, JOHNSVILLE], ids=lambda machine: machine.name)
def chain(request):
    return chain_of(request.param, Seat(0.3, 0.1))


@pytest.fixture(params=list(ROOTS.values()), ids=list(ROOTS))
def term(request, chain):
    return GroundCross(chain, request.param)


@pytest.fixture
def rng():
    return np.random.default_rng(6)


@pytest.fixture
def z(rng):
    return rng.uniform(-2.0, 2.0, (COUNT, M))


def differences(function, z):
    return np.stack(
        [
            (function(z + STEP * e[:, None]) - function(z - STEP * e[:, None])) / (2.0 * STEP)
            for e in np.eye(COUNT)
        ]
    )


@pytest.mark.parametrize("root", ROOTS.values(), ids=list(ROOTS))
def test_residuals_are_the_studys_forms(root, z, closed_coriolis, rng):
    # (22)-(24); the cab's angle does not matter
    theta = [*z[:2], rng.uniform(-3.0, 3.0, M)]
    expected = root @ np.array(closed_coriolis(theta, list(z[2:]), "report"))
    found = GroundCross(chain_of(DES, Seat()), root).residual(z)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)


def test_slopes(term, z):
    np.testing.assert_allclose(term.slope(z), differences(term.residual, z), rtol=1e-6, atol=1e-7)


def test_curvature(term, z, rng):
    multiplier = rng.normal(size=(3, M))
    found = term.curvature(z, multiplier)
    expected = differences(lambda y: np.einsum("krm,rm->km", term.slope(y), multiplier), z)
    np.testing.assert_allclose(found, expected[UPPER], rtol=1e-6, atol=1e-6)


def test_squares(term, z):
    slope = term.slope(z)
    expected = np.einsum("krm,nrm->knm", slope, slope)[UPPER]
    np.testing.assert_allclose(squares_of(slope), expected, rtol=1e-12, atol=1e-12)
