"""What a problem hands to the interior-point method."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from des_cli.model.arrays import Floats
from des_cli.solver.program import Expansion, Measure, Rows

N, WIDTH = 5, 4


def expansion_of(seed: int, across: bool = True, curvature: bool = True) -> Expansion:
    """An expansion of random numbers, with or without what is optional."""
    rng = np.random.default_rng(seed)
    return Expansion(
        float(rng.normal()),
        rng.normal(size=(N, WIDTH)),
        rng.normal(size=(N, WIDTH, WIDTH)),
        rng.normal(size=(N - 1, WIDTH, WIDTH)) if across else None,
        rng.normal(size=(N, WIDTH, WIDTH)) if curvature else None,
    )


def model(expansion: Expansion, step: Floats) -> float:
    """The value that an expansion to second order gives a step."""
    value = expansion.cost + float(np.sum(expansion.gradient * step))
    for k in range(N):
        value += 0.5 * step[k] @ expansion.hessian[k] @ step[k]
        if expansion.curvature is not None:
            value += 0.5 * step[k] @ expansion.curvature[k] @ step[k]
        if expansion.across is not None and k + 1 < N:
            value += step[k] @ expansion.across[k] @ step[k + 1]
    return float(value)


@pytest.mark.parametrize(
    ("left", "right"), list(product(product([False, True], repeat=2), repeat=2))
)
def test_a_sum_of_expansions_is_the_expansion_of_the_sum(
    left: tuple[bool, bool], right: tuple[bool, bool]
) -> None:
    one, other, price = expansion_of(1, *left), expansion_of(2, *right), 0.7
    total = one.plus(price, other)
    step = np.random.default_rng(3).normal(size=(N, WIDTH))
    assert model(total, step) == pytest.approx(model(one, step) + price * model(other, step))
    # what neither has stays out
    assert (total.across is None) == (not left[0] and not right[0])
    assert (total.curvature is None) == (not left[1] and not right[1])


def test_adding_leaves_both_as_they_were() -> None:
    one, other = expansion_of(1), expansion_of(2)
    one.plus(0.7, other)
    for found, seed in ((one, 1), (other, 2)):
        same = expansion_of(seed)
        assert found.cost == same.cost
        for name in ("gradient", "hessian", "across", "curvature"):
            np.testing.assert_array_equal(getattr(found, name), getattr(same, name))


class Straight(Rows):
    """The first unknown itself."""

    def value(self, x: Floats) -> Floats:
        return x[self.node, :1]

    def jacobian(self, x: Floats) -> tuple[Floats, ...]:
        return (np.tile(np.eye(1, x.shape[1]), (len(self.node), 1, 1)),)


def test_rows_are_straight_unless_they_say_otherwise() -> None:
    node = np.array([0, 2, 3])
    rows = Straight(node)
    assert rows.node is node
    assert rows.curvature(np.ones((N, WIDTH)), np.ones((3, 1))) is None


@pytest.mark.parametrize("kind", [Rows, Measure])
def test_rows_and_measures_must_say_what_they_are(kind: type) -> None:
    with pytest.raises(TypeError, match="abstract"):
        kind()
