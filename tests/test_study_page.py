"""docs/study.md: its numbers are what the tool makes of the Cobra, to every printed digit."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from des_cli.pipeline import reduce_profile
from des_cli.profiles_in.load import load_profile

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "docs" / "study.md").read_text(encoding="utf-8")
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
    "the study's problem, solved inside the limits": ("cobra", "reduction.limits=enforce"),
    "the whole vector in its place, inside the limits": (
        "cobra",
        "reduction.axes=seat",
        "reduction.r1=[2, 2, 2]",
        "reduction.limits=enforce",
    ),
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
    table = TEXT.partition("## What the optimum, the limits and felt budgets change")[2].partition(
        "\n## "
    )[0]
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


@pytest.mark.parametrize("r2", [8, 1, 0.2])
def test_the_weights_of_the_study(r2: float) -> None:
    row = re.search(rf"^\| {r2} \| (.*)$", TEXT, re.MULTILINE)
    assert row is not None
    values: list[float] = []
    for algorithm in ("report-sweep", "optimum"):
        found = metrics("cobra", f"reduction.r2={r2}", f"reduction.algorithm={algorithm}")
        fidelity = found["fidelity"]
        values += [
            found["coriolis"]["bb3"]["reduction"],
            fidelity["joint_deviation_relative"],
            fidelity["joint_deviation_relative_squared"],
        ]
    printed = re.findall(r"\d+\.\d+", row[1])
    for number, value in zip(printed, values, strict=True):
        assert_printed(number, 100.0 * value)


def test_the_figures_in_words() -> None:
    found = {
        name: metrics(name, "reduction.algorithm=report-sweep")["coriolis"]["bb3"]
        for name in ("cobra", "cobra_table3")
    }
    peaks = re.search(r"a peak of ([\d.]+) rad/s².*with a peak of ([\d.]+) rad/s²", WORDS)
    assert peaks is not None
    assert_printed(peaks[1], found["cobra"]["peak_before_rad_s2"])
    assert_printed(peaks[2], found["cobra_table3"]["peak_before_rad_s2"])
    grown = re.search(r"makes BB3 larger, by (\d+) %, where the optimum takes ([\d.]+) %", WORDS)
    assert grown is not None
    assert_printed(grown[1], -100.0 * found["cobra_table3"]["reduction"])
    assert_printed(grown[2], 100.0 * metrics("cobra_table3")["coriolis"]["bb3"]["reduction"])


def test_the_curves_in_words() -> None:
    law = reduce_profile(
        load_profile("cobra", settings=["reduction.algorithm=report-sweep", "reduction.r2=0.2"])
    )
    best = reduce_profile(load_profile("cobra", settings=["reduction.r2=0.2"]))
    said = re.search(r"between −([\d.]+) and ([\d.]+): .* between ([\d.]+) and ([\d.]+)\.", WORDS)
    assert said is not None
    curves = law.solution.control, best.solution.control
    values = [-curves[0].min(), curves[0].max(), curves[1].min(), curves[1].max()]
    for number, value in zip(said.groups(), values, strict=True):
        assert_printed(number, value)
    adjoint = reduce_profile(
        load_profile("cobra", settings=["reduction.algorithm=report-sweep"])
    ).solution.adjoint
    said = re.search(
        r"between −([\d.]+) and ([\d.]+) for the arm and between −([\d.]+) and ([\d.]+) for", WORDS
    )
    assert said is not None
    values = [-adjoint[:, 0].min(), adjoint[:, 0].max(), -adjoint[:, 1].min(), adjoint[:, 1].max()]
    for number, value in zip(said.groups(), values, strict=True):
        assert_printed(number, value)


@pytest.mark.skipif(sys.platform != "linux", reason="last digits are those of the platform")
def test_the_figures_are_what_the_script_draws(tmp_path: Path) -> None:
    command = [sys.executable, "scripts/figures.py", str(tmp_path), "study"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    subprocess.run(command, cwd=ROOT, env=environment, check=True)
    drawn = {path.name: path.read_bytes() for path in (tmp_path / "study").iterdir()}
    kept = {path.name: path.read_bytes() for path in (ROOT / "docs" / "study").iterdir()}
    assert sorted(drawn) == sorted(kept)
    assert [name for name in drawn if drawn[name] != kept[name]] == []
    assert sum(map(len, kept.values())) < 200_000


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
