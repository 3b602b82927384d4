"""Jobs are data, and run the same wherever an Executor takes them."""

from __future__ import annotations

import os
import threading
import weakref
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import pytest

from des_cli.batch import runner
from des_cli.batch.execution import run_job
from des_cli.batch.job import Job, JobResult, Output
from des_cli.batch.pool import local_executor
from des_cli.batch.runner import run_tasks
from des_cli.batch.source import Source
from des_cli.errors import ExitCode, ProfileError

COARSE = ("time.step_s=0.25",)
COBRA = Source("cobra", settings=COARSE)
TO_STDOUT = Output("-", out_is_parent=False, table_format="csv")


class Pretend:
    """Work that only tells that it was done; jobs called bad fail."""

    def __init__(self) -> None:
        self.ran: list[str] = []

    def __call__(self, job: Job, *told: object) -> JobResult:
        self.ran.append(job.label)
        if job.label == "bad":
            return JobResult.failed(job, ProfileError.of("bad"))
        return JobResult(job.label, job.label)


@dataclass(eq=False)
class Held:
    """A result of which a test counts how many there are."""

    label: str
    ok: bool = True

    @classmethod
    def failed(cls, task: Job, error: Exception) -> Held:
        return cls(task.label, ok=False)


JOBS = [Job(Source(name)) for name in ("a", "bad", "b", "c")]


@pytest.mark.parametrize("threads", [0, 1, 3])
def test_results_come_in_the_order_of_the_tasks(threads: int) -> None:
    ended: list[None] = []

    def on_finished() -> None:
        ended.append(None)

    how = {"keep_going": True, "on_finished": on_finished}
    if not threads:
        results = list(run_tasks(JOBS, Pretend(), JobResult.failed, **how))
    else:
        with ThreadPoolExecutor(threads) as executor:
            results = list(run_tasks(JOBS, Pretend(), JobResult.failed, executor, **how))
    assert len(ended) == 4
    assert [result.source for result in results] == ["a", "bad", "b", "c"]
    assert [result.exit_code for result in results] == [0, 3, 0, 0]


def test_without_a_pool_nothing_runs_after_a_failure() -> None:
    pretend = Pretend()
    results = list(run_tasks(JOBS, pretend, JobResult.failed))
    assert [result.source for result in results] == pretend.ran == ["a", "bad"]


def test_with_a_pool_what_had_begun_is_told_and_nothing_else_begins() -> None:
    begun, go_on = threading.Event(), threading.Event()

    def run(job: Job, *told: object) -> JobResult:
        if job.label == "bad":
            assert begun.wait(30)
            return JobResult.failed(job, ProfileError.of("bad"))
        begun.set()
        assert go_on.wait(30)
        return JobResult(job.label, job.label)

    with ThreadPoolExecutor(2) as executor:
        names = ["bad", "b", *(f"c{i}" for i in range(50))]
        jobs = [Job(Source(name)) for name in names]
        results = []
        for result in run_tasks(jobs, run, JobResult.failed, executor):
            results.append(result.source)
            go_on.set()
    # The thread of the failed job may have taken up one more meanwhile, which
    # then waits; no other can begin before the rest is cancelled.
    assert results in (["bad", "b"], ["bad", "b", "c0"])


def die(job: Job, *told: object) -> JobResult:
    Path(job.label).touch()
    os._exit(9)


def test_a_worker_that_dies_fails_its_task(tmp_path: Path) -> None:
    begun = tmp_path / "begun"
    with local_executor(2) as executor:
        [result] = run_tasks([Job(Source(str(begun)))], die, JobResult.failed, executor)
    assert begun.exists()
    assert result.exit_code == ExitCode.FILE
    assert result.complaints == (f"{begun}: {runner.LOST}",)
    assert "worker process died" in runner.LOST


def test_a_dask_client_is_one_more_executor() -> None:
    distributed = pytest.importorskip("distributed")
    jobs = [
        Job(Source(name, COARSE), TO_STDOUT) for name in ("cobra", "nowhere.yaml", "cobra_table3")
    ]
    options = {"n_workers": 1, "threads_per_worker": 1, "dashboard_address": None}
    with distributed.Client(processes=False, **options) as client:
        executor = client.get_executor()
        results = list(run_tasks(jobs, run_job, JobResult.failed, executor, keep_going=True))
    assert results == list(run_tasks(jobs, run_job, JobResult.failed, keep_going=True))
    assert [result.exit_code for result in results] == [0, 1, 0]


def test_a_long_batch_keeps_few_results(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runner, "AHEAD", 4)
    alive: weakref.WeakSet[Held] = weakref.WeakSet()
    most = 0

    def run(job: Job, *told: object) -> Held:
        held = Held(job.label)
        alive.add(held)
        return held

    names = [str(k) for k in range(50)]
    jobs = [Job(Source(name)) for name in names]
    told = []
    with ThreadPoolExecutor(2) as executor:
        for result in run_tasks(jobs, run, Held.failed, executor):
            told.append(result.label)
            most = max(most, len(alive))
    assert told == names
    assert most <= 4 + 3  # that wait, are computed and are told


def test_a_pool_that_breaks_fails_what_it_was_not_yet_given(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(runner, "AHEAD", 1)
    jobs = [Job(Source(str(tmp_path / name))) for name in ("a", "b", "c")]
    with local_executor(2) as executor:
        results = list(run_tasks(jobs, die, JobResult.failed, executor, keep_going=True))
    assert [result.source for result in results] == [job.label for job in jobs]
    assert all(runner.LOST in result.complaints[0] for result in results)
