"""States as aligned text."""

from __future__ import annotations

import json

import numpy as np

from tests.support.state_commands import SPIN, of


def test_text_is_aligned_and_has_units(invoke) -> None:
    text = invoke("kinematics", *SPIN, "--format", "text").stdout
    lines = text.splitlines()
    start = lines.index("Seat acceleration, seat axes, gravity left out [g]")
    table = lines[start + 1 : start + 6]
    assert [line.split()[0] for line in table] == [
        "x",
        "tangential",
        "centripetal",
        "coriolis",
        "total",
    ]
    assert len({len(line) for line in table}) == 1
    found = of(invoke, *SPIN)["seat_acceleration_g"]
    for line in table[1:]:
        name, *numbers = line.split()
        np.testing.assert_allclose([float(x) for x in numbers], found[name], rtol=0, atol=5.1e-7)
    assert "-0.000000" not in text


def test_text_of_a_profile_has_a_line_a_sample(invoke, small: str) -> None:
    lines = invoke("kinematics", small, "--format", "text").stdout.splitlines()
    numbers = [line.split() for line in lines[-21:]]
    row = json.loads(invoke("kinematics", small).stdout)[-1]
    expected = [row["t_s"], *np.degrees(row["angle_rad"]), *row["coriolis_rad_s2"]]
    expected += [*row["coriolis_seat_rad_s2"], *row["seat_g"], row["singular_value"][2]]
    np.testing.assert_allclose([float(x) for x in numbers[-1]], expected, rtol=0, atol=5.1e-5)
