"""A run that was read back is the one that was written, or there is none."""

import hashlib
import json
import os
from pathlib import Path

import pytest

from des_cli.errors import FileAccessError
from des_cli.runs_out.manifest import is_run
from des_cli.runs_out.stored_run import read_run
from tests.support.run_files import rewrite


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in folders")
@pytest.mark.parametrize("name", ["commands.csv", "manifest.json", "metrics.json"])
@pytest.mark.parametrize("kind", ["pipe", "device"])
def test_only_files_are_read(stored: Path, name: str, kind: str) -> None:
    (stored / name).unlink()
    if kind == "pipe":
        os.mkfifo(stored / name)
    else:
        (stored / name).symlink_to("/dev/zero")
    with pytest.raises(FileAccessError, match="not a file"):
        read_run(stored)
    assert is_run(stored) is (name != "manifest.json")


@pytest.mark.parametrize("name", ["commands.csv", "metrics.json", "trajectory.parquet"])
def test_a_changed_byte_is_found(stored: Path, name: str) -> None:
    data = bytearray((stored / name).read_bytes())
    data[len(data) // 2] ^= 1
    (stored / name).write_bytes(data)
    with pytest.raises(FileAccessError, match="is not the file that the manifest lists") as caught:
        read_run(stored)
    assert [problem.where for problem in caught.value.complaints] == [str(stored / name)]


def test_all_problems_are_told_at_once(stored: Path) -> None:
    (stored / "commands.csv").unlink()
    (stored / "metrics.json").write_bytes(b"{}")
    with pytest.raises(FileAccessError) as caught:
        read_run(stored)
    assert len(caught.value.complaints) == 2
    assert all(str(stored) in str(problem) for problem in caught.value.complaints)


def test_a_manifest_that_lists_too_little_is_refused(stored: Path) -> None:
    rewrite(stored, files=[])
    with pytest.raises(FileAccessError) as caught:
        read_run(stored)
    assert len(caught.value.complaints) == 3


def replace_file(folder: Path, name: str, data: bytes) -> None:
    """Replace a file and have the manifest vouch for it."""
    (folder / name).write_bytes(data)
    manifest = json.loads((folder / "manifest.json").read_bytes())
    for listed in manifest["files"]:
        if listed["name"] == name:
            listed |= {"size": len(data), "sha256": hashlib.sha256(data).hexdigest()}
    rewrite(folder, **manifest)


@pytest.mark.parametrize("data", [b"", b"PAR1PAR1", b"not parquet" * 100])
def test_a_trajectory_that_is_no_parquet_is_one_line(stored: Path, data: bytes) -> None:
    replace_file(stored, "trajectory.parquet", data)
    with pytest.raises(FileAccessError, match=r"trajectory\.parquet: cannot be read") as caught:
        read_run(stored)
    assert "\n" not in str(caught.value)
