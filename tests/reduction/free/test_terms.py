"""Weighted squares of what is felt, by definition and by finite differences."""

from __future__ import annotations

from typing import get_args

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.twist import VARIABLES, seat_forms
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.reduction.free.terms import Quantity, Term, curvature_of, slope_of, squares, value_of

STEP = 1e-6
M = 10
QUANTITIES = get_args(Quantity)
FORMS = seat_forms(chain_of(DES, Seat(0.4, -0.2)), DES.gravity)
ROOTS = {
    "scalar": 0.7 * np.eye(3),
    "diagonal": np.diag([0.0, 1.3, 0.4]),
    "full": np.array([[1.0, 0.2, 0.0], [0.3, 0.8, -0.1], [0.0, 0.5, 1.1]]),
}
UPPER = np.triu_indices(VARIABLES)


@pytest.fixture
def rng():
    return np.random.default_rng(21)


@pytest.fixture
def z(rng):
    return rng.uniform(-1.5, 1.5, (VARIABLES, M))


@pytest.fixture(params=list(ROOTS.values()), ids=list(ROOTS))
def root(request):
    return request.param


def differences(function, z):
    return np.stack(
        [
            (function(z + STEP * e[:, None]) - function(z - STEP * e[:, None])) / (2.0 * STEP)
            for e in np.eye(VARIABLES)
        ]
    )


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_residuals_count_from_the_reference_at_their_own_points(quantity, root, z, rng):
    reference = rng.normal(size=(3, M + 5))
    seat, at = FORMS.at(z), slice(2, 2 + M)
    found = Term(quantity, root, reference).residual(seat, at)
    expected = root @ (value_of(seat, quantity) - reference[:, 2 : 2 + M])
    np.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-13)
    found = Term(quantity, root).residual(seat, at)
    np.testing.assert_allclose(found, root @ value_of(seat, quantity), rtol=1e-13, atol=1e-13)


def test_the_quantities(z):
    seat = FORMS.at(z)
    np.testing.assert_array_equal(value_of(seat, "rate"), seat.twist[:3])
    np.testing.assert_array_equal(value_of(seat, "cross"), seat.products[:3])
    np.testing.assert_array_equal(value_of(seat, "acceleration"), seat.twist_rate[:3])
    np.testing.assert_array_equal(value_of(seat, "force"), seat.force)


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_slopes_and_multipliers(quantity, root, z, rng):
    term = Term(quantity, root, rng.normal(size=(3, M)))
    seat, at = FORMS.at(z), slice(0, M)
    slope = term.slope(seat)
    expected = differences(lambda y: term.residual(FORMS.at(y), at), z)
    np.testing.assert_allclose(slope, expected[: len(slope)], rtol=1e-6, atol=1e-6)
    assert not expected[len(slope) :].any()
    # half the derivative of the term by the value
    multiplier = term.multiplier(term.residual(seat, at))
    gradient = np.einsum("kcm,cm->km", slope_of(seat, quantity), 2.0 * multiplier)
    term_by_point = differences(lambda y: np.sum(term.residual(FORMS.at(y), at) ** 2, axis=0), z)
    np.testing.assert_allclose(gradient, term_by_point[: len(slope)], rtol=1e-5, atol=1e-4)


@pytest.mark.parametrize("kinds", [QUANTITIES, ("rate",), ("cross", "force"), ("acceleration",)])
def test_curvature(kinds, z, rng):
    multipliers = {quantity: rng.normal(size=(3, M)) for quantity in kinds}

    def gradient(y):
        total, seat = np.zeros((VARIABLES, M)), FORMS.at(y)
        for quantity, multiplier in multipliers.items():
            slope = slope_of(seat, quantity)
            total[: len(slope)] += np.einsum("kcm,cm->km", slope, multiplier)
        return total

    found = curvature_of(FORMS.at(z), multipliers)
    np.testing.assert_allclose(found, differences(gradient, z)[UPPER], rtol=1e-6, atol=1e-5)


@pytest.mark.parametrize("lengths", [(5,), (8,), (5, 8, 5), (8, 8)], ids=str)
def test_squares_of_slopes(lengths, rng):
    slopes = [rng.normal(size=(length, 3, M)) for length in lengths]
    expected = np.zeros((VARIABLES, VARIABLES, M))
    for slope in slopes:
        expected[: len(slope), : len(slope)] += np.einsum("krm,lrm->klm", slope, slope)
    np.testing.assert_allclose(squares(slopes), expected[UPPER], rtol=1e-12, atol=1e-12)
