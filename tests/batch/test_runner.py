"""Jobs are data, and run the same wherever an Executor takes them."""

import os
import pickle
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from des_cli.batch import execution, runner
from des_cli.batch.execution import run_job
from des_cli.batch.job import Job, JobResult, Output
from des_cli.batch.pool import available_cpus, local_executor, single_blas_thread
from des_cli.batch.runner import run_tasks
from des_cli.batch.source import Source, require_distinct_names
from des_cli.errors import ExitCode, ProfileError, UsageError

COARSE = ("time.step_s=0.25",)
COBRA = Source("cobra", settings=COARSE)
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


class Pretend:
    """Work that only tells that it was done; jobs called bad fail."""

    def __init__(self) -> None:
        self.ran: list[str] = []

    def __call__(self, job: Job, *told: object) -> JobResult:
        self.ran.append(job.label)
        if job.label == "bad":
            return JobResult.failed(job, ProfileError.of("bad"))
        return JobResult(job.label, job.label)


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


def test_one_worker_needs_no_pool() -> None:
    with local_executor(1) as executor:
        assert executor is None


def test_workers_have_one_blas_thread_each() -> None:
    with local_executor(2) as executor:
        assert executor is not None
        names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
        assert [executor.submit(os.getenv, name).result() for name in names] == ["1"] * 3


def test_a_blas_that_is_loaded_already_has_one_thread_too() -> None:
    def threads() -> set[int]:
        return {pool["num_threads"] for pool in threadpool_info() if pool["user_api"] == "blas"}

    with threadpool_limits(limits=2, user_api="blas"):
        before = threads()
        if not before:
            pytest.skip("the BLAS of numpy here has no threads that can be counted")
        with single_blas_thread():
            assert threads() == {1}
        assert threads() == before


def test_the_number_of_threads_is_put_back(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    monkeypatch.delenv("MKL_NUM_THREADS", raising=False)
    with single_blas_thread():
        assert os.environ["OMP_NUM_THREADS"] == os.environ["MKL_NUM_THREADS"] == "1"
    assert os.environ["OMP_NUM_THREADS"] == "7"
    assert "MKL_NUM_THREADS" not in os.environ


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="no affinity on this system")
def test_cpus_are_counted_by_affinity() -> None:
    before = os.sched_getaffinity(0)
    try:
        os.sched_setaffinity(0, {min(before)})
        assert available_cpus() == 1
    finally:
        os.sched_setaffinity(0, before)
    assert available_cpus() == len(before)


def test_names_that_occur_twice_are_refused_together() -> None:
    with pytest.raises(UsageError) as caught:
        require_distinct_names([Source("cobra"), Source("nowhere.yaml"), COBRA])
    assert [problem.where for problem in caught.value.complaints] == ["cobra"]
    require_distinct_names([Source("cobra"), Source("nowhere.yaml")])


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
