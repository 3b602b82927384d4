"""The optimum against a collocation code on the exact necessary conditions.

With one component B = p^2 g(theta, t) of the Coriolis vector,

    theta' = p phi,   L' = -r1 p^4 g dg/dtheta,   2 r1 p^3 g^2 - r2 (1 - p) + L phi = 0,

theta given at the start and L = 0 at the end (the study leaves out the first term
of the last equation). The cab's rate steps at 5 s: the halves are two sets of states
over one and the same interval, joined by conditions.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from tests.support.cobra import cobra

R1 = 2.0
HALF = 5.0
RPM = 2.0 * np.pi / 60.0


def desired_rates(s, late):
    """phi = Theta' of (34)-(37), s seconds into the first or the second half, (3, k)."""
    return cobra(s + HALF * late, late=late)[1].T


def desired_angles(s, late):
    return cobra(s + HALF * late, late=late)[0][..., :2].T


def component(theta, phi):
    """g of (23) at p = 1 and its derivatives in theta1 and theta2."""
    (s1, s2), (c1, c2) = np.sin(theta), np.cos(theta)
    d1, d2, d3 = phi
    g = -d2 * d1 * c1 + d3 * d1 * s1 * c2 + d3 * d2 * c1 * s2
    slope = [
        d2 * d1 * s1 + d3 * d1 * c1 * c2 - d3 * d2 * s1 * s2,
        -d3 * d1 * s1 * s2 + d3 * d2 * c1 * c2,
    ]
    return g, np.array(slope)


def factor(g, power, r2):
    """The only real root of 2 r1 g^2 p^3 + r2 p = r2 - power, by Newton's method."""
    p = np.ones_like(g)
    for _ in range(60):
        residual = 2.0 * R1 * g**2 * p**3 - r2 * (1.0 - p) + power
        p = p - residual / (6.0 * R1 * g**2 * p**2 + r2)
    assert np.abs(2.0 * R1 * g**2 * p**3 - r2 * (1.0 - p) + power).max() < 1e-11
    return p


def solve(r2):
    """Return p at times within each half, costates at 0 s, and the cost."""

    def law(s, y, late):
        phi = desired_rates(s, late)
        g, slope = component(y[:2], phi)
        return phi, g, slope, factor(g, np.sum(y[2:4] * phi[:2], axis=0), r2)

    def field(s, y):
        rates = []
        for late in (False, True):
            phi, g, slope, p = law(s, y[5 * late : 5 * late + 4], late)
            running = 0.5 * R1 * (p**2 * g) ** 2 + 0.5 * r2 * (1.0 - p) ** 2
            rates += [p * phi[:2], -R1 * p**4 * g * slope, running[None]]
        return np.vstack(rates)

    def joined(at_start, at_end):
        first = desired_angles(np.zeros(1), late=False)[:, 0]
        return np.concatenate(
            [
                at_start[:2] - first,
                at_start[4:5],
                at_end[:5] - at_start[5:],  # angles, costates and cost at 5 s
                at_end[7:9],
            ]
        )

    s = np.linspace(0.0, HALF, 101)
    guess = np.zeros((10, len(s)))
    guess[:2], guess[5:7] = desired_angles(s, late=False), desired_angles(s, late=True)
    found = solve_bvp(field, joined, s, guess, tol=1e-8, max_nodes=20_000)
    assert found.success

    def control(t):
        late = t > HALF
        y = found.sol(np.atleast_1d(t - HALF * late))
        return law(np.atleast_1d(t - HALF * late), y[5 * late : 5 * late + 4], late)[3][0]

    return control, found.y[2:4, 0], found.y[9, -1]


@pytest.mark.parametrize(("r2", "reference"), [(8.0, 0.448408), (1.0, 0.2590558)])
def test_cost_factor_and_costates(cobra, pose, solve_problem, r2, reference):
    control, costate, cost = solve(r2)
    assert cost == pytest.approx(reference, abs=1e-6)  # an earlier check's continuum values
    found = solve_problem(pose(cobra(1000), r2))
    assert found.cost == pytest.approx(cost, abs=1e-6)
    samples = [0, 100, 250, 333, 420, 480, 520, 600, 667, 800, 950, 1000]
    expected = [control(found.modified.t[k]) for k in samples]
    np.testing.assert_allclose(found.control[samples, 0], expected, rtol=0, atol=2e-4)
    np.testing.assert_allclose(found.adjoint[0, :2], costate, rtol=0, atol=2e-5)
    np.testing.assert_allclose(found.adjoint[-1], 0.0, atol=1e-9)
    np.testing.assert_allclose(found.adjoint[:, 2], 0.0, atol=1e-9)  # the cab is ignorable


def test_the_discrete_optimum_tends_to_the_exact_one(cobra, pose, solve_problem):
    cost = solve(1.0)[2]
    errors = [abs(solve_problem(pose(cobra(n), 1.0)).cost - cost) for n in (100, 200, 400)]
    assert errors[0] > 2.0 * errors[1] > 4.0 * errors[2]
    assert errors[2] < 5e-7
