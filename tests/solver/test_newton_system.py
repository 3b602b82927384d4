"""The Newton system against dense algebra."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.solver.newton_system import Border, Dynamics, NewtonSystem

N, W = 6, 5


@pytest.fixture
def rng():
    return np.random.default_rng(11)


@pytest.fixture
def parts(rng):
    """Hessian blocks, positive definite, that reach two samples ahead; dynamics; pins."""
    root = rng.normal(size=(N * W, N * W))
    k = np.repeat(np.arange(N), W)
    near = np.abs(k[:, None] - k) <= 2
    dense = (root @ root.T) * near + 20.0 * N * np.eye(N * W)
    blocks = dense.reshape(N, W, N, W).swapaxes(1, 2)
    hessian = np.array([blocks[i, i] for i in range(N)])
    across = [np.array([blocks[i, i + j] for i in range(N - j)]) for j in (1, 2)]
    left, ahead = rng.normal(size=(2, N - 1, 3, W))
    pinned = np.zeros((N, W), dtype=bool)
    pinned[0, :3] = pinned[-1, 4] = True
    return dense, hessian, across, left, ahead, pinned


def dense_dynamics(left, ahead):
    matrix = np.zeros((3 * (N - 1), N * W))
    for k in range(N - 1):
        matrix[3 * k : 3 * k + 3, W * k : W * (k + 2)] = np.hstack([left[k], ahead[k]])
    return matrix


@pytest.mark.parametrize("bordered", [False, True])
def test_a_step_as_dense(parts, rng, bordered):
    dense, hessian, across, left, ahead, pinned = parts
    force, defect = rng.normal(size=(N, W)), rng.normal(size=(N - 1, 3))
    border, rows = None, rng.normal(size=(N, W, 2))
    stiffness = np.array([3.0, 1e4])
    if bordered:
        border = Border(rows, stiffness)
        flat = rows.reshape(N * W, 2)
        dense = dense + flat @ np.diag(stiffness) @ flat.T
    system = NewtonSystem(hessian, across, Dynamics(left, ahead, pinned), border)
    move, multiplier = system.solve(force, defect)

    free = ~pinned.ravel()
    matrix = dense_dynamics(left, ahead)[:, free]
    size = free.sum()
    kkt = np.block([[dense[np.ix_(free, free)], matrix.T], [matrix, np.zeros((len(matrix),) * 2)]])
    right = -np.concatenate([force.ravel()[free], defect.ravel()])
    expected = np.linalg.solve(kkt, right)
    np.testing.assert_allclose(move.ravel()[free], expected[:size], rtol=1e-8, atol=1e-10)
    np.testing.assert_allclose(multiplier.ravel(), expected[size:], rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(move[pinned], 0.0, atol=1e-12)


@pytest.mark.parametrize("margin", [1e-2, -1e-2])
def test_convex_on_the_dynamics_as_the_projected_eigenvalues_say(parts, margin):
    dense, hessian, across, left, ahead, pinned = parts
    free = ~pinned.ravel()
    matrix = dense_dynamics(left, ahead)[:, free]
    basis = np.linalg.svd(matrix)[2][len(matrix) :].T  # what the dynamics allow
    least = np.linalg.eigvalsh(basis.T @ dense[np.ix_(free, free)] @ basis)[0]
    hessian = hessian + (margin - least) * np.eye(W)
    system = NewtonSystem(hessian, across, Dynamics(left, ahead, pinned))
    assert system.is_convex(1e3) is (margin > 0.0)


@pytest.mark.parametrize("n", [100, 20_000])
def test_a_drift_over_many_samples_is_no_negative_curvature(n):
    # theta_{k+1} = theta_k + h u_k, cost u^2 - theta^2 over unit time: convex on what the
    # dynamics allow (the unit is shorter than pi / 2), though theta^2 alone is not.
    h = 1.0 / n
    hessian = np.zeros((n + 1, 4, 4))
    hessian[:, [0, 1, 2, 3], [0, 1, 2, 3]] = h * np.array([-1.0, 1.0, 1.0, 1.0])
    unit, effect = np.eye(3, 4), np.zeros((3, 4))
    effect[0, 3] = h
    left = np.broadcast_to(-unit - effect, (n, 3, 4)).copy()
    ahead = np.broadcast_to(unit, (n, 3, 4)).copy()
    pinned = np.zeros((n + 1, 4), dtype=bool)
    pinned[0, :3] = True
    dynamics = Dynamics(left, ahead, pinned)
    assert NewtonSystem(hessian.copy(), [], dynamics).is_convex(h)
    hessian[:, 0, 0] *= 3.0  # over the unit, sqrt(3) is longer than pi / 2
    assert not NewtonSystem(hessian, [], dynamics).is_convex(h)
