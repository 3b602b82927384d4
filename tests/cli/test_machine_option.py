"""``--machine``: what a profile says by ``machine:``, said on the command line."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

OWN = "base: des\nname: long arm\nlengths_ft: {L2: 29}\nlimits: {arm: {rate_rad_s: 4}}\n"


@pytest.fixture
def own(tmp_path: Path) -> str:
    """A machine file in the current folder; profiles are elsewhere."""
    (tmp_path / "own.yaml").write_text(OWN)
    return "own.yaml"


def test_reduce_makes_the_table_that_the_profile_would_make(
    invoke, write_profile, own: str, tmp_path: Path
) -> None:
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    write_profile("small").rename(folder / "small.yaml")
    said = write_profile("said", machine=own).name
    result = invoke("reduce", "elsewhere/small.yaml", "--machine", own, "-o", "a", "--no-plots")
    assert result.exit_code == 0, result.stderr
    assert invoke("reduce", said, "-o", "b", "--no-plots").exit_code == 0
    table = Path("a/commands.csv").read_bytes()
    assert table == Path("b/commands.csv").read_bytes()
    assert json.loads(Path("a/metrics.json").read_text())["profile"]["machine"] == "long arm"
    back = invoke("reduce", said, "--machine", "des", "-o", "c", "--no-plots")
    assert back.exit_code == 0, back.stderr
    before, after = (json.loads(Path(f"{run}/metrics.json").read_text()) for run in "ac")
    assert after["profile"]["machine"] == "des"
    assert before["felt"] != after["felt"]


def test_resume_knows_a_machine_file_that_was_changed(invoke, small: str, own: str) -> None:
    arguments = ("reduce", small, "--machine", own, "--no-plots")
    assert invoke(*arguments).exit_code == 0
    assert "already done" in invoke(*arguments, "--resume").stderr
    Path(own).write_text(OWN.replace("29", "30"))
    assert invoke(*arguments, "--resume").exit_code == 1


def test_validate_and_settings_beside_it(invoke, small: str, own: str) -> None:
    arguments = ("validate", small, "--format", "json", "--machine")
    assert json.loads(invoke(*arguments, own).stdout)["machine"] == "long arm"
    setting = "machine.limits.fork.jerk_rad_s3=3"
    found = json.loads(invoke(*arguments, "johnsville", "--set", setting).stdout)
    assert found["machine"] == "johnsville (changed)"
    assert found["jerk_limit_rad_s3"]["fork"] == 3.0
    refused = invoke(*arguments, own, "--set", setting)
    assert refused.exit_code == 3
    assert "the machine is a file: change it in own.yaml" in refused.stderr


def test_sweep_is_on_the_machine(invoke, small: str, own: str) -> None:
    def points(*options: str) -> list[dict[str, str]]:
        arguments = ("sweep", small, "--r2s", "1", "--controls", "scalar", "--format", "csv")
        result = invoke(*arguments, *options)
        assert result.exit_code == 0, result.stderr
        return list(csv.DictReader(result.stdout.splitlines()))

    # the same joints, and a longer arm: another G
    changed, plain = points("--machine", own)[0], points()[0]
    assert changed["joint_deviation_relative"] == plain["joint_deviation_relative"]
    assert float(changed["seat_g_rms_error_g"]) > float(plain["seat_g_rms_error_g"])


@pytest.mark.parametrize("command", ["reduce", "validate", "sweep", "kinematics"])
@pytest.mark.parametrize(
    ("machine", "code", "words"),
    [
        ("dse", 3, "there is no built-in machine dse (did you mean des?)"),
        ("none.yaml", 1, "none.yaml: cannot be read"),
        (" ", 2, "is empty: name a machine or a file"),
    ],
)
def test_a_machine_that_is_not_there(
    invoke, small: str, command: str, machine: str, code: int, words: str
) -> None:
    result = invoke(command, small, "--machine", machine)
    assert (result.exit_code, result.stdout) == (code, "")
    assert words in result.stderr
