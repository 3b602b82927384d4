"""A file that a profile refers to, as it was read."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Referred:
    """A file that a profile refers to.

    Parameters
    ----------
    key : str
        Where it is named: ``machine`` or ``samples.file``.
    name : str
        As it is named there.
    data : bytes
    by_option : bool
        Whether an option names it, whose paths start at the current folder.
    """

    key: str
    name: str
    data: bytes
    by_option: bool
