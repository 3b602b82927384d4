"""What got worse is told from its threshold on, and nothing else is."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from des_cli.results.worse import find_worse, worse_words

TOTAL = "felt.seat_angular_acceleration.magnitude"

AS_BEFORE: dict[str, Any] = {
    "solver": {"optimise": []},
    "felt": {
        "seat_angular_acceleration": {
            "magnitude": {
                "rms_before_rad_s2": 0.4,
                "rms_after_rad_s2": 0.4,
                "peak_before_rad_s2": 0.6,
                "peak_after_rad_s2": 0.6,
            }
        },
        "seat_g": {
            axis: {
                "peak_before_g": 0.5,
                "peak_after_g": 0.5,
                "onset_before_g_s": 1.0,
                "onset_after_g_s": 1.0,
            }
            for axis in ("gx", "gy", "gz")
        },
    },
    "fidelity": {
        "start_error": {
            f"{joint}_{unit}": 0.0 for joint in ("arm", "fork", "cab") for unit in ("rad", "rad_s")
        }
    },
}


def changed(**values: float | list[str]) -> dict[str, Any]:
    """The metrics with other values at paths, whose dots are written as two underscores."""
    metrics = copy.deepcopy(AS_BEFORE)
    for path, value in values.items():
        *parents, last = path.replace("TOTAL", TOTAL).replace("__", ".").split(".")
        place = metrics
        for key in parents:
            place = place[key]
        place[last] = value
    return metrics


def test_nothing_worse_nothing_told() -> None:
    assert find_worse(AS_BEFORE) == []
    assert worse_words(AS_BEFORE) == ""


@pytest.mark.parametrize(
    ("path", "below", "above", "words"),
    [
        (
            "TOTAL__rms_after_rad_s2",
            0.419,
            0.421,
            "total angular acceleration 0.4 -> 0.421 rad/s² rms",
        ),
        (
            "TOTAL__peak_after_rad_s2",
            0.659,
            0.661,
            "total angular acceleration peak 0.6 -> 0.661 rad/s²",
        ),
        ("felt__seat_g__gy__peak_after_g", 0.599, 0.61, "peak Gy 0.5 -> 0.61 g"),
        ("felt__seat_g__gx__onset_after_g_s", 1.09, 1.2, "Gx onset 1 -> 1.2 g/s"),
        ("fidelity__start_error__cab_rad_s", -0.019, -0.021, "start off by cab -0.021 rad/s"),
        ("fidelity__start_error__fork_rad", 0.009, 0.011, "start off by fork +0.011 rad"),
    ],
)
def test_each_measure_has_its_threshold(path: str, below: float, above: float, words: str) -> None:
    assert find_worse(changed(**{path: below})) == []
    assert worse_words(changed(**{path: above})) == f"worse to sit in: {words}"


def test_other_axes_may_peak_higher_for_they_are_the_maneuver() -> None:
    assert find_worse(changed(felt__seat_g__gz__peak_after_g=0.9)) == []


def test_a_hard_onset_may_grow_by_its_twentieth() -> None:
    assert find_worse(changed(felt__seat_g__gx__onset_before_g_s=6.0)) == []
    hard = {"felt__seat_g__gx__onset_before_g_s": 6.0}
    assert find_worse(changed(felt__seat_g__gx__onset_after_g_s=6.29, **hard)) == []
    assert len(find_worse(changed(felt__seat_g__gx__onset_after_g_s=6.31, **hard))) == 1


def test_all_of_it_is_one_line_and_the_first_of_it_a_short_one() -> None:
    metrics = changed(
        TOTAL__rms_after_rad_s2=2.2,
        TOTAL__peak_after_rad_s2=5.5,
        felt__seat_g__gy__peak_after_g=0.7,
        felt__seat_g__gx__onset_after_g_s=1.4,
        felt__seat_g__gz__onset_after_g_s=3.0,
    )
    turning = "total angular acceleration 0.4 -> 2.2 rad/s² rms, peak 0.6 -> 5.5 rad/s²"
    assert worse_words(metrics, short=True) == f"worse to sit in: {turning}"
    assert worse_words(metrics) == (
        f"worse to sit in: {turning}, peak Gy 0.5 -> 0.7 g, Gz onset 1 -> 3 g/s"
    )


def test_hardly_any_turning_may_double() -> None:
    quiet = changed(
        TOTAL__rms_before_rad_s2=0.001,
        TOTAL__rms_after_rad_s2=0.01,
        TOTAL__peak_before_rad_s2=0.0,
        TOTAL__peak_after_rad_s2=0.009,
    )
    assert find_worse(quiet) == []


def test_a_start_that_was_to_be_found_is_not_off() -> None:
    moved = changed(fidelity__start_error__fork_rad=-0.09)
    assert len(find_worse(moved)) == 1
    moved["solver"]["optimise"] = ["fork_start"]
    assert find_worse(moved) == []
    moved["solver"]["optimise"] = ["cab_start"]
    assert len(find_worse(moved)) == 1


@pytest.mark.parametrize("metrics", [{}, {"felt": 1, "fidelity": []}, {"felt": {"seat_g": None}}])
def test_what_is_not_known_is_not_told(metrics: dict[str, Any]) -> None:
    assert find_worse(metrics) == []


def test_a_ride_is_compared_with_the_one_that_was_reduced() -> None:
    """A noisy record turns more than any ride that is made of it."""
    noisy = changed(felt__seat_g__gx__onset_before_g_s=46.0, felt__seat_g__gx__onset_after_g_s=1.4)
    assert find_worse(noisy) == []
    smooth = changed(felt__seat_g__gx__onset_after_g_s=1.4)["felt"]
    (told,) = find_worse({**noisy, "added": {"felt": smooth}})
    assert str(told) == "Gx onset 1 -> 1.4 g/s"


def test_no_bound_is_named_that_the_profile_itself_exceeds() -> None:
    grown = {"felt__seat_g__gx__onset_after_g_s": 1.4}
    (told,) = find_worse(changed(**grown))
    assert told.cure == "the machine's g_onset_g_s"
    (told,) = find_worse(
        changed(
            felt__seat_g__gz__onset_before_g_s=2.0, felt__seat_g__gz__onset_after_g_s=2.0, **grown
        )
    )
    assert told.cure == "a smaller budget on seat_g_rms_error_g"
