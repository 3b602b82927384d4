"""``validate``: what was understood on stdout, every problem on stderr."""

import json
from pathlib import Path


def test_a_good_profile_is_ok(invoke, small: str) -> None:
    result = invoke("validate", small)
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith(
        "small.yaml: ok: small, joint commands, 21 samples, 1 s, machine des; "
    )


def test_json_tells_what_was_understood(invoke, small: str) -> None:
    result = invoke("validate", small, "--format", "json", "--r2", "0.5", "--axes", "seat")
    facts = json.loads(result.stdout)
    assert facts["ok"] is True
    assert (facts["kind"], facts["samples"], facts["duration_s"]) == ("joints", 21, 1.0)
    assert facts["axes"] == "seat"
    assert len(facts["sha256"]) == 64


def test_all_problems_of_all_profiles_are_named(invoke, small: str, write_profile) -> None:
    bad = write_profile("bad", machine="dse", fork_deg="sin(")
    bad.write_text(bad.read_text().replace("r2: 1", "r3: 1"))
    result = invoke("validate", bad.name, small)
    assert result.exit_code == 3
    lines = result.stderr.splitlines()
    assert len(lines) >= 3
    assert all(line.startswith("bad.yaml:") for line in lines)
    assert "machine" in result.stderr
    assert "fork_deg" in result.stderr
    assert "r3" in result.stderr
    assert result.stdout.startswith("small.yaml: ok: ")


def test_json_tells_the_problems_too(invoke, write_profile) -> None:
    bad = write_profile("bad", fork_deg="sin(")
    result = invoke("validate", bad.name, "-f", "json")
    assert result.exit_code == 3
    facts = json.loads(result.stdout)
    assert facts["ok"] is False
    assert facts["problems"] == result.stderr.splitlines()


def test_a_missing_file_is_1(invoke) -> None:
    result = invoke("validate", "nowhere.yaml")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr.count("\n") == 1
    assert "nowhere.yaml" in result.stderr


def test_several_kinds_of_failure_are_1(invoke, write_profile) -> None:
    bad = write_profile("bad", fork_deg="sin(")
    assert invoke("validate", bad.name, "nowhere.yaml").exit_code == 1


def test_stdin(invoke, small: str, tmp_path: Path) -> None:
    result = invoke("validate", "-", input=(tmp_path / small).read_bytes())
    assert (result.exit_code, result.stderr) == (0, "")
    assert "ok: small" in result.stdout


def test_stdin_twice_is_wrong_use(invoke) -> None:
    result = invoke("validate", "-", "-", input=b"")
    assert result.exit_code == 2
    assert "only once" in result.stderr
