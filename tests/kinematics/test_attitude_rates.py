"""Body rates of an attitude, against a turning body's closed form and scipy's rotations."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from des_cli.kinematics.attitude_rates import CLOSENESS, rates_of_attitude, turns_between
from des_cli.model.profile import BodyRates


def tumbling(t: np.ndarray) -> Rotation:
    about_z = Rotation.from_euler("z", (0.5 * t)[:, None])
    return about_z * Rotation.from_euler("x", (0.8 * t + 0.3 * np.sin(1.3 * t))[:, None])


def body_rates(t: np.ndarray) -> np.ndarray:
    """Of `tumbling`: x' along x, and the turn about z seen from the body."""
    x = 0.8 * t + 0.3 * np.sin(1.3 * t)
    return np.column_stack([0.8 + 0.39 * np.cos(1.3 * t), 0.5 * np.sin(x), 0.5 * np.cos(x)])


def quaternions(turn: Rotation) -> np.ndarray:
    return turn.as_quat()[:, [3, 0, 1, 2]]


def flown(t: np.ndarray, rates: BodyRates, parts: int = 40) -> Rotation:
    """Compose small turns of the parabola through start, middle and end of each interval."""
    found = [Rotation.identity()]
    s = (np.arange(parts) + 0.5) / parts
    weight = np.stack([(1 - s) * (1 - 2 * s), 4 * s * (1 - s), s * (2 * s - 1)], axis=1)
    for k, step in enumerate(np.diff(t)):
        turn = found[-1]
        for small in weight @ [rates.start[k], rates.middle[k], rates.end[k]]:
            turn = turn * Rotation.from_rotvec(small * step / parts)
        found.append(turn)
    return Rotation.concatenate(found)


def test_rates_are_those_of_the_body_along_its_own_axes() -> None:
    t = np.arange(0.0, 10.0, 0.02)
    times, rates = rates_of_attitude(t + 1e5, quaternions(tumbling(t)))
    assert len(times) == len(t)
    np.testing.assert_allclose(rates.start[20:-20], body_rates(t[20:-21]), atol=1e-6)
    middle = body_rates(0.5 * (t[:-1] + t[1:]))
    np.testing.assert_allclose(rates.middle[20:-20], middle[20:-20], atol=1e-5)


@pytest.mark.parametrize(("step", "inserted"), [(0.02, False), (0.2, True), (0.7, True)])
def test_the_rates_turn_the_body_through_every_recorded_attitude(
    step: float, inserted: bool
) -> None:
    rng = np.random.default_rng(2)
    t = np.arange(0.0, 14.0, step) + 0.2 * step * rng.random(len(np.arange(0.0, 14.0, step)))
    turn = tumbling(t)
    times, rates = rates_of_attitude(t, quaternions(turn))
    assert (len(times) > len(t)) == inserted
    assert rates.attitude is not None
    recorded = ~np.isnan(rates.attitude[:, 0])
    np.testing.assert_array_equal(times[recorded], t)
    assert np.all(np.diff(times) > 0)
    missed = (flown(times, rates)[recorded].inv() * (turn[0].inv() * turn)).magnitude()
    assert np.max(missed) <= CLOSENESS
    # between the rows the spline bends as far as it sees; at 5 Hz it sees enough
    if step <= 0.2:
        np.testing.assert_allclose(rates.start[20:-20], body_rates(times[20:-21]), atol=5e-3)


def test_the_sign_of_a_quaternion_means_nothing() -> None:
    t = np.arange(0.0, 5.0, 0.05)
    attitude = quaternions(tumbling(t))
    sign = np.random.default_rng(3).choice([-1.0, 1.0], len(t))[:, None]
    (_, plain), (_, flipped) = rates_of_attitude(t, attitude), rates_of_attitude(t, sign * attitude)
    np.testing.assert_allclose(flipped.start, plain.start, atol=1e-10)
    np.testing.assert_allclose(flipped.middle, plain.middle, atol=1e-10)


def test_two_rows_are_one_turn_at_a_constant_rate() -> None:
    attitude = quaternions(Rotation.from_rotvec([[0, 0, 0], [0.6, 0, 0]]))
    times, rates = rates_of_attitude(np.array([1.0, 3.0]), attitude)
    np.testing.assert_array_equal(times, [1.0, 3.0])
    np.testing.assert_allclose(rates.middle, [[0.3, 0, 0]], atol=1e-12)


def test_turns_between_rows() -> None:
    turn = Rotation.from_rotvec([[0, 0, 0], [1.2, 0, 0], [1.2, 0, 0]])
    attitude = quaternions(turn) * [[1], [-1], [1]]
    np.testing.assert_allclose(turns_between(attitude), [1.2, 0.0], atol=1e-7)
