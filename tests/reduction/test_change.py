"""What was changed of the record: whether it is allowed, and what budgets it leaves."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion, Record, Shortfall
from des_cli.model.profile import Reduction
from des_cli.reduction.change import Change

T = np.linspace(0.0, 4.0, 81)
RATE, G = "seat_rate_deviation_relative", "seat_g_rms_error_g"


def motion_of(scale=1.0):
    """An arm that turns steadily and a cab that rolls, whose rate is scaled."""
    angle = np.stack([0.8 * T, 0.0 * T, 0.3 * scale * np.sin(T)], axis=1)
    rate = np.stack([np.full(81, 0.8), 0.0 * T, 0.3 * scale * np.cos(T)], axis=1)
    return Motion(T, angle, rate[:-1], rate[1:])


def change_of(scale, shortfall=None):
    record = motion_of()
    motion = record if scale == 1.0 else motion_of(scale)
    chain = chain_of(DES, Seat())
    return Change.between(Record(record, shortfall), Record(motion), chain, DES.gravity)


def closed_form(scale):
    """The seat turns with the arm in any attitude, and rolls with the cab alone."""
    roll = np.trapezoid((0.3 * (scale - 1.0) * np.cos(T)) ** 2, T)
    # the arm's rate is seen along other axes where the cab is off
    apart = np.trapezoid((2.0 * 0.8 * np.sin(0.15 * (scale - 1.0) * np.sin(T))) ** 2, T)
    size = np.trapezoid(0.8**2 + (0.3 * np.cos(T)) ** 2, T)
    return np.sqrt((roll + apart) / size)


def test_the_record_itself_is_no_change():
    change = change_of(1.0)
    assert change.nothing
    assert change.refusal(Reduction()) == ""
    assert change.left(Reduction()) == (Reduction().budget, "")


def test_a_change_is_told_and_refused_beyond_what_is_allowed():
    assert change_of(1.2).refusal(Reduction()) == ""
    change = change_of(1.5)
    assert change.deviation.value(RATE) == pytest.approx(closed_form(1.5), rel=1e-6)
    told = change.refusal(Reduction())
    assert f"{100 * closed_form(1.5):.1f} % of its seat rate" in told
    enough = np.ceil(100 * closed_form(1.5)) / 100
    assert told.endswith(f"--allow-change {enough:g}")
    assert change.refusal(Reduction(allow_change=enough)) == ""
    assert change.refusal(Reduction(allow_change=0.9 * closed_form(1.5))) != ""
    # who has set a budget of more has allowed it
    assert change.refusal(Reduction(budget=(Budget(RATE, 0.3),))) == ""


def test_what_the_joints_do_not_make_is_a_change_too():
    missing = np.zeros((80, 2, 3))
    missing[..., 1] = 0.4
    shortfall = Shortfall(missing, 0.0 * missing, 0.0 * missing, np.zeros((81, 3)))
    change = change_of(1.0, shortfall)
    assert not change.nothing
    # the joints make q = -0.8 sin(cab) along y
    made = 0.8**2 + (0.3 * np.cos(T)) ** 2
    asked = made + 0.4**2 - 2.0 * 0.4 * 0.8 * np.sin(0.3 * np.sin(T))
    expected = np.sqrt(0.4**2 * 4.0 / np.trapezoid(asked, T))
    assert change.deviation.value(RATE) == pytest.approx(expected, rel=1e-9)
    assert change.refusal(Reduction()) != ""


def test_an_allowed_change_leaves_budgets_as_what_is_added():
    reduction = Reduction(allow_change=0.5)
    assert change_of(1.5).left(reduction) == (reduction.budget, "")


def test_what_a_change_leaves_of_budgets():
    change = change_of(1.05)
    off, force = change.deviation.value(RATE), change.deviation.value(G)
    safe, trouble = change.left(Reduction())
    assert trouble == ""
    left = {b.metric: b.most for b in safe}
    assert left[G] == pytest.approx(0.05 - force)
    assert left[RATE] == pytest.approx((0.1 - off) / (1.0 + off))
    ratios = {b.metric: b.most for b in Reduction().budget if b.metric not in (RATE, G)}
    assert {metric: left[metric] for metric in ratios} == ratios
    measured = {b.metric: b.most for b in change.left(Reduction(), measured=True)[0]}
    assert np.hypot(measured[G], force) == pytest.approx(0.05)


def test_a_squared_budget_is_left_by_its_root():
    squared = "joint_deviation_relative_squared"
    change = change_of(1.05)
    spent = np.sqrt(change.deviation.value(squared))
    (left,), _ = change.left(Reduction(budget=(Budget(squared, 0.01),)))
    assert np.sqrt(left.most) * (1.0 + spent) + spent == pytest.approx(0.1)


def test_what_is_overspent_is_told_with_the_share_to_allow():
    change = change_of(1.5)
    budgets, told = change.left(Reduction(budget=(Budget(G, 1e-4), Budget(RATE, 0.9))))
    assert budgets == (Budget(G, 1e-4), Budget(RATE, 0.9))
    assert told.startswith(
        f"smoothing alone spends G error {change.deviation.value(G):.3g} of 0.0001;"
    )
    assert f"--allow-change {np.ceil(100 * closed_form(1.5)) / 100:g} " in told
