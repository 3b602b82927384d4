"""The manifest of a run, and JSON whose bytes do not vary."""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from des_cli import __version__
from des_cli.errors import Complaint, FileAccessError
from des_cli.model.origin import Origin
from des_cli.model.run import Run
from des_cli.profiles_in.machine_yaml import machine_mapping
from des_cli.profiles_in.source import label_of, read_source
from des_cli.runs_out.atomic import is_temporary
from des_cli.runs_out.blas import blas_kernels
from des_cli.runs_out.plain_words import plain_words

RUN_FORMAT = "des-coriolis/run/2"
UNSEALED_FORMAT = "des-coriolis/run/1"
"""Of earlier versions: without a seal, and without the machine."""


MANIFEST = "manifest.json"
COMMANDS = "commands.csv"
TRAJECTORY = "trajectory.parquet"
PROFILE = "profile.yaml"
METRICS = "metrics.json"
"""Names of the outputs of a run, as seen from its folder."""

SOURCE = "source/"
"""The folder of what the profile was read from."""

AGAIN = "again"
"""The folder in which the command of a manifest makes the run again."""

_SHA256 = re.compile(r"[0-9a-f]{64}")
_SEAL = re.compile(rb',\n  "sha256": "([0-9a-f]{64})"\n\}\n\Z')
"""The end of a sealed manifest: the digest of all bytes before it."""


def encode_json(content: Mapping[str, Any]) -> bytes:
    """Return JSON in the bytes that the same content always has.

    Keys keep their order, numbers their shortest exact form; a number that is
    not finite, which JSON does not know, becomes ``null``.
    """
    return (json.dumps(_plain(content), indent=2, allow_nan=False) + "\n").encode()


def encode_manifest(run: Run, outputs: Mapping[str, bytes]) -> bytes:
    """Return the manifest of the outputs of a run: what they are, and of what.

    Its last entry is a digest of everything before it, so that a change of the manifest
    itself is seen.

    Parameters
    ----------
    run : Run
    outputs : mapping of str to bytes
        File names, as seen from the folder, and what is in the files.
    """
    profile = run.profile
    return seal(
        {
            "format": RUN_FORMAT,
            "tool": {"name": "des-coriolis", "version": __version__, "blas": blas_kernels()},
            "profile": {"name": profile.name, "sha256": profile.sha256},
            "machine": machine_mapping(profile.machine),
            "seat": {"yaw_rad": run.seat.yaw, "pitch_rad": run.seat.pitch},
            "start": {"arm_rad": float(run.commands.angle[0, 0])},
            "limits": profile.reduction.limits,
            **({"made": {"command": _command(profile.origin)}} if profile.origin else {}),
            "files": [
                {"name": name, "size": len(data), "sha256": hashlib.sha256(data).hexdigest()}
                for name, data in outputs.items()
            ],
        }
    )


def _command(origin: Origin) -> list[str]:
    """Return the words of the command that makes a run again, given in its folder."""
    source = f"{SOURCE}{origin.files[0].name}"
    return ["des-coriolis", "reduce", source, *origin.options, "-o", AGAIN]


def seal(content: Mapping[str, Any]) -> bytes:
    """Return JSON whose last entry is the digest of everything before it."""
    body = encode_json(content).removesuffix(b"\n}\n")
    return b'%b,\n  "sha256": "%b"\n}\n' % (body, hashlib.sha256(body).hexdigest().encode())


def is_run(folder: str | os.PathLike[str]) -> bool:
    """Tell whether a folder holds a run: whether a manifest of a run is there.

    A folder in which a killed process was still building one does not.
    """
    if is_temporary(Path(folder).name):
        return False
    try:
        read_manifest(folder)
    except FileAccessError:
        return False
    return True


def read_manifest(folder: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the manifest of a run, its form checked but not yet its files.

    Raises
    ------
    FileAccessError
        If there is none, or it is not one of this format; with all complaints.
    UnreadableError
        If it cannot be read.
    """
    path = Path(folder) / MANIFEST
    with plain_words(path, "cannot be read"):
        if not _may_exist(path):
            raise FileAccessError([Complaint(str(folder), f"is not a run: it has no {MANIFEST}")])
    data = read_bytes(path)
    manifest = parse_object(path, data)
    complaints = [Complaint(str(path), what) for what in _malformed(manifest, data)]
    if complaints:
        raise FileAccessError(complaints)
    return manifest


def _may_exist(path: Path) -> bool:
    # Path.exists() says no to a folder without permission from Python 3.14 on.
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return False
    except OSError:
        return True
    return True


def read_bytes(path: Path) -> bytes:
    """Return the bytes of a regular file, or raise FileAccessError."""
    return read_source(path, label_of(path), None)


def parse_object(path: Path, data: bytes) -> dict[str, Any]:
    """Return the JSON object in the bytes of a file, or raise FileAccessError."""
    try:
        content = json.loads(data)
    except (ValueError, RecursionError) as error:
        # Only the parser's own words are for people: "Expecting value: line 1 column 1".
        words = f": {error}" if isinstance(error, json.JSONDecodeError) else ""
        raise FileAccessError([Complaint(str(path), f"is not JSON{words}")]) from error
    if not isinstance(content, dict):
        raise FileAccessError([Complaint(str(path), "is not a JSON object")])
    return content


def is_sealed(manifest: Mapping[str, Any]) -> bool:
    """Tell the manifest of this version, sealed and with its machine, from an earlier one."""
    return manifest["format"] == RUN_FORMAT


def _malformed(manifest: Mapping[str, Any], data: bytes) -> list[str]:
    """Return what is wrong with the form of a manifest, a sentence each."""
    if manifest.get("format") not in (RUN_FORMAT, UNSEALED_FORMAT):
        return [f"is not the manifest of a run: its format is not {RUN_FORMAT}"]
    if is_sealed(manifest) or "sha256" in manifest:
        found = _SEAL.search(data)
        body = data[: found.start()] if found else b""
        if found is None or hashlib.sha256(body).hexdigest().encode() != found[1]:
            return ["was changed after the run: its own sha256 is not that of what it says"]
    wrong = []
    profile = manifest.get("profile")
    if not isinstance(profile, dict) or not isinstance(profile.get("name"), str):
        wrong.append("profile.name is missing")
    files = manifest.get("files")
    if not isinstance(files, list):
        return [*wrong, "files is missing"]
    for i, entry in enumerate(files):
        if not (
            isinstance(entry, dict)
            and _inside(entry.get("name"))
            and type(entry.get("size")) is int
            and isinstance(entry.get("sha256"), str)
            and _SHA256.fullmatch(entry["sha256"])
        ):
            wrong.append(f"files[{i}] is not an entry with name, size and sha256 inside the folder")
    return wrong


def _inside(name: object) -> bool:
    """Tell whether a name in a manifest stays inside the folder."""
    if not isinstance(name, str) or not name or "\0" in name or "\\" in name:
        return False
    path = PurePosixPath(name)
    return not path.is_absolute() and ".." not in path.parts and path.name != MANIFEST


def _plain(value: Any) -> Any:
    """Turn numpy's scalars and arrays into what JSON knows."""
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
