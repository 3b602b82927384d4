"""One job, from its source to its output."""

import os
import pickle
from dataclasses import replace
from pathlib import Path

import pytest

from des_cli.batch import execution
from des_cli.batch.execution import run_job
from des_cli.batch.job import Job, Output
from des_cli.batch.source import Source
from des_cli.errors import ExitCode

COBRA = Source("cobra", settings=("time.step_s=0.25",))
TO_STDOUT = Output("-", out_is_parent=False, table_format="csv")


def test_a_job_and_its_result_cross_process_boundaries(tmp_path: Path) -> None:
    out = str(tmp_path / "x.csv")
    job = Job(COBRA, Output(out, out_is_parent=False, table_format="csv"))
    result = run_job(pickle.loads(pickle.dumps(job)))
    assert (result.exit_code, result.name, result.state) == (0, "cobra", "reduced")
    assert pickle.loads(pickle.dumps(result)) == result


def test_result_carries_what_a_person_needs(tmp_path: Path) -> None:
    result = run_job(Job(COBRA, TO_STDOUT))
    assert result.table is not None
    assert result.table.startswith(b"t_s,arm_rpm,fork_deg,cab_deg\n")
    assert result.objective == ("bb3",)
    assert result.metrics is not None
    assert result.log
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(os.name == "nt", reason="nothing is locked on Windows")
def test_a_run_that_is_kept_has_no_traces_of_a_killed_process_beside_it(tmp_path: Path) -> None:
    output = Output(str(tmp_path), plots=False, resume=True)
    assert run_job(Job(COBRA, output)).state == "reduced"
    lock, partial = tmp_path / ".cobra.lock", tmp_path / ".cobra.partial-0123abcd"
    lock.write_text("1\n")
    partial.mkdir()
    (partial / "commands.csv").write_bytes(b"of an earlier run")
    assert run_job(Job(COBRA, replace(output, dry_run=True))).state == "kept"
    assert lock.exists()
    assert run_job(Job(COBRA, output)).state == "kept"
    assert [path.name for path in tmp_path.iterdir()] == ["cobra"]


def test_a_rejected_profile_is_a_result_and_not_an_exception() -> None:
    result = run_job(Job(Source("cobra", settings=("time.step_s=-1",))))
    assert (result.exit_code, result.state) == (ExitCode.PROFILE, "failed")
    assert result.complaints


def test_a_bug_is_a_result_with_a_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(source: Source) -> None:
        raise ZeroDivisionError("by nought")

    monkeypatch.setattr(execution, "load_source", broken)
    result = run_job(Job(Source("cobra")))
    assert result.exit_code == ExitCode.BUG
    assert "ZeroDivisionError" in result.traceback
