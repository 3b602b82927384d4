"""A state of the joints by options, in any unit."""

from __future__ import annotations

import math

import numpy as np

from des_cli.cli.kinematics import kinematics
from des_cli.cli.state_options import QUANTITIES
from des_cli.units import UNITS, suffixes
from tests.support.state_commands import of


def test_there_is_an_option_for_each_unit_of_each_quantity() -> None:
    names = {option for parameter in kinematics.params for option in parameter.opts}
    wanted = {
        f"--{stem}-{suffix}".replace("_", "-")
        for stem, kind in QUANTITIES
        for suffix in suffixes(kind)
    }
    assert wanted <= names
    assert {"--arm-rpm", "--cab-deg-s2", "--seat-yaw-deg"} <= wanted
    assert {kind for _, kind in QUANTITIES} <= {unit.quantity for unit in UNITS}


def test_units_mean_the_same(invoke) -> None:
    one = of(invoke, "--arm-rpm", "30", "--fork-deg", "-60", "--cab-deg-s2", "90")
    other = of(
        invoke,
        *("--arm-rad-s", repr(math.pi), "--fork-rad", repr(-math.pi / 3)),
        *("--cab-rad-s2", repr(math.pi / 2)),
    )
    for name in ("w_seat_rad_s", "seat_g", "seat_position_m"):
        np.testing.assert_allclose(one[name], other[name], rtol=0, atol=1e-13)


def test_what_is_not_given_is_rest(invoke) -> None:
    found = of(invoke)
    assert (found["machine"], found["angle_rad"], found["rate_rad_s"]) == ("des", [0] * 3, [0] * 3)
    assert found["seat_yaw_rad"] == math.pi / 2
    np.testing.assert_allclose(found["seat_g"], [0, 0, 1], rtol=0, atol=1e-15)
