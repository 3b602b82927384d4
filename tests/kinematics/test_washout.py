"""The washout of rates, against a general simulation of linear systems."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import lsim
from scipy.spatial.transform import Rotation

from des_cli.kinematics.washout import seen_turned, washed_rotation

T = 2.0


def rotation_of(t: np.ndarray, rate: np.ndarray) -> np.ndarray:
    sides = np.stack([rate[:-1], rate[1:]], axis=1)[..., None]
    return washed_rotation(np.diff(t), sides, T)[:, 0]


def test_it_is_the_filter_of_its_equation() -> None:
    t = np.linspace(0.0, 20.0, 1001)
    rate = np.sin(1.3 * t) * np.minimum(t / 3.0, 1.0)
    # d = s / (s + 1/T)^2 w
    exact = lsim(([1.0, 0.0], [1.0, 2.0 / T, 1.0 / T**2]), rate, t)[1]
    np.testing.assert_allclose(rotation_of(t, rate), exact, atol=2e-4)


def test_uneven_steps_make_the_same_rotation() -> None:
    even = np.linspace(0.0, 10.0, 2001)
    uneven = np.unique(np.concatenate([even[::3], even[::7], even[-1:]]))
    fine, coarse = (rotation_of(t, np.sin(t) - np.sin(0.0)) for t in (even, uneven))
    np.testing.assert_allclose(coarse, np.interp(uneven, even, fine), atol=1e-4)


def test_a_steady_rate_leaves_no_tilt_and_a_fast_one_is_integrated() -> None:
    t = np.linspace(0.0, 30.0, 1501)
    assert np.abs(rotation_of(t, np.full_like(t, 0.4))).max() < 1e-14
    step = rotation_of(t, np.where(t < 5.0, 0.0, 0.4))
    assert step[-1] == pytest.approx(0.0, abs=1e-4)
    early = (t >= 5.0) & (t < 5.1)
    np.testing.assert_allclose(step[early], 0.4 * (t[early] - 5.0), atol=0.006)


def test_a_step_of_the_rate_between_two_sides_is_one() -> None:
    rates = np.array([[[0.0], [0.0]], [[1.0], [1.0]]])
    found = washed_rotation(np.array([1.0, 0.5]), rates, T)[-1, 0]
    assert found == pytest.approx(0.5 * np.exp(-0.5 / T), rel=0.01)  # s e^(-s/T), of a step


def test_vectors_are_seen_along_turned_axes() -> None:
    rng = np.random.default_rng(3)
    turn, vectors = rng.normal(size=(2, 20, 3))
    turn[0] = 0.0
    expected = Rotation.from_rotvec(turn).inv().apply(vectors)
    np.testing.assert_allclose(seen_turned(turn, vectors), expected, atol=1e-14)
