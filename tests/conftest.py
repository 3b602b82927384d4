"""Fixtures that more than one folder of tests needs."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import settings

import des_cli
from des_cli.model.run import Run
from tests.support.runs import make_run

# The same examples in every run, so that a check fails for a change and for nothing else;
# HYPOTHESIS_PROFILE=searching looks for new ones.
settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.register_profile("searching", deadline=None, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))

Command = Callable[..., subprocess.CompletedProcess[bytes]]


@pytest.fixture(scope="session")
def python_environment() -> dict[str, str]:
    """An environment in which a fresh interpreter finds des_cli from any folder."""
    quiet = {"NO_COLOR", "DES_CORIOLIS_DEBUG", "FORCE_COLOR"}
    kept = {name: value for name, value in os.environ.items() if name not in quiet}
    return {**kept, "PYTHONPATH": str(Path(des_cli.__file__).parents[1])}


@pytest.fixture
def command(tmp_path: Path, python_environment: dict[str, str]) -> Command:
    """Run ``des-coriolis`` in a process of its own, in the test's folder."""

    def run(*args: str, **options: Any) -> subprocess.CompletedProcess[bytes]:
        environment = python_environment | options.pop("env", {})
        return subprocess.run(
            [sys.executable, "-m", "des_cli", *args],
            cwd=tmp_path,
            env=environment,
            check=False,
            **({"capture_output": True} | options),
        )

    return run


@pytest.fixture
def synthetic_run() -> Callable[..., Run]:
    """A function that makes a run of closed forms; see `make_run`."""
    return make_run
