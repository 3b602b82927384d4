"""Banded solutions against dense ones."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import LinAlgError

from des_cli.solver.banded import BandedLU, Part, is_positive_definite


def dense(diagonal, upper, lower):
    """The whole matrix of a block tridiagonal one."""
    n, b, _ = diagonal.shape
    matrix = np.zeros((n, b, n, b))
    k = np.arange(n)
    matrix[k, :, k, :] = diagonal
    matrix[k[:-1], :, k[1:], :] = upper
    matrix[k[1:], :, k[:-1], :] = lower
    return matrix.reshape(n * b, n * b)


def factorise(diagonal, upper, lower):
    """The factorisation of a block tridiagonal matrix."""
    parts = (Part(diagonal), Part(upper, ahead=1), Part(lower, ahead=-1))
    return BandedLU(*diagonal.shape[:2], parts)


def blocks(rng, n, b, density=1.0):
    """Random blocks, of which a share of the places is zero in every block."""
    mask = rng.uniform(size=(3, b, b)) <= density
    diagonal = rng.normal(size=(n, b, b)) * mask[0] + 3.0 * np.eye(b)
    return (
        diagonal,
        rng.normal(size=(n - 1, b, b)) * mask[1],
        rng.normal(size=(n - 1, b, b)) * mask[2],
    )


@settings(max_examples=40)
@given(
    seed=st.integers(0, 10_000),
    n=st.integers(1, 7),
    b=st.integers(1, 9),
    density=st.sampled_from([0.1, 0.4, 1.0]),
)
def test_solves_as_dense(seed, n, b, density):
    rng = np.random.default_rng(seed)
    diagonal, upper, lower = blocks(rng, n, b, density)
    matrix = dense(diagonal, upper, lower)
    right = rng.normal(size=(n, b))
    solution = factorise(diagonal, upper, lower).solve(right)
    residual = matrix @ solution.ravel() - right.ravel()
    scale = np.abs(matrix).sum(axis=1).max() * np.abs(solution).max() + np.abs(right).max()
    assert np.abs(residual).max() <= 1e-13 * scale
    if np.linalg.cond(matrix) < 1e6:
        expected = np.linalg.solve(matrix, right.ravel())
        np.testing.assert_allclose(solution.ravel(), expected, rtol=1e-8, atol=1e-8)


def test_needs_pivoting():
    # A saddle point: the multiplier's own diagonal is zero.
    diagonal = np.array([[[0.0, 1.0], [1.0, 0.0]]] * 3)
    coupling = np.zeros((2, 2, 2))
    right = np.arange(6.0).reshape(3, 2)
    solution = factorise(diagonal, coupling, coupling).solve(right)
    np.testing.assert_allclose(solution, right[:, ::-1])


def test_leaves_its_arguments_alone():
    rng = np.random.default_rng(1)
    arguments = [*blocks(rng, 5, 4), rng.normal(size=(5, 4))]
    copies = [each.copy() for each in arguments]
    factorise(*arguments[:3]).solve(arguments[3])
    is_positive_definite(5, 4, (Part(arguments[0]), Part(arguments[2], ahead=-1)))
    for argument, copy in zip(arguments, copies, strict=True):
        np.testing.assert_array_equal(argument, copy)


@pytest.mark.parametrize("value", [0.0, np.nan])
def test_a_singular_system_has_no_solution(value):
    diagonal = np.array([np.eye(2)] * 3)
    diagonal[1, 1, 1] = value
    coupling = np.zeros((2, 2, 2))
    with pytest.raises(LinAlgError):
        factorise(diagonal, coupling, coupling).solve(np.ones((3, 2)))


@settings(max_examples=40)
@given(
    seed=st.integers(0, 10_000),
    n=st.integers(1, 6),
    b=st.integers(1, 6),
    margin=st.floats(1e-6, 1.0),
    above=st.booleans(),
)
def test_positive_definite_as_the_eigenvalues_say(seed, n, b, margin, above):
    rng = np.random.default_rng(seed)
    diagonal, upper, _ = blocks(rng, n, b, 0.6)
    diagonal = diagonal + np.swapaxes(diagonal, 1, 2)
    matrix = dense(diagonal, upper, np.swapaxes(upper, 1, 2))
    # Shift so that the least eigenvalue is the margin, or minus the margin.
    least = np.linalg.eigvalsh(matrix)[0]
    shifted = diagonal + ((margin if above else -margin) - least) * np.eye(b)
    lower = Part(np.swapaxes(upper, 1, 2), ahead=-1)
    assert is_positive_definite(n, b, (Part(shifted), lower)) is above


def test_parts_stand_where_they_say_and_several_sides_are_solved_at_once():
    rng = np.random.default_rng(3)
    corner, inner, last = rng.normal(size=(3, 1, 2)), rng.normal(size=(2, 2, 1)), np.eye(2)[None]
    parts = (
        Part(np.broadcast_to(4.0 * np.eye(3), (4, 3, 3))),
        Part(corner, row=2, column=1, ahead=1),
        Part(inner, row=1, column=0, ahead=-1, first=1),
    )
    matrix = 4.0 * np.eye(12)
    for k in range(3):
        matrix[3 * k + 2, 3 * k + 4 : 3 * k + 6] = corner[k, 0]
    for k in (1, 2):
        matrix[3 * k + 4 : 3 * k + 6, 3 * k] = inner[k - 1, :, 0]
    right = rng.normal(size=(4, 3, 2))
    found = BandedLU(4, 3, parts).solve(right)
    np.testing.assert_allclose(found.reshape(12, 2), np.linalg.solve(matrix, right.reshape(12, 2)))
    assert is_positive_definite(4, 2, (Part(np.broadcast_to(np.eye(2), (4, 2, 2))),))
    assert not is_positive_definite(1, 3, (Part(-last, 1, 1), Part(np.ones((1, 1, 1)))))
