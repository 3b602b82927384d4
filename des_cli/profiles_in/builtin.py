"""The maneuvers that come with the tool."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import des_cli

_FOLDERS = (
    Path(des_cli.__file__).parent / "profiles",
    Path(des_cli.__file__).parent.parent / "profiles",
)
"""Where an installed package has them, and where a checkout has them."""


@dataclass(frozen=True, slots=True)
class BuiltinProfile:
    """A maneuver that can be given by its name.

    Parameters
    ----------
    name : str
    path : Path
    summary : str
        What it shows: the first sentence of the comment that it starts with; of
        a CSV file, which has no comments, its columns.
    """

    name: str
    path: Path
    summary: str


def builtin_profiles() -> tuple[BuiltinProfile, ...]:
    """Return the built-in maneuvers in the order of their names.

    A recording that a maneuver refers to bears its name and is not listed:
    ``flight_log.csv`` beside ``flight_log.yaml``.
    """
    folder = next((folder for folder in _FOLDERS if folder.is_dir()), None)
    if folder is None:
        return ()
    found: dict[str, BuiltinProfile] = {}
    for path in sorted(folder.glob("*.yaml")) + sorted(folder.glob("*.csv")):
        if path.stem not in found:
            found[path.stem] = BuiltinProfile(path.stem, path, _summary(path))
    return tuple(found[name] for name in sorted(found))


def builtin_profile(name: str) -> BuiltinProfile | None:
    """Return the built-in maneuver of that name, or None."""
    return next((profile for profile in builtin_profiles() if profile.name == name), None)


def _summary(path: Path) -> str:
    """Read the first sentence of the comment at the head of a file."""
    words: list[str] = []
    with open(path, encoding="utf-8") as file:
        if path.suffix == ".csv":
            return f"Samples in a CSV file: {', '.join(file.readline().strip().split(','))}."
        for line in file:
            if not line.startswith("#"):
                break
            words.append(line.lstrip("# ").strip())
    text = " ".join(words)
    return text.split(". ")[0].rstrip(".") + "."
