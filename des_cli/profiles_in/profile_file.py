"""The bytes of a profile: a file, standard input, or a built-in maneuver."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from des_cli.errors import Complaint, FileAccessError
from des_cli.profiles_in.builtin import builtin_profile, builtin_profiles
from des_cli.profiles_in.source import decode_table, label_of, read_source
from des_cli.profiles_in.wording import did_you_mean

STDIN_LABEL = "<stdin>"

_YAML_LINE = re.compile(r"""---|%YAML|[{\[]|["']?[\w. -]+["']?\s*:(\s|$)|- """)


@dataclass(frozen=True)
class ProfileFile:
    """A profile as it is stored, before anything of it is understood.

    Parameters
    ----------
    path : Path or None
        None for standard input.
    label : str
        What messages call it.
    data : bytes
    """

    path: Path | None
    label: str
    data: bytes

    @classmethod
    def read(cls, source: str | Path, stdin: bytes | None) -> ProfileFile:
        """Read what a source names; see `load_profile`.

        Raises
        ------
        FileAccessError
            If there is no such file, or it cannot be read.
        """
        if source == "-":
            if stdin is None:
                what = "nothing was given on standard input"
                raise FileAccessError([Complaint(STDIN_LABEL, what)])
            return cls(None, STDIN_LABEL, stdin)
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
        return cls(path, label, read_source(path, label))

    @cached_property
    def table(self) -> tuple[str, tuple[str, ...]]:
        """The text as that of a table, and a sentence if it is not UTF-8."""
        return decode_table(self.data, self.label)

    @cached_property
    def is_yaml(self) -> bool:
        """YAML, not CSV, by the file's ending or by its first line that says anything."""
        suffix = self.path.suffix.lower() if self.path else ""
        if suffix in (".yaml", ".yml", ".csv"):
            return suffix != ".csv"
        for line in self.table[0].splitlines()[:1000]:
            if line.strip() and not line.lstrip().startswith("#"):
                return _YAML_LINE.match(line) is not None
        return False
