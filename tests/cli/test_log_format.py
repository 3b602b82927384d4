"""``--log-format json``: whatever a command says is an object a line, and ends as ever."""

from __future__ import annotations

import json
from typing import Any

import pytest


def messages(stderr: str) -> list[dict[str, Any]]:
    said = [json.loads(line) for line in stderr.splitlines()]
    assert all({"level", "kind", "text"} <= each.keys() for each in said)
    return said


def kinds(said: list[dict[str, Any]]) -> set[str]:
    return {each["kind"] for each in said}


def test_a_batch_tells_its_progress_its_runs_and_its_end(invoke, write_profile) -> None:
    files = [write_profile("good").name, write_profile("bad", fork_deg="sin(").name]
    line = ("reduce", *files, "--no-plots", "--keep-going", "--log-format", "json")
    result = invoke(*line)
    assert result.exit_code == 1
    said = messages(result.stderr)
    assert {"progress", "summary", "error", "batch"} <= kinds(said)
    (run,) = [each for each in said if each["kind"] == "summary"]
    assert (run["profile"], run["status"], run["exit_code"]) == ("good", "converged", 0)
    assert run["written"] == "runs/good"
    assert 0.0 < run["vector_reduction"] < 1.0
    (error,) = [each for each in said if each["kind"] == "error"]
    assert (error["level"], error["exit_code"]) == ("error", 3)
    assert error["text"].startswith("bad.yaml:8:")
    assert (said[-1]["done"], said[-1]["failed"]) == (1, 1)
    progress = [each for each in said if each["kind"] == "progress"]
    assert progress[-1]["done"] == progress[-1]["total"] == 2
    quiet = messages(invoke("-q", *line, "--overwrite").stderr)
    assert {each["level"] for each in quiet} <= {"warning", "error"}
    assert not {"progress", "summary", "batch"} & kinds(quiet)


def test_iterations_limits_and_notices_have_their_numbers(invoke) -> None:
    result = invoke(
        *("--log-format", "json", "reduce", "cobra", "--set", "time.step_s=0.25", "-v", "-o", "-")
    )
    assert (result.exit_code, result.stdout[:3]) == (0, "t_s")
    said = messages(result.stderr)
    assert {"iteration", "limit", "notice", "summary"} < kinds(said)
    step = next(each for each in said if each["kind"] == "iteration")
    assert (step["level"], step["number"]) == ("debug", 0)
    worse = next(each for each in said if each.get("name") == "worse")
    assert (worse["level"], worse["profile"]) == ("warning", "cobra")


@pytest.mark.parametrize(
    ("args", "kind"),
    [
        (["reduce"], "usage"),
        (["reduce", "cobra", "--frobnicate"], "usage"),
        (["redcue"], "usage"),
        (["verify", "nowhere"], "error"),
        (["validate", "nowhere.yaml"], "error"),
        (["report", "nowhere"], "error"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else value,
)
def test_what_is_wrong_is_told_in_that_form_too(invoke, args: list[str], kind: str) -> None:
    plain, result = invoke(*args), invoke("--log-format", "json", *args)
    assert result.exit_code == plain.exit_code != 0
    said = [each for each in messages(result.stderr) if each["level"] == "error"]
    assert [(each["kind"], each["exit_code"]) for each in said] == [(kind, plain.exit_code)]
    assert "\x1b" not in invoke("--color", "always", "--log-format", "json", *args).stderr


def test_a_check_that_failed_has_its_numbers(invoke, write_profile, tmp_path) -> None:
    assert invoke("-q", "reduce", write_profile("one").name, "--no-plots").exit_code == 0
    result = invoke("verify", "runs/one", "--fork-deg", "9", "--log-format", "json")
    assert result.exit_code == 5
    checks = [each for each in messages(result.stderr) if each["kind"] == "check"]
    assert checks
    assert all(each["target"] == "runs/one" and "." in each["name"] for each in checks)
    assert all(each["value"] > each["tolerance"] for each in checks)
