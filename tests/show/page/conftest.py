"""Stored runs for the tests of the page."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from des_cli.model.run import Run
from des_cli.runs_out.stored_run import StoredRun
from des_cli.runs_out.tables import trajectory_columns

MakeRun = Callable[..., Run]


@pytest.fixture
def stored(synthetic_run: MakeRun) -> Callable[..., StoredRun]:
    def make(name: str = "cobra", **options: Any) -> StoredRun:
        run = synthetic_run(11, name=name, **options)
        manifest = {"tool": {"name": "des-coriolis", "version": "1.2.3"}}
        metrics = json.loads(json.dumps(run.metrics))
        return StoredRun(name, Path("runs/x"), metrics, trajectory_columns(run), manifest)

    return make
