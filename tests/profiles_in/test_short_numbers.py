"""Numbers that are short and read back to the last bit."""

from __future__ import annotations

import math

import numpy as np
import pytest

from des_cli.profiles_in.short_numbers import shortest_unit


@pytest.mark.parametrize(
    ("suffixes", "value", "suffix", "text"),
    [
        (("rad", "deg"), 2.0 * math.pi, "deg", "360"),
        (("rad_s", "deg_s"), math.radians(225.0), "deg_s", "225"),
        (("rad_s2", "deg_s2"), 0.63, "rad_s2", "0.63"),
        (("m", "ft"), 0.0, "m", "0"),
        (("rad", "deg"), 1e-7, "rad", "1e-07"),
    ],
)
def test_the_unit_in_which_a_number_is_short(suffixes, value, suffix, text) -> None:
    unit, texts = shortest_unit(suffixes, [value])
    assert (unit.suffix, texts) == (suffix, [text])


def test_one_unit_is_short_for_all_values() -> None:
    # the second value is no short number of feet
    assert shortest_unit(("m", "ft"), [19 * 0.3048, 2.5])[0].suffix == "m"


def test_every_double_reads_back() -> None:
    rng = np.random.default_rng(3)
    for value in (rng.normal(size=300) * 10.0 ** rng.integers(-8, 8, 300)).tolist():
        unit, (text,) = shortest_unit(("rad", "deg"), [value])
        assert float(text) * unit.to_si == value
