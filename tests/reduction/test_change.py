"""What was changed of the record: whether it is allowed, and what budgets it leaves."""

from __future__ import annotations

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.metric import Budget
from des_cli.model.motion import Motion, Shortfall
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
    return Change.between(record, motion, chain_of(DES, Seat()), DES.gravity, shortfall)


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
    assert change.widened(Reduction(allow_change=0.5)) == Reduction().budget


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


def test_budgets_beside_an_allowed_change_are_what_is_added():
    change = change_of(1.5)
    reduction = Reduction(allow_change=0.5)
    widened = {b.metric: b.most for b in change.widened(reduction)}
    for budget in reduction.budget:
        value = change.deviation.value(budget.metric)
        if budget.metric in (RATE, G):
            assert widened[budget.metric] ** 2 == pytest.approx(value**2 + budget.most**2)
        else:
            assert widened[budget.metric] == pytest.approx(budget.most * value)
    seen = {b.metric: b.most for b in change.widened(reduction, {RATE: 0.7})}
    assert seen[RATE] == pytest.approx(np.hypot(0.7, 0.1))
    assert change.widened(Reduction()) == Reduction().budget
