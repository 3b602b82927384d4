"""One word on a run, read from its metrics."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import pytest

from des_cli.model.run import Run
from des_cli.results.reading import read_metrics
from des_cli.results.verdict import Verdict, find_verdict
from tests.support.page import set_at


@pytest.fixture
def sound(synthetic_run: Callable[..., Run]) -> dict[str, Any]:
    """The metrics of a run that nothing speaks against."""
    content: dict[str, Any] = copy.deepcopy(synthetic_run(11).metrics)
    content["notices"], content["notice_names"], content["violations"] = [], [], []
    for joint in ("arm", "fork", "cab"):
        for key in ("end_error_rad", "end_error_rad_s"):
            set_at(content, f"fidelity.{key}.{joint}", 0.0)
    assert verdict(content).word == "fly", verdict(content)
    return content


def verdict(content: dict[str, Any]) -> Verdict:
    return find_verdict(read_metrics(content))


def test_a_run_that_nothing_speaks_against(sound: dict[str, Any]) -> None:
    assert verdict(sound) == Verdict(
        "fly", ("verified, inside all limits, and no worse to sit in",)
    )


@pytest.mark.parametrize(
    ("path", "value", "reason"),
    [
        ("solver.status", "iteration-limit", "did not converge (iteration-limit)"),
        ("solver.status", None, "how it ended is not known"),
        ("limits.modified.cab.ok", False, "breaks a limit of the cab"),
        ("limits.modified.fork.ok", None, "whether it keeps the limits is not known"),
        ("limits.modified.arm.jerk_peak_rad_s3", 99.0, "breaks the arm's limit of jerk"),
        ("violations", ["modified seat Gz 9 g exceeds the bound 8 g"], "bound for the occupant"),
    ],
)
def test_what_speaks_against_it(
    sound: dict[str, Any], path: str, value: object, reason: str
) -> None:
    set_at(sound, "limits.modified.arm.jerk_limit_rad_s3", 10.0)
    set_at(sound, path, value)
    found = verdict(sound)
    assert found.word == "don't"
    assert reason in found.reasons[0]


@pytest.mark.parametrize(
    ("path", "value", "reason"),
    [
        ("felt.seat_g.gy.peak_after_g", 2.5, "peak Gy"),
        ("solver.status", "acceptable", "stopped short of its tolerance"),
        ("coriolis.vector.reduction", -0.1, "nothing was taken off"),
        ("asked_g", {"rms_g": 0.67}, "misses the asked G by 0.67 g rms"),
        ("fidelity.end_error_rad.cab", 0.2, "end off by cab +11 deg"),
        ("fidelity.end_error_rad_s.arm", -0.2, "end off by arm -11 deg/s"),
    ],
)
def test_what_asks_for_a_look(sound: dict[str, Any], path: str, value: object, reason: str) -> None:
    set_at(sound, path, value)
    found = verdict(sound)
    assert found.word == "look"
    assert any(reason in each for each in found.reasons), found


def test_where_the_arm_ends_is_not_felt(sound: dict[str, Any]) -> None:
    set_at(sound, "fidelity.end_error_rad.arm", -2.0)
    assert verdict(sound).word == "fly"


def test_a_notice_of_harm_asks_for_a_look_and_one_on_the_record_does_not(
    sound: dict[str, Any],
) -> None:
    sound["notices"] = ["rows were refined", "the geometry is odd; and more"]
    sound["notice_names"] = ["record", "geometry"]
    assert verdict(sound) == Verdict("look", ("the geometry is odd",))
    sound["notice_names"] = ["record", "record"]
    assert verdict(sound).word == "fly"


def test_limits_that_changed_the_maneuver(sound: dict[str, Any]) -> None:
    set_at(sound, "executable.replaced", True)
    set_at(sound, "executable.seat_rate_deviation_relative", 0.2)
    assert "keeping the limits changed the maneuver" in verdict(sound).reasons


def test_of_nothing_nothing_is_flown() -> None:
    assert find_verdict(read_metrics({})).word == "don't"
