"""README.md's numbers are what the tool makes of the Cobra, to every printed digit."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from des_cli import load_profile, reduce_profile

pytestmark = pytest.mark.slow

TEXT = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")
WORDS = " ".join(TEXT.split())

NO_WORSE = "seat_angular_acceleration_rms_ratio: 1.05, seat_angular_acceleration_peak_ratio: 1.1"
TWO = "seat_g_rms_error_g: {}, seat_rate_deviation_relative: {}"
FIVE = "joint_deviation_relative: 0.05"
ERROR = "seat_angular_acceleration_rms_error_rad_s2: 0.15"
CONSTANTS = "reduction.optimise=[seat_yaw, seat_pitch, fork_start, cab_start]"


def budget(*within: str) -> str:
    return f"reduction.budget={{{', '.join(within)}}}"


ROWS: dict[str, tuple[str, ...]] = {
    "default: G 0.05 g, rate 10 %, angular acceleration no worse": ("cobra_felt",),
    "the same, with seat and start optimised": ("cobra_felt", CONSTANTS),
    "G 0.1 g, rate 20 %, angular acceleration no worse": (
        "cobra_felt",
        budget(TWO.format(0.1, 0.2), NO_WORSE),
    ),
    "G 0.05 g, rate 10 %": ("cobra_felt", budget(TWO.format(0.05, 0.1))),
    "G 0.1 g, rate 20 %": ("cobra_felt", budget(TWO.format(0.1, 0.2))),
    "joints 5 %, angular acceleration error 0.15 rad/s²": ("cobra_felt", budget(FIVE, ERROR)),
    "joints 5 %, `objective: blend`": ("cobra_felt", budget(FIVE), "reduction.objective=blend"),
    "joints 5 % alone": ("cobra_felt", budget(FIVE)),
    "the study's problem, solved (no limits)": ("cobra",),
    "the study's law (no limits)": ("cobra", "reduction.algorithm=report-sweep"),
}
"""What each row of the table reduces: a shipped profile, and settings."""


@cache
def metrics(name: str, *settings: str) -> dict[str, Any]:
    run = reduce_profile(load_profile(name, settings=list(settings)))
    run.require_release()
    return dict(run.metrics)


def shares(found: dict[str, Any]) -> list[float]:
    """Return the numbers of a row, in its order and units."""
    felt = found["felt"]["seat_angular_acceleration"]["magnitude"]
    return [
        100.0 * found["coriolis"]["vector"]["reduction"],
        100.0 * found["fidelity"]["seat_rate_deviation_relative"],
        found["fidelity"]["seat_g_rms_error_g"],
        felt["rms_after_rad_s2"],
        felt["peak_after_rad_s2"],
        found["limits"]["modified"]["arm"]["acceleration_sign_changes"],
    ]


def rows() -> dict[str, str]:
    """Return the cells with numbers of the table, by what their row is about."""
    table = TEXT.partition("## What it reaches")[2].partition("\n## ")[0]
    lines = [line.strip("| ") for line in table.splitlines() if line.startswith("|")]
    return {cell.strip(): rest for cell, _, rest in (line.partition("|") for line in lines[2:])}


def assert_printed(printed: str, value: float) -> None:
    """Fail unless a number is printed as it rounds; half a unit is a matter of the last bits."""
    unit = 10.0 ** -len(printed.partition(".")[2])
    assert float(printed) == pytest.approx(value, rel=0, abs=0.51 * unit)


def test_the_table_has_the_rows_that_are_computed() -> None:
    assert list(rows()) == list(ROWS)


@pytest.mark.parametrize("about", ROWS)
def test_every_number_of_the_table(about: str) -> None:
    printed = re.findall(r"\d+(?:\.\d+)?", rows()[about])
    values = shares(metrics(*ROWS[about]))
    assert len(printed) == len(values)
    for number, value in zip(printed, values, strict=True):
        assert_printed(number, value)


def test_the_ride_of_the_maneuver_itself() -> None:
    said = re.search(r"is ([\d.]+) rad/s² rms and ([\d.]+) at its peak", WORDS)
    felt = metrics("cobra_felt")["felt"]["seat_angular_acceleration"]["magnitude"]
    assert said is not None
    assert_printed(said[1], felt["rms_before_rad_s2"])
    assert_printed(said[2], felt["peak_before_rad_s2"])


def test_the_studys_own_numbers() -> None:
    said = re.search(
        r"([\d.]+) % off that component; .* takes ([\d.]+) % off, at ([\d.]+) % in the joints",
        WORDS,
    )
    solved, law = metrics("cobra"), metrics("cobra", "reduction.algorithm=report-sweep")
    assert said is not None
    assert_printed(said[1], 100.0 * solved["coriolis"]["bb3"]["reduction"])
    assert_printed(said[2], 100.0 * law["coriolis"]["bb3"]["reduction"])
    assert_printed(said[3], 100.0 * law["fidelity"]["joint_deviation_relative"])


def test_what_is_said_of_the_angles_alone() -> None:
    felt = metrics(*ROWS["joints 5 % alone"])["felt"]["seat_angular_acceleration"]["magnitude"]
    assert round(felt["rms_after_rad_s2"] / felt["rms_before_rad_s2"]) == 3
    assert "gives the pilot three times the angular acceleration" in WORDS


def test_a_bound_on_the_angular_acceleration_costs_a_percent() -> None:
    pairs = [
        ("default: G 0.05 g, rate 10 %, angular acceleration no worse", "G 0.05 g, rate 10 %"),
        ("G 0.1 g, rate 20 %, angular acceleration no worse", "G 0.1 g, rate 20 %"),
    ]
    for bounded, free in pairs:
        cost = shares(metrics(*ROWS[free]))[0] - shares(metrics(*ROWS[bounded]))[0]
        assert 0.0 < cost < 1.2  # percent points


def test_the_line_that_checks_everything_is_the_one_that_the_gate_runs() -> None:
    said = re.search(r"All checks, from a clean clone:\n\n```sh\n(.+)\n```", TEXT)
    gate = (Path(__file__).parents[1] / ".ci" / "run").read_text(encoding="utf-8")
    assert said is not None
    assert said[1] == gate.splitlines()[-1]
