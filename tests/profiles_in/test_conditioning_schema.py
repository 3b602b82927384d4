"""What a profile may say about the conditioning of its samples."""

from __future__ import annotations

from itertools import permutations
from typing import Any

import pytest

from des_cli.profiles_in.conditioning_schema import EULER_ORDERS, BodyAxes, Resample, Smooth, Trim
from tests.support.schemas import accepted, refused


def test_the_euler_orders_turn_about_each_axis_once() -> None:
    assert sorted(EULER_ORDERS) == sorted("".join(each) for each in permutations("xyz"))


def test_a_trim_may_be_open_at_either_end_and_times_have_any_unit() -> None:
    trim = accepted(Trim, "{from_ms: -1500}")
    assert (trim.si("from"), trim.given("to")) == (-1.5, None)
    assert accepted(Trim, "{to_min: 2}").si("to") == 120.0
    assert accepted(Resample, "{step_us: 500}").si("step") == pytest.approx(5e-4)


@pytest.mark.parametrize("direction", ["x", "y", "z", "-x", "-y", "-z"])
def test_an_axis_of_the_body_is_one_of_the_recorder_s_either_way(direction: str) -> None:
    axes = accepted(BodyAxes, f"{{p: x, q: {direction}, r: z}}")
    assert (axes.p, axes.q, axes.r) == ("x", direction, "z")


@pytest.mark.parametrize(
    ("section", "text", "line"),
    [
        (Trim, "{from_s: .inf}", "from_s: must be a finite number, is inf"),
        (Trim, "{from: 1}", "from: the first time kept needs its unit in the key: from_s"),
        (Resample, "{}", "the time between samples is missing: give step_s"),
        (Resample, "{step_s: 0}", "step_s: must be greater than 0, is 0"),
        (Resample, "{step_s: 2e12}", "step_s: must be at most 1e+12"),
        (BodyAxes, "{p: x, q: y}", "r: is missing"),
        (BodyAxes, "{p: x, q: y, r: '+z'}", "r: must be x, y, z, -x, -y or -z, is '+z'"),
        (Smooth, "{}", "cutoff_hz: is missing"),
        (Smooth, "{cutoff_hz: 0}", "cutoff_hz: must be greater than 0, is 0"),
        (Smooth, "{cutoff_hz: '2'}", "cutoff_hz: must be a number, is '2'"),
        (Smooth, "{cutoff: 2}", "cutoff: is not a key here (did you mean cutoff_hz?)"),
    ],
)
def test_what_cannot_be_meant_is_refused(section: Any, text: str, line: str) -> None:
    assert any(f": {line}" in each for each in refused(section, text)), refused(section, text)
