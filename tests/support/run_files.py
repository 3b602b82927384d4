"""What ``reduce`` writes, read back."""

import io
import json
from pathlib import Path

import numpy as np

RUN_FILES = {"commands.csv", "trajectory.parquet", "metrics.json", "manifest.json"}
HEADER = "t_s,arm_rpm,fork_deg,cab_deg"


def csv_rows(text: str) -> np.ndarray:
    """The rows of a command table, (n, 4)."""
    header, _, body = text.partition("\n")
    assert header == HEADER
    return np.loadtxt(io.StringIO(body), delimiter=",")


def metrics_of(folder: Path) -> dict:
    """The metrics of a run folder."""
    return json.loads((folder / "metrics.json").read_text())
