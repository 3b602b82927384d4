"""What a worker of a cluster does with an order, without a cluster."""

from __future__ import annotations

import pickle
from pathlib import Path

from des_cli.batch.execution import run_job
from des_cli.batch.job import Job, Output
from des_cli.batch.remote import Delivery, Order, fulfil
from des_cli.batch.source import Source, load_source
from des_cli.errors import ExitCode
from tests.support.run_files import tree

COARSE = ("time.step_s=0.25",)


def order(*settings: str, **changes: str) -> Order:
    """An order as it arrives: from another process."""
    source = Source("cobra", (*COARSE, *settings))
    job = Job(source, Output(plots=False))
    made = Order(job, load_source(source), **changes)
    arrived = pickle.loads(pickle.dumps(made))
    assert isinstance(arrived, Order)
    return arrived


def test_the_files_are_those_that_a_local_run_writes(tmp_path: Path) -> None:
    delivery = pickle.loads(pickle.dumps(fulfil(order())))
    assert isinstance(delivery, Delivery)
    assert (delivery.result.exit_code, delivery.result.written) == (ExitCode.DONE, "")
    local = run_job(Job(Source("cobra", COARSE), Output(str(tmp_path / "out"), plots=False)))
    assert local.metrics == delivery.result.metrics
    assert tree(tmp_path / "out" / "cobra") == dict(sorted(delivery.outputs.items()))
    assert list(delivery.outputs)[-1] == "manifest.json"


def test_what_has_no_answer_comes_back_in_words_and_without_files() -> None:
    limits = ("reduction.limits=check", "machine.limits.fork.acceleration_rad_s2=0.01")
    delivery = fulfil(order(*limits))
    assert delivery.result.exit_code == ExitCode.NOT_RELEASED
    assert any("fork" in line for line in delivery.result.complaints)
    assert delivery.result.state == "failed"
    assert delivery.outputs == {}


def test_another_version_computes_nothing() -> None:
    delivery = fulfil(order(version="0.0.0"))
    assert delivery.result.exit_code == ExitCode.FILE
    assert "not 0.0.0" in delivery.result.complaints[0]
    assert delivery.outputs == {}
