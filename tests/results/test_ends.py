"""How far a motion starts and ends from its profile, in words."""

from __future__ import annotations

import math
from collections.abc import Mapping

import pytest

from des_cli.model.machine import Joint
from des_cli.model.metrics import Fidelity
from des_cli.results.ends import end_words


def degrees(**off: float) -> Mapping[Joint, float]:
    return {joint: math.radians(each) for joint, each in off.items()}  # type: ignore[misc]


@pytest.mark.parametrize(
    ("angle", "rate", "words"),
    [
        ({"arm": -2.0, "fork": 1.0, "cab": 1.5}, {}, "arm -2 deg"),
        ({"arm": 0.01, "fork": 0.06}, {}, "fork +0.06 deg"),
        ({"arm": 0.04, "fork": -0.04}, {"cab": 0.0}, "as in the profile"),
        ({"arm": 1.0}, {"arm": 2.0, "cab": -12.3456}, "arm +1 deg and cab -12.3 deg/s"),
        ({"arm": 0.0}, {"fork": 0.5}, "fork +0.5 deg/s"),
        ({}, {"cab": 0.0}, "as in the profile"),
        ({}, {}, ""),
    ],
)
def test_the_joint_that_is_off_most_is_named(
    angle: dict[str, float], rate: dict[str, float], words: str
) -> None:
    off = Fidelity(end_error_rad=degrees(**angle), end_error_rad_s=degrees(**rate))
    assert end_words(off, "end") == words


def test_the_start_is_told_by_itself() -> None:
    off = Fidelity(
        start_error={"arm_rad": math.radians(3.0), "cab_rad_s": math.radians(-4.0)},
        end_error_rad={"fork": 1.0},
    )
    assert end_words(off, "start") == "arm +3 deg and cab -4 deg/s"
    assert end_words(off, "end") == "fork +57.3 deg"


def test_what_is_not_known_is_not_taken_for_a_match() -> None:
    unknown = Fidelity(end_error_rad={"arm": None, "fork": None, "cab": None})
    assert end_words(unknown, "end") == ""
    known = Fidelity(end_error_rad={"arm": None, "fork": math.radians(1.0)})
    assert end_words(known, "end") == "fork +1 deg"
