"""One job, from its source to its output."""

import pickle
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
