"""Motions between their samples."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.model.motion import Motion
from des_cli.reduction.reference import sample_motion
from tests.support.free_motions import smooth


def test_linear_rates_give_parabolas(wave):
    motion = wave([[0.3, 0.1], [0.2, -0.1], [0.1, 0.2]], intervals=7)
    t = np.random.default_rng(0).uniform(motion.t[0], motion.t[-1], 50)
    angle, rate, acceleration = sample_motion(motion, t)
    k = np.searchsorted(motion.t, t, side="right") - 1
    s = (t - motion.t[k])[:, None]
    np.testing.assert_allclose(acceleration, motion.acceleration[k], atol=1e-12)
    np.testing.assert_allclose(rate, motion.rate_start[k] + s * acceleration, atol=1e-13)
    expected = motion.angle[k] + s * motion.rate_start[k] + 0.5 * s**2 * acceleration
    np.testing.assert_allclose(angle, expected, atol=1e-13)


def test_samples_are_met_from_their_right_side(uneven):
    angle, rate, _ = sample_motion(uneven, uneven.t)
    np.testing.assert_allclose(angle, uneven.angle, rtol=0, atol=1e-13)
    np.testing.assert_allclose(rate[:-1], uneven.rate_start, rtol=0, atol=1e-12)
    np.testing.assert_allclose(rate[-1], uneven.rate_end[-1], rtol=0, atol=1e-12)
    just_before = np.nextafter(uneven.t[1:], 0.0)
    _, rate, _ = sample_motion(uneven, just_before)
    np.testing.assert_allclose(rate, uneven.rate_end, rtol=0, atol=1e-12)


def test_rates_and_accelerations_are_derivatives(uneven):
    t, h = np.linspace(uneven.t[0] + 0.01, uneven.t[-1] - 0.01, 31), 1e-6
    t = t[np.min(np.abs(t[:, None] - uneven.t), axis=1) > 2 * h]
    ahead, behind = sample_motion(uneven, t + h), sample_motion(uneven, t - h)
    _, rate, acceleration = sample_motion(uneven, t)
    np.testing.assert_allclose((ahead[0] - behind[0]) / (2 * h), rate, atol=1e-7)
    np.testing.assert_allclose((ahead[1] - behind[1]) / (2 * h), acceleration, atol=1e-6)


@pytest.mark.parametrize(("what", "order"), [(0, 4), (1, 3), (2, 2)])
def test_samples_of_something_smooth_are_met_to_an_order(what, order):
    t = np.linspace(0.0, 4.0, 997)
    exact = np.stack([np.sin(1.3 * t), 1.3 * np.cos(1.3 * t), -(1.3**2) * np.sin(1.3 * t)])[what]
    errors = []
    for intervals in (20, 40):
        at = np.linspace(0.0, 4.0, intervals + 1)
        angle = np.repeat(np.sin(1.3 * at)[:, None], 3, axis=1)
        rate = np.repeat(1.3 * np.cos(1.3 * at)[:, None], 3, axis=1)
        found = sample_motion(Motion(at, angle, rate[:-1], rate[1:]), t)[what][:, 0]
        errors.append(np.max(np.abs(found - exact)))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.3)


def test_the_motion_itself_does_not_depend_on_how_finely_it_is_sampled():
    coarse, fine = smooth(100), smooth(1600)
    t = np.linspace(0.0, 4.0, 333)
    for one, other, most in zip(
        sample_motion(coarse, t), sample_motion(fine, t), (1e-8, 1e-6, 1e-3), strict=True
    ):
        np.testing.assert_allclose(one, other, rtol=0, atol=most)
