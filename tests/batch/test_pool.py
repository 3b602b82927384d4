"""Processes with one BLAS thread each, and none where one worker is enough."""

import os

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from des_cli.batch.pool import available_cpus, local_executor, single_blas_thread


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
