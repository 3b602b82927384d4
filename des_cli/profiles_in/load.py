"""One profile from wherever it is: a file, standard input, or the built-in maneuvers."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from des_cli.errors import FileAccessError, Problem, ProfileError, UsageError
from des_cli.model.profile import Profile
from des_cli.profiles_in.builtin import builtin_profile, builtin_profiles
from des_cli.profiles_in.findings import Findings, bounded
from des_cli.profiles_in.profile_csv import parse_samples
from des_cli.profiles_in.profile_yaml import (
    Commands,
    Reading,
    finish,
    parse_profile,
    parse_settings,
)
from des_cli.profiles_in.schema import ProfileSettings
from des_cli.profiles_in.source import decode, label_of, read_source
from des_cli.profiles_in.wording import did_you_mean

STDIN_LABEL = "<stdin>"

_YAML_LINE = re.compile(r"""---|%YAML|[{\[]|["']?[\w. -]+["']?\s*:(\s|$)|- """)


def load_profile(
    source: str | Path,
    *,
    settings: Sequence[str] = (),
    columns: Mapping[str, str] | None = None,
    stdin: bytes | None = None,
) -> Profile:
    """Read and check a profile.

    Parameters
    ----------
    source : str or Path
        A ``.yaml``, ``.yml`` or ``.csv`` file, ``-`` for standard input, or
        the name of a built-in maneuver where no such file exists. Other files
        and standard input are YAML or CSV by what they hold.
    settings : sequence of str
        ``--set`` strings: ``reduction.r2=0.2``, ``joints.arm_rpm[1].to_s=4``.
    columns : mapping of str to str, optional
        For a CSV profile: the contract's name of a column, with its unit, to
        the name that it has in the file (``{"t_s": "t"}``).
    stdin : bytes, optional
        What standard input held, where ``source`` is ``-``.

    Returns
    -------
    Profile

    Raises
    ------
    ProfileError
        With everything that is wrong with the profile.
    FileAccessError
        If a file cannot be read.
    """
    columns = dict(columns or {})
    path, label, data = _read(source, stdin)
    text = decode(data, label)
    folder = path.parent if path else Path()
    digest = hashlib.sha256(data)
    if settings or columns:
        digest.update(json.dumps([list(settings), sorted(columns.items())]).encode())
    reading = Reading(label, folder, digest)
    name = _safe_name(path.stem if path else "stdin")
    try:
        if _is_yaml(path, text):
            if columns:
                raise UsageError(
                    [Problem(label, "--column renames columns of a CSV profile; this is YAML")]
                )
            return parse_profile(text, reading, name, settings)
        return _load_csv(text, reading, name, settings, columns)
    except ProfileError as error:
        raise ProfileError(bounded(error.problems)) from None


def _read(source: str | Path, stdin: bytes | None) -> tuple[Path | None, str, bytes]:
    """Return the path (None for standard input), the label and the bytes."""
    if source == "-":
        if stdin is None:
            raise FileAccessError([Problem(STDIN_LABEL, "nothing was given on standard input")])
        return None, STDIN_LABEL, stdin
    path, label = Path(source), label_of(source)
    try:
        there = path.exists()
    except (OSError, ValueError):
        there = True  # reading it says what is the matter
    if not there:
        builtin = builtin_profile(str(source))
        if builtin is None:
            names = [profile.name for profile in builtin_profiles()]
            hint = did_you_mean(str(source), names)
            what = f"there is no such file, and no built-in profile of that name{hint}"
            raise FileAccessError([Problem(label, what)])
        path, label = builtin.path, builtin.path.name
    return path, label, read_source(path, label)


def _is_yaml(path: Path | None, text: str) -> bool:
    """Tell YAML from CSV by the file's ending, or by its first line that says anything."""
    suffix = path.suffix.lower() if path else ""
    if suffix in (".yaml", ".yml", ".csv"):
        return suffix != ".csv"
    for line in text.splitlines()[:1000]:
        if line.strip() and not line.lstrip().startswith("#"):
            return _YAML_LINE.match(line) is not None
    return False


def _safe_name(stem: str) -> str:
    """Make a name that a folder may have."""
    return re.sub(r"[^\w .,+()-]", "_", stem).strip(" .")[:100] or "profile"


def _load_csv(
    text: str,
    reading: Reading,
    name: str,
    settings: Sequence[str],
    columns: Mapping[str, str],
) -> Profile:
    def commands(document: ProfileSettings, reading: Reading, findings: Findings) -> Commands:
        return parse_samples(text, reading.label, columns, reading.conditioning, reading.remarks)

    document, findings = parse_settings(settings, reading.label)
    return finish(document, commands, reading, name, findings)
