"""What a profile was read from, so that it can be read again."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SourceFile:
    """One file, as it was read.

    Parameters
    ----------
    name : str
        Without a folder; unique among the files of a profile.
    data : bytes
    """

    name: str
    data: bytes


@dataclass(frozen=True, slots=True)
class Origin:
    """The files of a profile, and how they were read.

    Parameters
    ----------
    files : tuple of SourceFile
        The profile itself first, then what it refers to.
    options : tuple of str
        Of ``des-coriolis reduce``, that make the same profile of the first file, where all
        of them stand in a folder ``source``: ``("--set", "reduction.r2=0.2")``.
    """

    files: tuple[SourceFile, ...]
    options: tuple[str, ...] = ()
