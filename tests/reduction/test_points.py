"""Where a cost is evaluated: sums over points against sums over sides of intervals."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from des_cli.model.motion import Motion
from des_cli.reduction.points import Points


def test_every_sample_is_a_point_and_one_where_the_rate_steps_is_two(uneven: Motion) -> None:
    points = Points.of(uneven)
    stepping = [3, 6]
    np.testing.assert_array_equal(points.node, [*range(9), *stepping])
    np.testing.assert_array_equal(points.node[points.start], np.arange(8))
    np.testing.assert_array_equal(points.node[points.end], np.arange(1, 9))
    np.testing.assert_array_equal(points.rate[points.start], uneven.rate_start)
    np.testing.assert_array_equal(points.rate[points.end], uneven.rate_end)


def test_a_sum_over_points_is_the_trapezoidal_rule_over_both_sides(uneven: Motion) -> None:
    points = Points.of(uneven)
    found = points.weight @ np.sin(points.rate)
    expected = np.zeros(3)
    for k, step in enumerate(np.diff(uneven.t)):
        expected += 0.5 * step * (np.sin(uneven.rate_start[k]) + np.sin(uneven.rate_end[k]))
    np.testing.assert_allclose(found, expected, rtol=1e-13)


def test_scattering_is_the_transpose_of_gathering(uneven: Motion) -> None:
    points, rng = Points.of(uneven), np.random.default_rng(1)
    at_samples, at_points = rng.normal(size=(9, 2)), rng.normal(size=(11, 2))
    gathered = points.gather(at_samples)
    np.testing.assert_array_equal(gathered[:9], at_samples)
    np.testing.assert_array_equal(gathered[9:], at_samples[[3, 6]])
    before = at_points.copy()
    total = points.scatter(at_points, 9)
    assert np.sum(total * at_samples) == pytest.approx(np.sum(at_points * gathered), rel=1e-13)
    np.testing.assert_array_equal(at_points, before)


def test_without_steps_the_points_are_the_samples(wave: Callable[..., Motion]) -> None:
    motion = wave([[0.5, 0.2], [0.2, 0.3], [0.2, -0.2]], intervals=6)
    points, values = Points.of(motion), np.arange(7.0)
    np.testing.assert_array_equal(points.node, np.arange(7))
    assert points.gather(values) is values
    np.testing.assert_array_equal(points.scatter(values, 7), values)
    np.testing.assert_array_equal(points.end, np.arange(1, 7))


def test_a_step_of_one_joint_alone_is_one() -> None:
    rate = np.zeros((2, 2, 3))
    rate[1, :, 2] = 1e-12
    points = Points.of(Motion(np.array([0.0, 1.0, 3.0]), np.zeros((3, 3)), rate[:, 0], rate[:, 1]))
    np.testing.assert_array_equal(points.node, [0, 1, 2, 1])
    np.testing.assert_array_equal(points.weight, [0.5, 1.0, 1.0, 0.5])
