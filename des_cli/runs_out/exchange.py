"""Two folders exchange their names in one step, where the system can do that."""

from __future__ import annotations

import ctypes
import os
import sys
from pathlib import Path

_HERE = -100
"""Linux's ``AT_FDCWD``: paths are as seen from the current folder."""

_EXCHANGE = 2
"""Linux's ``RENAME_EXCHANGE``."""


def exchange(one: Path, other: Path) -> bool:
    """Give each of two existing paths the name of the other.

    Returns
    -------
    bool
        False if nothing was changed: not every system, nor every file system, can.
    """
    if not sys.platform.startswith("linux"):
        return False
    try:
        rename = ctypes.CDLL(None).renameat2
    except AttributeError:  # a C library from before 2018
        return False
    return rename(_HERE, os.fsencode(one), _HERE, os.fsencode(other), _EXCHANGE) == 0
