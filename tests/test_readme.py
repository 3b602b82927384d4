"""README.md: its first run, its picture, and the line that checks everything."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from des_cli import load_profile, reduce_profile
from des_cli.model.run import Run

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def first() -> Run:
    """The run that the first command makes."""
    name = re.search(r"des-coriolis reduce (\w+)\n```", TEXT)
    assert name is not None
    return reduce_profile(load_profile(name[1]))


def test_the_first_run_breaks_no_limit_and_is_not_worse_to_sit_in(first: Run) -> None:
    first.require_release()
    assert first.violations == ()
    assert first.notices == ()


def test_its_numbers(first: Run) -> None:
    said = re.search(
        r"([\d.]+) % of the cross-coupling is gone for .* ([\d.]+) g and (\d+) %", TEXT
    )
    assert said is not None
    fidelity = first.metrics["fidelity"]
    values = [
        100.0 * first.metrics["coriolis"]["vector"]["reduction"],
        fidelity["seat_g_rms_error_g"],
        100.0 * fidelity["seat_rate_deviation_relative"],
    ]
    for number, value in zip(said.groups(), values, strict=True):
        unit = 10.0 ** -len(number.partition(".")[2])
        assert float(number) == pytest.approx(value, rel=0, abs=0.51 * unit)


def test_its_picture_is_small_and_there() -> None:
    picture = re.search(r"!\[[^]]+\]\((docs/[\w.-]+)\)", TEXT)
    assert picture is not None
    assert 0 < (ROOT / picture[1]).stat().st_size < 100_000


def test_the_line_that_checks_everything_is_the_one_that_the_gate_runs() -> None:
    said = re.search(r"All checks, from a clean clone:\n\n```sh\n(.+)\n```", TEXT)
    gate = (Path(__file__).parents[1] / ".ci" / "run").read_text(encoding="utf-8")
    assert said is not None
    assert said[1] == gate.splitlines()[-1]
