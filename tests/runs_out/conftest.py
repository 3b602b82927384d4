"""A run as it stands in its folder."""

from collections.abc import Callable
from pathlib import Path

import pytest

from des_cli.model.run import Run
from des_cli.runs_out.run_folder import write_run

MakeRun = Callable[..., Run]


@pytest.fixture
def stored(tmp_path: Path, synthetic_run: MakeRun) -> Path:
    folder = tmp_path / "runs" / "cobra"
    write_run(synthetic_run(), folder, plots=False)
    return folder
