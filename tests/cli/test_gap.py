"""``--gap``: a record with missing samples on the command line."""

import json
from pathlib import Path

import pytest

RATES = "t_s,p_rad_s,q_rad_s,r_rad_s\n"


@pytest.fixture
def log(tmp_path: Path) -> str:
    """A record of two gentle stretches with five seconds between them."""
    times = [0.1 * row + (5.0 if row > 10 else 0.0) for row in range(22)]
    rows = (f"{t:.6g},0,0,{0.05 + 0.002 * row}\n" for row, t in enumerate(times))
    (tmp_path / "log.csv").write_text(RATES + "".join(rows))
    return "log.csv"


def test_without_a_word_a_long_gap_is_refused(invoke, log: str) -> None:
    result = invoke("reduce", log)
    assert result.exit_code == 3
    assert result.stderr.startswith("log.csv:13: a gap of 5.1 s, from t = 1 to 6.1 s")


def test_split_makes_a_run_of_each_stretch(invoke, log: str, tmp_path: Path) -> None:
    result = invoke("reduce", log, "--gap", "split", "-o", "all", "--no-plots", "--limits", "warn")
    assert result.exit_code == 0, result.stderr
    assert sorted(path.name for path in (tmp_path / "all").iterdir()) == [
        "log-1",
        "log-2",
        "summary.csv",
    ]
    metrics = json.loads((tmp_path / "all/log-2/metrics.json").read_text())
    assert metrics["profile"]["samples"] == 11
    assert metrics["notices"][0].startswith("part 2 of 2 between gaps: lines 13 to 23")


def test_split_does_not_fit_into_one_table(invoke, log: str) -> None:
    result = invoke("reduce", log, "--gap", "split", "-o", "x.csv")
    assert result.exit_code == 2
    assert "one command table cannot hold several profiles" in result.stderr


def test_bridge_is_told(invoke, log: str) -> None:
    result = invoke("validate", log, "--gap", "bridge", "--format", "json")
    assert result.exit_code == 0
    (remark,) = json.loads(result.stdout)["remarks"]
    assert remark.startswith("line 13: a gap of 5.1 s")
    assert remark in result.stderr


def test_validate_tells_each_stretch(invoke, log: str) -> None:
    result = invoke("validate", log, "--gap", "split", "-q")
    assert [line.split(",")[0] for line in result.stdout.splitlines()] == [
        "log.csv: ok: log-1",
        "log.csv: ok: log-2",
    ]


def test_the_option_stands_behind_set(invoke, log: str) -> None:
    result = invoke("validate", "--gap", "bridge", log, "--set", "gap=refuse")
    assert result.exit_code == 0
    assert invoke("kinematics", log, "--gap", "bridge", "-f", "csv").exit_code == 0
    assert invoke("kinematics", "--arm-rpm", "3", "--gap", "bridge").exit_code == 2
