"""Curves for the screen: thinned with all their peaks, and packed."""

from __future__ import annotations

import base64

import numpy as np

from des_cli.show.page.curves import Family
from des_cli.show.page.packing import pack, pack_family, thin_family


def test_every_peak_of_every_curve_stays_at_its_time() -> None:
    t = np.linspace(0.0, 10.0, 20_001)
    generator = np.random.default_rng(3)
    values = {name: generator.normal(size=len(t)).cumsum() for name in "abc"}
    values["a"][7000], values["b"][7001] = 1e4, -1e4
    thin = thin_family(Family(t, values), 100)
    assert len(thin.t) <= 4 * 100
    assert (thin.t[0], thin.t[-1]) == (0.0, 10.0)
    for name, each in values.items():
        assert thin.values[name].max() == each.max()
        assert thin.values[name].min() == each.min()
        assert t[each.argmax()] in thin.t
    assert set(np.diff(np.searchsorted(t, thin.t)) > 0) == {True}


def test_few_rows_stay_as_they_are() -> None:
    family = Family(np.arange(50.0), {"a": np.arange(50.0) ** 2})
    assert thin_family(family, 25) is family


def test_numbers_are_packed_as_little_floats_counted_from_the_start() -> None:
    packed = pack_family(Family(np.array([7.5, 8.0]), {"a": np.array([0.1, -2.0])}), 7.5)
    assert list(packed) == ["t", "a"]
    read = {name: np.frombuffer(base64.b64decode(text), "<f4") for name, text in packed.items()}
    assert read["t"].tolist() == [0.0, 0.5]
    np.testing.assert_array_equal(read["a"], np.float32([0.1, -2.0]))
    assert np.isinf(np.frombuffer(base64.b64decode(pack(np.array([1e300]))), "<f4"))[0]
