"""The bytes of a profile: a file, standard input, or a built-in maneuver."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from pathlib import Path

from des_cli.errors import Complaint, FileAccessError
from des_cli.profiles_in.builtin import builtin_profile, builtin_profiles
from des_cli.profiles_in.caps import DEFAULT_CAPS, Caps
from des_cli.profiles_in.csv_header import lines_of
from des_cli.profiles_in.source import STDIN_LABEL, decode_table, label_of, read_source
from des_cli.profiles_in.wording import did_you_mean

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
    caps : Caps
        The most that is read of it, and of each file that it refers to.
    remarks : tuple of str
        Sentences on what was taken for what.
    """

    path: Path | None
    label: str
    data: bytes
    caps: Caps = DEFAULT_CAPS
    remarks: tuple[str, ...] = ()

    @classmethod
    def read(
        cls, source: str | Path, stdin: bytes | None, caps: Caps = DEFAULT_CAPS
    ) -> ProfileFile:
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
            return cls(None, STDIN_LABEL, stdin, caps)
        path, label = Path(source), label_of(source)
        if isinstance(source, str) and (builtin := builtin_profile(source)):
            # Whatever lies in the current folder: a script means the same everywhere.
            what = f"{source} is the built-in profile; the file of this name here is ./{source}"
            remarks = (what,) if path.is_file() else ()
            data = read_source(builtin.path, builtin.path.name, caps.mib)
            return cls(builtin.path, builtin.path.name, data, caps, remarks)
        try:
            os.lstat(path)
        except FileNotFoundError:
            names = [profile.name for profile in builtin_profiles()]
            hint = did_you_mean(str(source), names)
            what = f"there is no such file, and no built-in profile of that name{hint}"
            raise FileAccessError([Complaint(label, what)]) from None
        except (OSError, ValueError):
            pass  # reading it says what is the matter
        return cls(path, label, read_source(path, label, caps.mib, pipes=True), caps)

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
        for line in islice(lines_of(self.table[0]), 1000):
            if line.strip() and not line.lstrip().startswith("#"):
                return _YAML_LINE.match(line) is not None
        return False
