"""What a profile is called: also one that is rejected, whose earlier run must be found."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from des_cli.errors import DesError
from des_cli.profiles_in.caps import DEFAULT_CAPS, Caps
from des_cli.profiles_in.profile_file import ProfileFile
from des_cli.profiles_in.profile_yaml import parse_document, parse_settings
from des_cli.profiles_in.schema import ProfileSettings, is_reserved
from des_cli.profiles_in.setting import AnySetting
from des_cli.profiles_in.source import decode


def name_of_file(path: Path | None) -> str:
    """Return the name of a profile that gives itself none, as a folder may have it."""
    stem = path.stem if path else "stdin"
    name = re.sub(r"[^\w .,+()-]", "_", stem).strip(" .")
    name = name.encode()[:100].decode(errors="ignore").rstrip(" .")
    return f"_{name}" if not name or name[0] in ",+-()" or is_reserved(name) else name


def find_name(
    source: str | Path,
    *,
    settings: Sequence[AnySetting] = (),
    stdin: bytes | None = None,
    caps: Caps = DEFAULT_CAPS,
) -> str:
    """Return the name of a profile whatever else is wrong with it.

    Parameters
    ----------
    source, settings, stdin, caps
        As of `load_profile`.

    Returns
    -------
    str
        Empty where it cannot be told.
    """
    document: ProfileSettings
    try:
        file = ProfileFile.read(source, stdin, caps)
        if file.is_yaml:
            document, findings = parse_document(decode(file.data, file.label), file.label, settings)
        else:
            document, findings = parse_settings(settings, file.label)
    except (DesError, OSError):
        return ""
    given = findings.root.value
    if isinstance(given, dict) and "name" in given and not document.name:
        return ""
    return document.name or name_of_file(file.path)
