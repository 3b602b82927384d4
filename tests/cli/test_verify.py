"""``verify``: what a console asks before it loads a table."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from tests.support.run_files import metrics_of

FELT = (
    "--r1",
    "2,2,2",
    "--control",
    "free",
    "--axes",
    "seat",
    "--limits",
    "enforce",
    "--ends",
    "match-start",
)

BUDGETS = (
    *("--budget", "seat_rate_deviation_relative=0.05"),
    *("--budget", "seat_angular_acceleration_peak_ratio=1.02"),
)


@pytest.fixture
def stored(invoke, write_profile, tmp_path: Path) -> str:
    """The folder of a run, from the test's folder."""
    name = write_profile("flown", r2="1").name
    result = invoke("-q", "reduce", name, "--no-plots", *FELT, *BUDGETS, "--fail-on", "notice")
    assert result.exit_code == 0, result.stderr
    return "runs/flown"


def test_a_run_and_its_table_pass(invoke, stored: str) -> None:
    result = invoke("verify", stored, f"{stored}/commands.csv")
    assert (result.exit_code, result.stderr) == (0, "")
    one, other = result.stdout.splitlines()
    assert one.startswith(f"{stored}: ok: flown, 21 rows, 1 s, machine des; ")
    assert other.startswith(f"{stored}/commands.csv: ok: 21 rows, 1 s, machine des; ")


def test_a_table_comes_on_stdin(invoke, stored: str, tmp_path: Path) -> None:
    data = (tmp_path / stored / "commands.csv").read_bytes()
    assert invoke("verify", "-", input=data).exit_code == 0
    cut = invoke("verify", "-", input=data[:-9])
    assert cut.exit_code == 3
    assert cut.stderr.startswith("<stdin>: is no command table: its last line does not end")


def test_a_changed_file_ends_with_3_and_names_it(invoke, stored: str, tmp_path: Path) -> None:
    path = tmp_path / stored / "commands.csv"
    path.write_bytes(path.read_bytes().replace(b"8", b"9", 1))
    result = invoke("verify", stored)
    assert result.exit_code == 3
    assert result.stderr.startswith(f"{stored}/commands.csv: is not the file that the manifest")
    assert result.stdout == ""


def test_a_file_that_cannot_be_read_ends_with_1(
    invoke, stored: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    really = os.open

    def refuse(path: os.PathLike[str], *args: int) -> int:
        if Path(path).name == "metrics.json":
            raise PermissionError(13, "Permission denied")
        return really(path, *args)

    monkeypatch.setattr(os, "open", refuse)
    result = invoke("verify", stored)
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr == f"{stored}/metrics.json: cannot be read: Permission denied\n"


def test_another_machine_is_a_file_or_a_name(invoke, stored: str, tmp_path: Path) -> None:
    (tmp_path / "tight.yaml").write_text(
        "base: des\nname: tight\nlimits: {fork: {rate_rad_s: 0.01}}\n"
    )
    result = invoke("-q", "verify", stored, "--machine", "tight.yaml")
    assert result.exit_code == 5
    assert (
        "limits.fork.rate: relative excess of the fork's rate over its limit is " in result.stderr
    )
    assert result.stdout == ""
    assert invoke("verify", stored, "--machine", "dse").exit_code == 3


def test_where_the_machine_stands_is_asked(invoke, stored: str) -> None:
    here = ("--arm-rpm", "8.8", "--fork-deg", "0", "--cab-deg", "30")
    assert invoke("verify", stored, *here).exit_code == 0
    result = invoke("verify", f"{stored}/commands.csv", *here[:-1], "31")
    assert result.exit_code == 5
    assert "start.cab: gap between the cab and the first row [rad] is 0.0175" in result.stderr


def test_the_seat_is_a_runs_own(invoke, stored: str) -> None:
    result = invoke("verify", stored, "--seat-yaw-deg", "90", "--arm-deg", "0")
    assert result.exit_code == 2
    assert "the seat yaw and the arm angle is a run's own" in result.stderr.replace("\n", " ")
    assert invoke("verify", f"{stored}/commands.csv", "--seat-yaw-deg", "90").exit_code == 0


def test_json_tells_every_check(invoke, stored: str) -> None:
    result = invoke("verify", stored, "nowhere", "--format", "json")
    assert result.exit_code == 1
    good, bad = map(json.loads, result.stdout.splitlines())
    assert (good["target"], good["ok"], good["exit_code"], good["problems"]) == (
        stored,
        True,
        0,
        [],
    )
    assert {check["key"] for check in good["checks"]} > {"table.cab", "limits.arm.rate"}
    assert all(check["ok"] for check in good["checks"])
    assert (bad["ok"], bad["exit_code"]) == (False, 1)
    assert "nowhere" in bad["problems"][0]


def test_the_worst_of_several_is_the_exit_code(invoke, stored: str, tmp_path: Path) -> None:
    (tmp_path / "none.csv").write_text("t_s,arm_rpm\n")
    (tmp_path / "tight.yaml").write_text("base: des\nlimits: {fork: {rate_rad_s: 0.01}}\n")
    assert invoke("verify", "none.csv", "nowhere").exit_code == 3
    result = invoke("verify", "none.csv", stored, "--machine", "tight.yaml")
    assert result.exit_code == 5


def test_a_notice_is_told_and_refused_where_asked(invoke, write_profile) -> None:
    name = write_profile("harsh", r2="0.001").name
    made = invoke("-q", "reduce", name, "--no-plots")
    assert made.exit_code == 0
    # Quiet keeps what warns of harm.
    assert "start off by arm" in made.stderr
    told = invoke("verify", "runs/harsh")
    assert "runs/harsh: start: the table does not start where the profile does" in told.stderr
    refused = invoke("verify", "runs/harsh", "--fail-on", "start")
    assert refused.exit_code == 5
    assert invoke("verify", "runs/harsh", "--fail-on", "geometry").exit_code == told.exit_code


def test_reduce_refuses_what_it_is_told_to(invoke, write_profile, tmp_path: Path) -> None:
    name = write_profile("harsh", r2="0.001").name
    for word in ("start", "worse", "notice"):
        result = invoke("reduce", name, "--no-plots", "--fail-on", word)
        assert result.exit_code == 5
        assert "harsh: not released for its notice" in result.stderr
        assert not (tmp_path / "runs" / "harsh").exists()
    assert invoke("reduce", name, "--no-plots", "--fail-on", "damped").exit_code == 0
    metrics = metrics_of(tmp_path / "runs" / "harsh")
    assert len(metrics["notice_names"]) == len(metrics["notices"])
    assert "worse" in metrics["notice_names"]
    assert invoke("reduce", name, "--fail-on", "nothing").exit_code == 2
