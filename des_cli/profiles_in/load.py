"""One profile from wherever it is: a file, standard input, or the built-in maneuvers."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

from des_cli.errors import Complaint, FileAccessError, ProfileError, UsageError
from des_cli.model.profile import Profile
from des_cli.profiles_in.builtin import builtin_profile, builtin_profiles
from des_cli.profiles_in.findings import Findings, bounded
from des_cli.profiles_in.gaps import GapHandling
from des_cli.profiles_in.profile_csv import parse_samples
from des_cli.profiles_in.profile_yaml import (
    Commands,
    Reading,
    finish,
    parse_profile,
    parse_settings,
)
from des_cli.profiles_in.schema import ProfileSettings
from des_cli.profiles_in.setting import AnySetting
from des_cli.profiles_in.source import decode, decode_table, label_of, read_source
from des_cli.profiles_in.wording import did_you_mean

STDIN_LABEL = "<stdin>"
_SPLIT = "split"

_YAML_LINE = re.compile(r"""---|%YAML|[{\[]|["']?[\w. -]+["']?\s*:(\s|$)|- """)


def load_profile(
    source: str | Path,
    *,
    settings: Sequence[AnySetting] = (),
    columns: Mapping[str, str] | None = None,
    stdin: bytes | None = None,
    part: int | None = None,
    separator: str | None = None,
    decimal: str | None = None,
) -> Profile:
    """Read and check a profile.

    Parameters
    ----------
    source : str or Path
        A ``.yaml``, ``.yml`` or ``.csv`` file, ``-`` for standard input, or
        the name of a built-in maneuver where no such file exists. Other files
        and standard input are YAML or CSV by what they hold.
    settings : sequence of str or Setting
        ``--set`` strings: ``reduction.r2=0.2``, ``joints.arm_rpm[1].to_s=4``; or values of
        options.
    columns : mapping of str to str, optional
        For a CSV profile: the contract's name of a column, with its unit, to
        the name that it has in the file (``{"t_s": "t"}``).
    stdin : bytes, optional
        What standard input held, where ``source`` is ``-``.
    part : int, optional
        With ``gap: split``: which stretch between gaps, counted from 1; see `count_parts`.
    separator, decimal : str, optional
        For a CSV profile that is not written with commas and decimal points: what
        stands between its columns, and its decimal sign.

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
    gaps = GapHandling(part=part)
    return _load(source, settings, dict(columns or {}), stdin, gaps, separator, decimal)


def count_parts(
    source: str | Path,
    *,
    settings: Sequence[AnySetting] = (),
    columns: Mapping[str, str] | None = None,
    stdin: bytes | None = None,
    separator: str | None = None,
    decimal: str | None = None,
) -> int:
    """Return how many profiles a source holds: with ``gap: split`` one a stretch between gaps.

    Parameters
    ----------
    source, settings, columns, stdin, separator, decimal
        As of `load_profile`, whose errors this raises too, but only where there is
        something to split.
    """
    path, label, data = _read(source, stdin)
    asked = any(_SPLIT in str(setting) for setting in settings)
    # The word has to stand somewhere: a long table need not be read to know that.
    if not asked and _SPLIT.encode() not in data:
        return 1
    if not asked and not _is_yaml(path, decode_table(data, label)[0]):
        return 1
    gaps = GapHandling(part=1)
    _load(source, settings, dict(columns or {}), stdin, gaps, separator, decimal)
    return gaps.parts


def _load(
    source: str | Path,
    settings: Sequence[AnySetting],
    columns: dict[str, str],
    stdin: bytes | None,
    gaps: GapHandling,
    separator: str | None,
    decimal: str | None,
) -> Profile:
    path, label, data = _read(source, stdin)
    text, remarks = decode_table(data, label)
    folder = path.parent if path else Path()
    digest = hashlib.sha256(data)
    given = {"separator": separator, "decimal": decimal}
    written = {key: value for key, value in given.items() if value is not None}
    if settings or columns or written:
        options = [
            list(map(str, settings)),
            sorted(columns.items()),
            *([written] if written else []),
        ]
        digest.update(json.dumps(options).encode())
    if gaps.part is not None:
        digest.update(f"part {gaps.part}".encode())
    reading = Reading(label, folder, digest, gaps=gaps, remarks=[*remarks])
    name = _safe_name(path.stem if path else "stdin")
    try:
        if _is_yaml(path, text):
            _refuse_table_options(label, columns, written)
            return parse_profile(decode(data, label), reading, name, settings)
        return _load_csv(text, reading, name, settings, columns, written)
    except ProfileError as error:
        raise ProfileError(bounded(error.complaints)) from None


def _read(source: str | Path, stdin: bytes | None) -> tuple[Path | None, str, bytes]:
    """Return the path (None for standard input), the label and the bytes."""
    if source == "-":
        if stdin is None:
            raise FileAccessError([Complaint(STDIN_LABEL, "nothing was given on standard input")])
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
            raise FileAccessError([Complaint(label, what)])
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


def _refuse_table_options(
    label: str, columns: Mapping[str, str], written: Mapping[str, str]
) -> None:
    """Refuse options that say how a CSV is to be read, of a YAML profile."""
    complaints = []
    if columns:
        complaints.append(
            Complaint(label, "--column renames columns of a CSV profile; this is YAML")
        )
    for key in written:
        what = f"--{key} says how a CSV profile is written; this is YAML: give samples.{key}"
        complaints.append(Complaint(label, what))
    if complaints:
        raise UsageError(complaints)


def _safe_name(stem: str) -> str:
    """Make a name that a folder may have."""
    return re.sub(r"[^\w .,+()-]", "_", stem).strip(" .")[:100] or "profile"


def _load_csv(
    text: str,
    reading: Reading,
    name: str,
    settings: Sequence[AnySetting],
    columns: Mapping[str, str],
    written: Mapping[str, str],
) -> Profile:
    def commands(document: ProfileSettings, reading: Reading, findings: Findings) -> Commands:
        said: dict[str, str | None] = dict(written)
        if document.samples is not None:
            for key in ("separator", "decimal"):
                said.setdefault(key, getattr(document.samples, key))
        return parse_samples(
            text,
            reading.label,
            columns,
            **said,
            conditioning=reading.conditioning,
            gaps=reading.gaps,
            remarks=reading.remarks,
        )

    document, findings = parse_settings(settings, reading.label)
    return finish(document, commands, reading, name, findings)
