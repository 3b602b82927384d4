"""Trigonometric polynomials against functions written out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from des_cli.kinematics.trig_polynomial import BLOCK, TrigPolynomial, basis, stack

ONE, COS, SIN = range(3)


def polynomial(*terms: tuple[tuple[int, int, int], float]) -> TrigPolynomial:
    coefficient = np.zeros((3, 3, 3))
    for place, factor in terms:
        coefficient[place] = factor
    return TrigPolynomial(coefficient)


WHOLE = polynomial(
    ((ONE, ONE, ONE), 1.0), ((COS, SIN, ONE), 2.0), ((ONE, ONE, SIN), -3.0), ((SIN, COS, COS), 0.5)
)
OF_FORK = polynomial(((ONE, SIN, ONE), 2.0), ((ONE, COS, ONE), -1.0))


def whole(angles: np.ndarray) -> np.ndarray:
    a, b, c = np.moveaxis(angles, -1, 0)
    return (
        1.0
        + 2.0 * np.cos(a) * np.sin(b)
        - 3.0 * np.sin(c)
        + 0.5 * np.sin(a) * np.cos(b) * np.cos(c)
    )


def test_the_coefficients_are_those_of_one_cosine_and_sine(rng: np.random.Generator) -> None:
    angles = rng.uniform(-7.0, 7.0, (4, 5, 3))
    np.testing.assert_allclose(WHOLE(angles), whole(angles), rtol=0, atol=1e-14)
    np.testing.assert_allclose(
        OF_FORK(angles), 2.0 * np.sin(angles[..., 1]) - np.cos(angles[..., 1]), atol=1e-14
    )


def test_complex_angles_give_the_analytic_continuation(rng: np.random.Generator) -> None:
    angles = rng.uniform(-1.0, 1.0, (6, 3)) + 1j * rng.uniform(-1.0, 1.0, (6, 3))
    np.testing.assert_allclose(WHOLE(angles), whole(angles), rtol=0, atol=1e-14)


def test_all_partial_derivatives_are_exact(
    step: Callable[..., np.ndarray], rng: np.random.Generator
) -> None:
    for angles in rng.uniform(-7.0, 7.0, (5, 3)):
        slope = step(whole, angles)
        np.testing.assert_allclose(WHOLE.gradient()(angles), slope, rtol=0, atol=1e-14)
        for joint in range(3):
            found = WHOLE.derivative(joint)
            assert found.shape == ()
            assert found(angles) == pytest.approx(slope[joint], abs=1e-14)
            turned = step(found, angles)
            np.testing.assert_allclose(found.gradient()(angles), turned, rtol=0, atol=1e-14)


def test_a_derivative_leaves_no_negative_zero() -> None:
    for joint in range(3):
        found = WHOLE.derivative(joint).coefficient
        assert not np.signbit(found[found == 0.0]).any()


def test_joints_that_do_not_matter_are_not_evaluated() -> None:
    assert (WHOLE.joints, OF_FORK.joints) == ((0, 1, 2), (1,))
    assert (WHOLE.matrix.shape, OF_FORK.matrix.shape) == ((27, 1), (3, 1))
    assert OF_FORK.derivative(0).joints == ()
    angles = np.array([np.nan, np.pi / 2, np.nan])
    assert OF_FORK(angles) == pytest.approx(2.0)
    assert OF_FORK.derivative(0)(angles) == 0.0


def test_values_of_any_shape_stand_behind_the_samples(rng: np.random.Generator) -> None:
    both = stack([WHOLE, OF_FORK])
    assert both.shape == (2,)
    square = stack([both, both, both])
    assert square.shape == (3, 2)
    for shape in ((), (0,), (1,), (4, 2)):
        angles = rng.uniform(-3.0, 3.0, (*shape, 3))
        found = square(angles)
        assert found.shape == (*shape, 3, 2)
        np.testing.assert_allclose(found[..., 2, 0], whole(angles), rtol=0, atol=1e-14)
    assert square.gradient().shape == (3, 3, 2)


def test_blocks_join_without_a_seam(rng: np.random.Generator) -> None:
    angles = rng.uniform(-3.0, 3.0, (2 * BLOCK + 3, 3))
    np.testing.assert_allclose(WHOLE(angles), whole(angles), rtol=0, atol=1e-14)


def test_the_last_joint_of_the_basis_runs_fastest() -> None:
    found = basis(np.array([[np.pi / 6, 9.0, np.pi / 3]]), (0, 2))[:, 0]
    c1, s1, c3, s3 = np.sqrt(3.0) / 2, 0.5, 0.5, np.sqrt(3.0) / 2
    expected = [1, c3, s3, c1, c1 * c3, c1 * s3, s1, s1 * c3, s1 * s3]
    np.testing.assert_allclose(found, expected, atol=1e-15)
