"""How late lines were, in words."""

from __future__ import annotations

import pytest

from des_cli.feed.lateness import Lateness


def of(*late: int) -> Lateness:
    lateness = Lateness()
    for each in late:
        lateness.add(each)
    return lateness


@pytest.mark.parametrize(
    ("share", "expected"), [(0.01, 1e-3), (0.5, 50e-3), (0.99, 99e-3), (1.0, 100e-3)]
)
def test_quantiles(share: float, expected: float) -> None:
    assert of(*(1_000_000 * n for n in range(100, 0, -1))).quantile(share) == expected


def test_words() -> None:
    assert str(of(2_000_000, 1_000_000, 30_500_000)) == (
        "3 rows, late by 2.000 ms (median), 30.500 ms (99 %), 30.500 ms (most)"
    )
    assert str(of(1_000)) == "1 row, late by 0.001 ms (median), 0.001 ms (99 %), 0.001 ms (most)"
    assert of().quantile(0.5) == 0.0
