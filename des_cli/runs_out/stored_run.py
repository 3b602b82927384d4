"""A run read back from its folder: only as its manifest has it, every digest checked."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from des_cli.errors import Complaint, FileAccessError, UnreadableError
from des_cli.model.arrays import Floats
from des_cli.runs_out.manifest import (
    COMMANDS,
    MANIFEST,
    METRICS,
    SOURCE,
    TRAJECTORY,
    parse_object,
    read_bytes,
    read_manifest,
)
from des_cli.runs_out.tables import trajectory_names


@dataclass(frozen=True)
class StoredRun:
    """A run as it was read back from its folder, every digest checked.

    Parameters
    ----------
    name : str
        The profile's name.
    folder : Path
    metrics : dict
        The content of ``metrics.json``.
    trajectory : dict of str to (n,) array
        The columns of ``trajectory.parquet``.
    manifest : dict
        The content of ``manifest.json``.
    commands : bytes
        The command table, not read.
    sources : dict of str to bytes
        What the profile was read from, by the names of the files in ``source/``.
    """

    name: str
    folder: Path
    metrics: dict[str, Any]
    trajectory: dict[str, Floats]
    manifest: dict[str, Any]
    commands: bytes = b""
    sources: dict[str, bytes] = field(default_factory=dict)


def read_run(folder: str | os.PathLike[str]) -> StoredRun:
    """Read a run back, and check every file against the manifest.

    Raises
    ------
    FileAccessError
        If a file is missing or changed; with all complaints.
    UnreadableError
        If nothing is known to be wrong but that a file cannot be read.
    """
    home = Path(folder)
    manifest = read_manifest(home)
    complaints: list[Complaint] = []
    unreadable: list[Complaint] = []
    content: dict[str, bytes] = {}
    sources: dict[str, bytes] = {}
    for entry in manifest["files"]:
        path = home / entry["name"]
        try:
            data = read_bytes(path)
        except UnreadableError as error:
            unreadable += error.complaints
            continue
        except FileAccessError as error:
            complaints += error.complaints
            continue
        if len(data) != entry["size"] or hashlib.sha256(data).hexdigest() != entry["sha256"]:
            what = "is not the file that the manifest lists: it was changed after the run"
            complaints.append(Complaint(str(path), what))
        if entry["name"] in (COMMANDS, METRICS, TRAJECTORY):
            content[entry["name"]] = data
        elif entry["name"].startswith(SOURCE):
            sources[entry["name"].removeprefix(SOURCE)] = data
    listed = {entry["name"] for entry in manifest["files"]}
    complaints += [
        Complaint(str(home / MANIFEST), f"does not list {name}")
        for name in (COMMANDS, TRAJECTORY, METRICS)
        if name not in listed
    ]
    if complaints:
        raise FileAccessError([*complaints, *unreadable])
    if unreadable:
        raise UnreadableError(unreadable)
    return StoredRun(
        name=manifest["profile"]["name"],
        folder=home,
        metrics=parse_object(home / METRICS, content[METRICS]),
        trajectory=_read_trajectory(home / TRAJECTORY, content[TRAJECTORY]),
        manifest=manifest,
        commands=content[COMMANDS],
        sources=sources,
    )


def _read_trajectory(path: Path, data: bytes) -> dict[str, Floats]:
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        # Without threads of its own: one that still ends when the process does aborts it.
        table = pq.read_table(pa.BufferReader(data), use_threads=False, pre_buffer=False)
        columns = {
            name: np.asarray(column.to_numpy(), dtype=np.float64)
            for name, column in zip(table.column_names, table.columns, strict=True)
        }
    except (pa.ArrowException, OSError, ValueError, TypeError) as error:
        words = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise FileAccessError([Complaint(str(path), f"cannot be read: {words}")]) from error
    # A free motion has neither factors nor an adjoint; one within budgets per joint has ratios.
    factors = 1 if "p" in columns else 3 if any(name.startswith("p_") for name in columns) else 0
    adjoint = factors == 1 or any(name.startswith("adjoint_") for name in columns)
    names = trajectory_names(factors, adjoint=adjoint)
    absent = [name for name in names if name not in columns]
    if absent:
        raise FileAccessError([Complaint(str(path), f"has no column {name}") for name in absent])
    return columns
