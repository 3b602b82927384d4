"""Motions at the edge of what is valid: released, or refused for the true reason."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.errors import NoSolutionError
from des_cli.model.machines import DES
from des_cli.model.profile import JointCommands, Profile, Reduction
from des_cli.pipeline import reduce_profile


def joints(t, arm, fork, cab, **reduction):
    """A maneuver by expressions of time, with exact rates by a fine central difference."""
    t, h = np.asarray(t), 1e-6
    angle = [np.broadcast_to(of(t), t.shape) for of in (fork, cab)]
    rate = np.stack([(of(t + h) - of(t - h)) / (2.0 * h) + 0.0 * t for of in (fork, cab)], axis=1)
    command = JointCommands(
        arm_rate=np.broadcast_to(arm(t), t.shape),
        position=np.stack(angle, axis=1),
        rate_start=rate[:-1],
        rate_end=rate[1:],
    )
    return Profile("joints", t, command, DES, reduction=Reduction(**reduction))


METHODS = [
    {},
    {"control": "per-joint"},
    {"control": "scalar"},
    {"control": "scalar", "budget": ()},
    {"control": "per-joint", "method": "zero", "budget": ()},
]
TEN_MS = np.linspace(0.0, 5.0, 501)


@pytest.mark.parametrize("reduction", METHODS, ids=str)
@pytest.mark.parametrize(
    "motion",
    [
        (lambda t: 0.0 * t, lambda t: 0.0, lambda t: 0.0),
        (lambda t: 1.0 + 0.2 * np.sin(t), lambda t: 0.5, lambda t: 0.3),
        (lambda t: 0.0 * t, lambda t: 0.3 * np.sin(t), lambda t: 0.3),
        (lambda t: 1e-6 + 0.0 * t, lambda t: 0.3 * np.sin(t), lambda t: 0.0),
    ],
    ids=["rest", "arm", "fork", "almost the fork alone"],
)
def test_a_motion_without_cross_coupling_is_released(motion, reduction):
    run = reduce_profile(joints(TEN_MS, *motion, **reduction))
    run.require_release()
    if reduction.get("method") != "zero":
        assert "makes no cross-coupling: it is passed through" in run.solution.message
        np.testing.assert_array_equal(run.solution.modified.angle[:, 1:], run.desired.angle[:, 1:])


STOP = DES.limits[1].angle


@pytest.mark.parametrize(
    "reduction",
    [{"control": "scalar"}, {"control": "scalar", "budget": ()}, {"hold": frozenset({"fork"})}],
    ids=["scalar", "weights", "free"],
)
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_joint_that_stands_at_its_stop_is_no_obstacle(side, reduction):
    motion = (lambda t: 1.0 + 0.0 * t, lambda t: side * STOP, lambda t: 0.2 * np.sin(t))
    run = reduce_profile(joints(TEN_MS, *motion, **reduction))
    run.require_release()
    assert run.results.coriolis.reduction("vector") > 0.01
    np.testing.assert_array_equal(run.commands.angle[:, 1], side * STOP)


@pytest.mark.parametrize(
    ("motion", "why"),
    [
        (
            (lambda t: 1.0 + 0.0 * t, lambda t: STOP - 0.1 * t**2, lambda t: 0.2 * np.sin(t)),
            r"the fork is 6\.283185 rad at the start, at its limit .* hold the fork",
        ),
        (
            (lambda t: 5.86 - 0.01 * t**2, lambda t: 0.1 * np.sin(t), lambda t: 0.0),
            r"the arm turns with 5\.86 rad/s at the start, at its limit .* hold the arm",
        ),
    ],
    ids=["angle", "rate"],
)
def test_a_free_motion_that_starts_at_a_limit_is_refused_for_that(motion, why):
    with pytest.raises(NoSolutionError, match=why):
        reduce_profile(joints(TEN_MS, *motion)).require_release()


SWAY = (lambda t: 1.0 + 0.0 * t, lambda t: 0.3 * np.sin(t), lambda t: 0.2 * np.cos(t))


def test_steps_of_a_microsecond():
    """The rates of a table keep a jerk limit whose rounding they are divided by 1e-12 for."""
    reduce_profile(joints(np.linspace(0.0, 0.02, 20_001), *SWAY)).require_release()


@pytest.mark.parametrize(
    ("step", "reduction", "enough"),
    [(1e-9, {}, "5.3e-08"), (1e-4, {"control": "scalar"}, "0.00031")],
)
def test_steps_in_which_rounding_is_all_are_refused_for_that(step, reduction, enough):
    t = step * np.arange(1001.0)
    why = f"a step of {step:.3g} s.* too short to hold the arm's jerk in.* steps of {enough} s or"
    with pytest.raises(NoSolutionError, match=why):
        reduce_profile(joints(t, *SWAY, **reduction)).require_release()


def test_steps_that_differ_by_a_million():
    rng = np.random.default_rng(1)
    t = np.concatenate([[0.0], np.cumsum(10.0 ** rng.uniform(-7.0, -1.3, 400))])
    step = np.diff(t)
    assert step.max() / step.min() > 3e5
    reduce_profile(joints(t, *SWAY)).require_release()


@pytest.mark.parametrize("control", ["free", "scalar"])
def test_an_hour(control):
    t = np.linspace(0.0, 3600.0, 721)
    w = 2.0 * np.pi / 1800.0
    slow = (lambda t: 1.0 + 0.1 * np.sin(w * t), lambda t: 0.3 * np.sin(w * t), lambda t: 0.0)
    reduce_profile(joints(t, *slow, control=control)).require_release()
