"""What vouches for a run: its form, and JSON whose bytes do not vary."""

import hashlib
import json
import math
import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from des_cli import __version__
from des_cli.errors import FileAccessError
from des_cli.model.run import Run
from des_cli.profiles_in.machine_yaml import machine_mapping
from des_cli.runs_out.blas import blas_kernels
from des_cli.runs_out.manifest import (
    UNSEALED_FORMAT,
    encode_json,
    is_run,
    is_sealed,
    parse_object,
    read_manifest,
)
from des_cli.runs_out.run_folder import write_run
from des_cli.runs_out.stored_run import read_run
from tests.support.run_files import entry, rewrite, tree

MakeRun = Callable[..., Run]


def test_the_manifest_lists_every_file_with_size_and_digest(stored: Path) -> None:
    manifest = json.loads((stored / "manifest.json").read_bytes())
    assert manifest["format"] == "des-coriolis/run/2"
    tool = {"name": "des-coriolis", "version": __version__, "blas": blas_kernels()}
    assert manifest["tool"] == tool
    assert manifest["profile"] == {"name": "cobra", "sha256": "5c" * 32}
    listed = {entry["name"]: entry for entry in manifest["files"]}
    files = tree(stored)
    assert set(listed) == set(files) - {"manifest.json"}
    for name, each in listed.items():
        assert each["size"] == len(files[name])
        assert each["sha256"] == hashlib.sha256(files[name]).hexdigest()


@pytest.mark.parametrize(
    "changes",
    [
        {"format": "des-coriolis/run/3"},
        {"format": ["des-coriolis/run/2"]},
        {"profile": {}},
        {"profile": {"name": 7}},
        {"files": None},
        {"files": ["metrics.json"]},
        {"files": [entry(name="../secret")]},
        {"files": [entry(name="/etc/passwd")]},
        {"files": [entry(name="manifest.json")]},
        {"files": [entry(name="")]},
        {"files": [entry(name="a\0b")]},
        {"files": [entry(size=True)]},
        {"files": [entry(size="12")]},
        {"files": [entry(sha256="0" * 63)]},
        {"files": [entry(sha256=None)]},
    ],
)
def test_a_manifest_of_another_form_is_no_run(stored: Path, changes: dict[str, Any]) -> None:
    rewrite(stored, **changes)
    assert not is_run(stored)
    with pytest.raises(FileAccessError, match=r"manifest\.json"):
        read_run(stored)


def test_the_manifest_tells_what_is_needed_to_check_the_table_again(
    synthetic_run: MakeRun, tmp_path: Path
) -> None:
    run = synthetic_run()
    write_run(run, tmp_path / "run", plots=False)
    manifest = read_manifest(tmp_path / "run")
    assert manifest["machine"] == machine_mapping(run.profile.machine)
    assert manifest["seat"] == {"yaw_rad": run.seat.yaw, "pitch_rad": run.seat.pitch}
    assert manifest["start"] == {"arm_rad": run.commands.angle[0, 0]}
    assert manifest["limits"] == run.profile.reduction.limits


def test_a_manifest_that_is_cut_anywhere_is_no_run(stored: Path) -> None:
    path = stored / "manifest.json"
    whole = path.read_bytes()
    for length in range(len(whole)):
        path.write_bytes(whole[:length])
        assert not is_run(stored), length


def test_a_manifest_with_a_changed_byte_is_no_run(stored: Path) -> None:
    path = stored / "manifest.json"
    whole = path.read_bytes()
    rng = np.random.default_rng(3)
    for place in range(len(whole)):
        changed = bytearray(whole)
        changed[place] ^= int(rng.integers(1, 256))
        path.write_bytes(bytes(changed))
        assert not is_run(stored), place
    path.write_bytes(whole + b"\n")
    assert not is_run(stored)
    path.write_bytes(whole)
    assert is_run(stored)


def test_a_run_of_an_earlier_version_is_read_without_a_seal(stored: Path) -> None:
    manifest = json.loads((stored / "manifest.json").read_bytes())
    old = {key: manifest[key] for key in ("profile", "files")} | {"format": UNSEALED_FORMAT}
    (stored / "manifest.json").write_bytes(encode_json(old))
    assert not is_sealed(read_run(stored).manifest)


@pytest.mark.parametrize(
    "data", [b"", b"[]", b"null", b"\xff\xfe", b"{", b'{"a":1}x', b"[" * 100_000]
)
def test_a_manifest_that_is_no_json_object_is_one_line(stored: Path, data: bytes) -> None:
    (stored / "manifest.json").write_bytes(data)
    with pytest.raises(FileAccessError, match="JSON") as caught:
        read_manifest(stored)
    assert "\n" not in str(caught.value)


def test_a_folder_without_a_manifest_is_no_run(tmp_path: Path, stored: Path) -> None:
    assert is_run(stored)
    (stored / "manifest.json").unlink()
    assert not is_run(stored)
    assert not is_run(tmp_path / "absent")
    with pytest.raises(FileAccessError, match=r"is not a run: it has no manifest\.json"):
        read_run(stored)


def test_a_folder_that_was_still_being_built_is_no_run(stored: Path) -> None:
    assert not is_run(stored.rename(stored.parent / ".cobra.partial-0123abcd"))


def test_json_is_exact_ordered_and_knows_no_infinity() -> None:
    content = {"b": np.float64(0.1), "a": {"x": math.inf, "n": np.int64(3), "ok": np.True_}}
    content["c"] = [np.nan, np.array([1e-300, 2.5])]
    data = encode_json(content)
    assert data.endswith(b"}\n")
    found = json.loads(data)
    assert list(found) == ["b", "a", "c"]
    assert found == {"b": 0.1, "a": {"x": None, "n": 3, "ok": True}, "c": [None, [1e-300, 2.5]]}
    assert b"true" in data


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
def test_a_pipe_in_the_place_of_a_file_is_not_waited_for(stored: Path) -> None:
    (stored / "metrics.json").unlink()
    os.mkfifo(stored / "metrics.json")
    with pytest.raises(FileAccessError, match=r"metrics\.json: is a pipe, not a file"):
        read_run(stored)
    (stored / "manifest.json").unlink()
    os.mkfifo(stored / "manifest.json")
    assert not is_run(stored)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"{", "is not JSON: Expecting property name enclosed in double quotes: line 1"),
        (b"9" * 5000, "is not JSON"),
        (b"[" * 100_000, "is not JSON"),
        (b"\xff", "is not JSON"),
        (b"[]", "is not a JSON object"),
    ],
    ids=["cut", "digits", "deep", "bytes", "list"],
)
def test_what_is_no_json_is_told_without_words_for_programmers(data: bytes, words: str) -> None:
    with pytest.raises(FileAccessError) as caught:
        parse_object(Path("m.json"), data)
    assert str(caught.value).startswith(f"m.json: {words}")
    assert not re.search(r"sys\.|recursion|codec", str(caught.value))
