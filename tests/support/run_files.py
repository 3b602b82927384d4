"""What ``reduce`` writes, read back."""

import hashlib
import io
import json
from pathlib import Path
from typing import Any

import numpy as np

from des_cli.runs_out.manifest import seal

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
    """Change entries of a manifest and seal it again, as a forger would."""
    manifest = json.loads((folder / "manifest.json").read_bytes()) | changes
    manifest.pop("sha256", None)
    (folder / "manifest.json").write_bytes(seal(manifest))


def replace_file(folder: Path, name: str, data: bytes) -> None:
    """Replace a file of a run and what the manifest says of it, as a forger would."""
    (folder / name).write_bytes(data)
    files = json.loads((folder / "manifest.json").read_bytes())["files"]
    for each in files:
        if each["name"] == name:
            each |= {"size": len(data), "sha256": hashlib.sha256(data).hexdigest()}
    rewrite(folder, files=files)


def entry(name: object = "metrics.json", size: object = 0, sha256: object = "0" * 64) -> object:
    return {"name": name, "size": size, "sha256": sha256}
