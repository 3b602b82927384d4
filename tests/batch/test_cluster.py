"""A job whose reduction is done elsewhere, by a cluster that does what a test wants."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from des_cli.batch import cluster as module
from des_cli.batch.cluster import cluster
from des_cli.batch.execution import run_job
from des_cli.batch.job import Job, JobResult, Output
from des_cli.batch.remote import Order, fulfil
from des_cli.batch.source import Source
from des_cli.errors import ExitCode, FileAccessError, UsageError

distributed = pytest.importorskip("distributed")


class Answer(Future[Any]):
    """A future of the cluster."""

    def release(self) -> None:
        """Nothing is kept."""


class Client:
    """A cluster of which a function answers each order."""

    def __init__(self, answer: Callable[[Order], Any]) -> None:
        self.answer, self.orders = answer, list[Order]()

    def submit(self, work: object, order: Order, *, pure: bool) -> Answer:
        assert (work, pure) == (fulfil, False)
        self.orders.append(order)
        future = Answer()
        try:
            future.set_result(self.answer(order))
        except BaseException as error:
            future.set_exception(error)
        return future


def job(tmp_path: Path, **output: Any) -> Job:
    source = Source("cobra", ("time.step_s=0.25",))
    return Job(source, Output(str(tmp_path / "out"), plots=False, **output))


def run(client: Client, task: Job) -> JobResult:
    pending: set[Any] = set()
    result = run_job(task, reduce=partial(module._reduce_there, client, pending))
    assert pending == set()
    return result


def test_the_owner_writes_what_comes_back_and_the_order_has_no_files(tmp_path: Path) -> None:
    client = Client(fulfil)
    result = run(client, job(tmp_path))
    assert (result.exit_code, result.written) == (0, str(tmp_path / "out" / "cobra"))
    assert (tmp_path / "out" / "cobra" / "manifest.json").is_file()
    assert client.orders[0].job.source.stdin is None
    assert run(client, job(tmp_path, resume=True)).state == "kept"
    assert run(client, job(tmp_path)).exit_code == ExitCode.FILE
    assert len(client.orders) == 1


def test_a_table_that_was_changed_on_the_way_is_not_written(tmp_path: Path) -> None:
    def tampered(order: Order) -> Any:
        made = fulfil(order)
        table = made.outputs["commands.csv"].replace(b"1", b"2", 1)
        return replace(made, outputs={**made.outputs, "commands.csv": table})

    result = run(Client(tampered), job(tmp_path))
    assert result.exit_code == ExitCode.NOT_RELEASED
    assert "a worker sent is wrong" in result.complaints[0]
    assert not (tmp_path / "out").exists()


def test_the_run_of_another_profile_is_not_written(tmp_path: Path) -> None:
    def other(order: Order) -> Any:
        return fulfil(replace(order, profile=replace(order.profile, sha256="0" * 64)))

    assert run(Client(other), job(tmp_path)).exit_code == ExitCode.NOT_RELEASED
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (distributed.KilledWorker("task", None, 3), "each worker that began with it died"),
        (asyncio.CancelledError(), "was given up"),
        (ModuleNotFoundError("no", name="des_cli"), "has no module des_cli"),
    ],
)
def test_what_ends_a_task_on_the_cluster_is_a_sentence(
    tmp_path: Path, error: BaseException, words: str
) -> None:
    def fail(order: Order) -> Any:
        raise error

    result = run(Client(fail), job(tmp_path))
    assert result.exit_code == ExitCode.FILE
    assert words in result.complaints[0]
    assert not result.traceback


@pytest.mark.parametrize("address", ["", "host", "tcp://host", "http://host:1", "tcp://a b:1"])
def test_what_is_no_address_is_refused(address: str) -> None:
    with pytest.raises(UsageError, match="is not an address"), cluster(address):
        pass


def test_without_dask_a_sentence_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(UsageError, match=r"pip install 'des-coriolis\[cluster\]'"):
        cluster("tcp://127.0.0.1:1").__enter__()


def test_nobody_answers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "CONNECT_S", 0.2)
    with pytest.raises(FileAccessError, match="no scheduler answers"):
        cluster("tcp://127.0.0.1:1").__enter__()
