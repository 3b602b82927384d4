"""The machine of a run, as far as its manifest says it."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of
from des_cli.model.metrics import Constant, Metrics
from des_cli.model.run import Run
from des_cli.runs_out.run_folder import write_run
from des_cli.runs_out.stored_run import read_run
from des_cli.show.page.machine_view import machine_view


@pytest.fixture
def manifest(tmp_path: Path, synthetic_run: Callable[..., Run]) -> dict[str, Any]:
    write_run(synthetic_run(11), tmp_path / "run", plots=False)
    return read_run(tmp_path / "run").manifest


def test_the_chain_of_a_run_comes_back(
    manifest: dict[str, Any], synthetic_run: Callable[..., Run]
) -> None:
    run = synthetic_run(11)
    view = machine_view(manifest, Metrics())
    assert view is not None
    assert view.before == view.after == run.seat
    chains = json.loads(json.dumps(view.chains()))
    expected = chain_of(run.profile.machine, run.seat)
    np.testing.assert_array_equal(chains["after"]["constants"], expected.constants)
    assert chains["after"]["signs"] == list(expected.signs)


def test_a_seat_that_was_found_is_another_before(manifest: dict[str, Any]) -> None:
    view = machine_view(manifest, Metrics(parameters={"seat_yaw": Constant(30.0, 90.0)}))
    assert view is not None
    assert view.before.yaw == math.radians(30.0)
    assert view.before.pitch == view.after.pitch


@pytest.mark.parametrize(
    "change",
    [
        {"machine": None},
        {"machine": {"rows": "none"}},
        {"seat": None},
        {"seat": {"yaw_rad": "a quarter"}},
    ],
)
def test_what_is_no_machine_is_not_drawn(manifest: dict[str, Any], change: dict[str, Any]) -> None:
    assert machine_view(manifest | change, Metrics()) is None
