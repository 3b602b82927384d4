"""What ``reduce`` writes, read back."""

import io
import json
from pathlib import Path
from typing import Any

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


def tree(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def rewrite(folder: Path, **changes: Any) -> None:
    manifest = json.loads((folder / "manifest.json").read_bytes()) | changes
    (folder / "manifest.json").write_bytes(json.dumps(manifest).encode())


def entry(name: object = "metrics.json", size: object = 0, sha256: object = "0" * 64) -> object:
    return {"name": name, "size": size, "sha256": sha256}
