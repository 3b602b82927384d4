"""From what a profile asks for to the program: every budget is its metric, squared."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.coriolis import coriolis
from des_cli.kinematics.response import respond_on
from des_cli.model.machine import OccupantBounds
from des_cli.model.machines import DES
from des_cli.model.metric import PEAK_METRICS
from des_cli.model.motion import Shortfall
from des_cli.model.profile import Reduction
from des_cli.reduction.executable import ExecutableSpline, sample_spline
from des_cli.reduction.fidelity import Deviation
from des_cli.reduction.free.pose import cross_coupling, in_ground_axes
from des_cli.reduction.free.task import turned_seat
from tests.support.free_motions import fit, program_of, smooth, sway, task_of

INTERVALS = 40
MOST = {
    "joint_deviation_relative": 0.3,
    "joint_deviation_relative_squared": 0.02,
    "seat_rate_deviation_relative": 0.7,
    "seat_g_deviation_relative": 0.4,
    "seat_g_rms_error_g": 0.2,
    "seat_angular_acceleration_deviation_relative": 0.8,
    "seat_angular_acceleration_rms_error_rad_s2": 0.3,
    "seat_angular_acceleration_rms_ratio": 1.3,
    "seat_angular_acceleration_peak_ratio": 3.0,
    "attitude_error_max_deg": 20.0,
}
DESIRED = smooth(4000)


def moved(task, program, x):
    """The table that a vector is."""
    spline = fit(task, INTERVALS)
    control = spline.control + program.control(x)
    return sample_spline(ExecutableSpline(spline.grid, control), DESIRED.t)


@pytest.mark.parametrize("metric", MOST)
def test_budgets_are_their_metrics_on_the_table(metric):
    task = task_of(DESIRED, {metric: MOST[metric]})
    program = program_of(task, INTERVALS)
    x = sway(program)
    modified = moved(task, program, x)
    deviation = Deviation.between(DESIRED, modified, (task.chain, task.chain), DES.gravity)
    values = program.values(x)
    share = deviation.value(metric) / MOST[metric]
    if metric == "joint_deviation_relative_squared":
        assert values.budgets[0] == pytest.approx(share, rel=5e-3)
    elif metric in PEAK_METRICS:
        assert values.budgets.size == 0
        # the points lie between the samples: a peak is a little higher
        assert np.sqrt(values.local.max()) == pytest.approx(share, rel=3e-2)
        assert np.sqrt(values.local.max()) <= share * (1.0 + 1e-3)
    else:
        assert np.sqrt(values.budgets[0]) == pytest.approx(share, rel=5e-3)


def wide_shortfall():
    """Something asked for beyond the desired motion, in everything that is felt."""
    t = DESIRED.t
    wave = np.stack([np.sin(t), 0.5 * np.cos(2.0 * t), 0.3 * np.sin(1.5 * t)], axis=1)
    sides = np.stack([wave[:-1], wave[1:]], axis=1)
    return Shortfall(0.2 * sides, 0.3 * sides, 0.1 * sides, 0.05 * wave)


@pytest.mark.parametrize("metric", [metric for metric in MOST if "joint" not in metric])
def test_budgets_are_against_all_that_is_asked_for(metric):
    missing = wide_shortfall()
    task = replace(task_of(DESIRED, {metric: MOST[metric]}), shortfall=missing)
    program = program_of(task, INTERVALS)
    x = sway(program)
    chains = (task.chain, task.chain)
    shares = [
        Deviation.between(
            DESIRED, moved(task, program, x), chains, DES.gravity, shortfall=each
        ).value(metric)
        / MOST[metric]
        for each in (missing, None)
    ]
    assert shares[0] != pytest.approx(shares[1], rel=3e-2)
    values = program.values(x)
    found = values.local.max() if metric in PEAK_METRICS else values.budgets[0]
    assert np.sqrt(found) == pytest.approx(shares[0], rel=3e-2 if metric in PEAK_METRICS else 1e-2)


@pytest.mark.parametrize("axes", ["seat", "report"])
@pytest.mark.parametrize("r1", [2.0 * np.eye(3), np.diag([0.0, 2.0, 0.5])], ids=["all", "some"])
def test_the_cost_is_what_is_left_of_the_cross_coupling(axes, r1):
    task = task_of(DESIRED, {}, axes=axes, r1=r1)
    program = program_of(task, INTERVALS, smoothing=np.zeros(3))
    assert (program.problem.ground is not None) == (axes == "report" and r1[0, 0] == 0.0)
    assert in_ground_axes(task.reduction) == (program.problem.ground is not None)
    x = sway(program)
    energies = []
    for motion in (DESIRED, moved(task, program, x)):
        c = coriolis(task.chain, motion.angle_sides, motion.rate_sides, axes)
        running = np.einsum("kxi,ij,kxj->kx", c, r1, c)
        energies.append(np.sum(0.5 * motion.step[:, None] * running))
    assert cross_coupling(task, program.problem.grid) == pytest.approx(energies[0], rel=1e-4)
    assert program.values(x).cost == pytest.approx(energies[1] / energies[0], rel=2e-3)


@pytest.mark.parametrize("objective", ["felt", "blend"])
def test_the_felt_error_is_from_the_desired_motion_without_its_cross_coupling(objective):
    task = task_of(DESIRED, {}, objective=objective)
    program = program_of(task, INTERVALS, smoothing=np.zeros(3))
    x = sway(program)
    before, after = (
        respond_on(task.chain, DES.gravity, motion) for motion in (DESIRED, moved(task, program, x))
    )
    off = after.seat_angular_acceleration - (
        before.seat_angular_acceleration - before.coriolis_seat
    )
    felt, left, size = (
        np.sum(0.5 * DESIRED.step[:, None] * np.sum(v**2, axis=-1))
        for v in (off, after.coriolis_seat, before.coriolis_seat)
    )
    expected = felt / size if objective == "felt" else (left + 0.1 * felt) / size
    assert program.values(x).cost == pytest.approx(expected, rel=3e-3)


def test_what_is_not_enforced_is_not_bounded():
    occupant = OccupantBounds(gx=(-1.0, 1.0))
    task = task_of(DESIRED, {}, replace(DES, occupant=occupant), limits="warn")
    program = program_of(task, INTERVALS)
    assert program.bounds.size == 0
    assert program.values(np.zeros(program.size)).local.size == 0


def test_the_seats_budgets_are_those_of_the_turned_seat():
    change = np.array([0.05, -0.03])
    metric = {"seat_g_rms_error_g": 0.2, "seat_rate_deviation_relative": 0.7}
    task = task_of(DESIRED, metric, optimise=("seat_yaw", "seat_pitch"))
    program = program_of(task, INTERVALS)
    x = sway(program)
    x[-2:] = change
    chains = task.chain, chain_of(DES, turned_seat(task, change))
    deviation = Deviation.between(DESIRED, moved(task, program, x), chains, DES.gravity)
    expected = [(deviation.value(key) / most) ** 2 for key, most in metric.items()]
    np.testing.assert_allclose(program.values(x).budgets, expected, rtol=1e-2)


def test_the_same_weight_in_all_axes_needs_none_of_them():
    assert not in_ground_axes(Reduction(axes="report"))
    assert in_ground_axes(Reduction(axes="report", r1=np.diag([0.0, 2.0, 0.0])))
    assert not in_ground_axes(Reduction(axes="seat", r1=np.diag([0.0, 2.0, 0.0])))
