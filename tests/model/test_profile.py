"""What a profile may ask for, and what a silent one gets."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from des_cli.model.machines import DES
from des_cli.model.profile import (
    FELT_BUDGETS,
    BodyRates,
    GCommand,
    JointCommands,
    Profile,
    Reduction,
)

START, MIDDLE, END, SKEW = np.random.default_rng(3).normal(size=(4, 5, 3))


def test_rates_are_the_parabola_through_three_points_and_the_skew_beside_it() -> None:
    plain, skewed = BodyRates(START, MIDDLE, END), BodyRates(START, MIDDLE, END, skew=SKEW)
    for s in (0.0, 0.2, 0.5, 0.9, 1.0):
        # Lagrange's form
        parabola = (
            2 * (s - 0.5) * (s - 1) * START + 4 * s * (1 - s) * MIDDLE + 2 * s * (s - 0.5) * END
        )
        np.testing.assert_allclose(plain.at(s), parabola, rtol=0, atol=1e-13)
        beside = SKEW * s * (1 - s) * (1 - 2 * s)
        np.testing.assert_allclose(skewed.at(s), parabola + beside, rtol=0, atol=1e-13)


def test_powers_are_those_of_the_part_of_an_interval() -> None:
    rates = BodyRates(START, MIDDLE, END, skew=SKEW)
    s = 0.3
    by_powers = np.einsum("kpj,p->kj", rates.powers, s ** np.arange(4))
    np.testing.assert_allclose(by_powers, rates.at(s), rtol=0, atol=1e-13)


def test_an_asked_g_has_both_sides_of_every_interval() -> None:
    sides = GCommand(START, END).sides
    np.testing.assert_array_equal(sides[:, 0], START)
    np.testing.assert_array_equal(sides[:, 1], END)


@pytest.mark.parametrize(
    "make",
    [
        lambda: BodyRates(START, MIDDLE[1:], END),
        lambda: BodyRates(START, MIDDLE, END, attitude=np.zeros((5, 4))),
        lambda: BodyRates(START, MIDDLE, END, skew=SKEW[1:]),
        lambda: GCommand(START, END[1:]),
        lambda: JointCommands(np.zeros(6), np.zeros((6, 2)), np.zeros((6, 2)), np.zeros((5, 2))),
        lambda: Reduction(r1=np.ones(3)),
        lambda: Reduction(r2=np.ones(1)),
    ],
)
def test_arrays_of_another_shape_are_refused(make) -> None:
    with pytest.raises(ValueError, match="expected"):
        make()


def test_what_is_given_to_a_profile_cannot_be_changed_behind_it() -> None:
    t = np.arange(6.0)
    profile = Profile("own", t, BodyRates(START, MIDDLE, END), DES)
    t[0] = -1.0
    assert profile.t[0] == 0.0
    assert not profile.initial_angle.flags.writeable
    assert not profile.reduction.r1.flags.writeable


def test_a_silent_reduction_keeps_budgets_of_the_whole_way_from_the_record() -> None:
    silent = Reduction()
    assert silent.budget_of_record == silent.budget == FELT_BUDGETS
    assert {each.metric: each.most for each in silent.budget} == {
        "seat_g_rms_error_g": 0.05,
        "seat_rate_deviation_relative": 0.1,
        "seat_angular_acceleration_rms_ratio": 1.05,
        "seat_angular_acceleration_peak_ratio": 1.1,
    }
    allowed = replace(silent, allow_change=0.0)
    assert allowed.budget_of_record == ()
    assert allowed.budget == FELT_BUDGETS
