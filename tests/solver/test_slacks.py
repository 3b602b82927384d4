"""Slacks of inequalities against the equations that they stand for."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.solver.slacks import FIRST_SLACK, Side, longest_step

MU, WEIGHT = 0.03, 2.5
SIGNS = pytest.mark.parametrize("sign", [1.0, -1.0])


def side_of(sign: float) -> Side:
    """A side off the central path, of six rows."""
    rng = np.random.default_rng(6)
    return Side(sign, rng.uniform(0.1, 2.0, (3, 2)), rng.uniform(0.1, 2.0, (3, 2)), WEIGHT)


@SIGNS
def test_a_side_begins_on_the_central_path(sign: float) -> None:
    value = np.array([[-0.9, 0.0], [0.5, 0.98]])
    side = Side.at(sign, value, MU, WEIGHT)
    np.testing.assert_allclose(side.slack, 1.0 - sign * value, rtol=1e-14)
    np.testing.assert_allclose(side.slack * side.dual, WEIGHT * MU, rtol=1e-14)
    np.testing.assert_allclose(side.product, MU, rtol=1e-14)
    np.testing.assert_allclose(side.excess(value), 0.0, atol=1e-15)


@SIGNS
@pytest.mark.parametrize("beyond", [0.999, 1.0, 3.0])
def test_a_value_at_its_bound_or_beyond_begins_with_a_little_slack(
    sign: float, beyond: float
) -> None:
    value = np.array([[sign * beyond]])
    side = Side.at(sign, value, MU)
    assert side.slack[0, 0] == FIRST_SLACK
    assert side.dual[0, 0] > 0.0
    assert side.excess(value)[0, 0] == pytest.approx(beyond - 1.0 + FIRST_SLACK)


def test_the_barrier_is_the_weighted_logarithm_of_the_slacks_and_its_slope() -> None:
    side, h = side_of(1.0), 1e-6
    move = np.random.default_rng(7).normal(size=side.slack.shape)
    assert side.barrier() == pytest.approx(-WEIGHT * np.log(np.prod(side.slack)), rel=1e-12)

    def barrier(length: float) -> float:
        return Side(1.0, side.slack + length * move, side.dual, WEIGHT).barrier()

    slope = (barrier(h) - barrier(-h)) / (2.0 * h)
    assert side.barrier_slope(move) == pytest.approx(slope, rel=1e-8)


@SIGNS
def test_a_step_solves_the_linearised_conditions(sign: float) -> None:
    side, rng = side_of(sign), np.random.default_rng(8)
    value, change = rng.normal(size=(2, *side.slack.shape))
    excess = side.excess(value)
    slack_move = side.slack_move(change, excess)
    dual_move = side.dual_move(MU, slack_move)
    moved = sign * (value + change) + side.slack + slack_move
    np.testing.assert_allclose(moved, 1.0, rtol=1e-13)
    complementarity = side.slack * side.dual + side.dual * slack_move + side.slack * dual_move
    np.testing.assert_allclose(complementarity, WEIGHT * MU, rtol=1e-12)


@SIGNS
def test_eliminated_slacks_take_the_same_step_as_all_unknowns_together(sign: float) -> None:
    """Minimise 1/2 h x^2 + g x with sign x + s = 1, s z = weight mu: one Newton step."""
    h, g, x, s, z = 0.7, -1.3, 0.4, 0.9, 0.25
    side = Side(sign, np.array([[s]]), np.array([[z]]), WEIGHT)
    # unknowns x, s, z: stationarity, the bound, complementarity
    matrix = np.array([[h, 0.0, sign], [sign, 1.0, 0.0], [0.0, z, s]])
    missing = [h * x + g + sign * z, sign * x + s - 1.0, s * z - WEIGHT * MU]
    expected = np.linalg.solve(matrix, np.negative(missing))
    excess = side.excess(np.array([[x]]))
    force = h * x + g + side.barrier_multiplier(MU, excess)
    change = -force / (h + side.stiffness())
    slack_move = side.slack_move(change, excess)
    found = [change, slack_move, side.dual_move(MU, slack_move)]
    np.testing.assert_allclose(np.ravel(found), expected, rtol=1e-12)


@pytest.mark.parametrize(
    ("moves", "length"),
    [
        ([1.0, 0.0, 3.0], 1.0),  # nothing shrinks
        ([-0.5, -0.5, 0.0], 1.0),  # the boundary is farther than a full step
        ([-2.0, 1.0, 0.0], 0.9 * 0.5),
        ([-2.0, -8.0, 0.0], 0.9 * 0.25),  # the nearest boundary counts
        ([-0.95, 0.0, 0.0], 0.9 / 0.95),
    ],
)
def test_the_longest_step_stops_at_a_fraction_of_the_way_out(
    moves: list[float], length: float
) -> None:
    values = np.array([1.0, 2.0, 4.0])
    found = longest_step(values, np.array(moves), 0.9)
    assert found == pytest.approx(length)
    assert np.all(values + found * np.array(moves) >= 0.1 * values - 1e-12)
