"""One profile from wherever it is: a file, standard input, or the built-in maneuvers."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from des_cli.errors import Complaint, ProfileError, UsageError
from des_cli.model.origin import SourceFile
from des_cli.model.profile import Profile
from des_cli.profiles_in.caps import DEFAULT_CAPS, Caps
from des_cli.profiles_in.findings import Findings, bounded
from des_cli.profiles_in.gaps import GapHandling
from des_cli.profiles_in.origin import origin_of, source_name
from des_cli.profiles_in.profile_csv import parse_samples
from des_cli.profiles_in.profile_file import ProfileFile
from des_cli.profiles_in.profile_name import name_of_file
from des_cli.profiles_in.profile_yaml import (
    Commands,
    Reading,
    finish,
    parse_profile,
    parse_settings,
)
from des_cli.profiles_in.schema import ProfileSettings
from des_cli.profiles_in.setting import AnySetting
from des_cli.profiles_in.source import decode

_SPLIT = "split"


def load_profile(
    source: str | Path,
    *,
    settings: Sequence[AnySetting] = (),
    columns: Mapping[str, str] | None = None,
    stdin: bytes | None = None,
    part: int | None = None,
    separator: str | None = None,
    decimal: str | None = None,
    caps: Caps = DEFAULT_CAPS,
) -> Profile:
    """Read and check a profile.

    Parameters
    ----------
    source : str or Path
        A ``.yaml``, ``.yml`` or ``.csv`` file, ``-`` for standard input, or
        the name of a built-in maneuver; a Path is always a file. Other files
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
    file = ProfileFile.read(source, stdin, caps)
    return parse_file(file, settings, dict(columns or {}), gaps, separator, decimal)


def count_parts(
    source: str | Path,
    *,
    settings: Sequence[AnySetting] = (),
    columns: Mapping[str, str] | None = None,
    stdin: bytes | None = None,
    separator: str | None = None,
    decimal: str | None = None,
    caps: Caps = DEFAULT_CAPS,
) -> int:
    """Return how many profiles a source holds: with ``gap: split`` one a stretch between gaps.

    Parameters
    ----------
    source, settings, columns, stdin, separator, decimal, caps
        As of `load_profile`, whose errors this raises too, but only where there is
        something to split.
    """
    file = ProfileFile.read(source, stdin, caps)
    asked = any(_SPLIT in str(setting) for setting in settings)
    # The word has to stand somewhere: a long table need not be read to know that.
    if not asked and _SPLIT.encode() not in file.data:
        return 1
    if not asked and not file.is_yaml:
        return 1
    gaps = GapHandling(part=1)
    parse_file(file, settings, dict(columns or {}), gaps, separator, decimal)
    return gaps.parts


def parse_file(
    file: ProfileFile,
    settings: Sequence[AnySetting],
    columns: dict[str, str],
    gaps: GapHandling,
    separator: str | None,
    decimal: str | None,
) -> Profile:
    """Make a profile of its bytes; arguments and errors are those of `load_profile`."""
    path, label, data = file.path, file.label, file.data
    text, remarks_of_text = file.table
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
    remarks = [*file.remarks, *remarks_of_text]
    reading = Reading(label, folder, digest, gaps=gaps, remarks=remarks, caps=file.caps)
    name = name_of_file(path)
    try:
        if file.is_yaml:
            _refuse_table_options(label, columns, written)
            profile = parse_profile(decode(data, label), reading, name, settings)
        else:
            profile = _load_csv(text, reading, name, settings, columns, written)
    except ProfileError as error:
        raise ProfileError(bounded(error.complaints)) from None
    own = SourceFile(source_name(path, file.is_yaml), data)
    origin = origin_of(own, reading.files, settings, columns, written, file.caps)
    return replace(profile, origin=origin)


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
            most_rows=reading.caps.rows,
            machine=reading.machine,
        )

    document, findings = parse_settings(settings, reading.label)
    return finish(document, commands, reading, name, findings)
