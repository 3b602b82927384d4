"""Bytes from a file or from standard input, and the text in them."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from des_cli.errors import FileAccessError, Problem, ProfileError
from des_cli.profiles_in.wording import plain

MAX_BYTES = 1 << 30
"""Longest file read; five million rows of eight columns are shorter."""


def read_source(path: Path, label: str) -> bytes:
    """Return the content of a regular file or a pipe.

    Raises
    ------
    FileAccessError
        If there is no such file, it is a folder or a device, it cannot be
        read, or it is longer than 1 GiB.
    """
    try:
        mode = os.stat(path).st_mode
        if stat.S_ISDIR(mode):
            raise _refused(label, "is a folder, not a file")
        if not (stat.S_ISREG(mode) or stat.S_ISFIFO(mode)):
            raise _refused(label, "is a device, not a file")
        with open(path, "rb") as file:
            data = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        # A name with a NUL byte raises ValueError.
        words = getattr(error, "strerror", None) or "is not a file name"
        raise _refused(label, f"cannot be read: {words}") from None
    if len(data) > MAX_BYTES:
        raise _refused(label, f"is larger than {MAX_BYTES >> 30} GiB")
    return data


def decode(data: bytes, label: str) -> str:
    """Return the text of UTF-8 bytes, without a byte-order mark.

    Raises
    ------
    ProfileError
        Naming the line and byte where the text is not UTF-8 or holds a NUL.
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        what = f"is not UTF-8 text (byte 0x{data[error.start]:02x}); save it as UTF-8"
        raise ProfileError([Problem(f"{label}:{line}", what)]) from None
    nul = text.find("\0")
    if nul >= 0:
        line = text.count("\n", 0, nul) + 1
        raise ProfileError([Problem(f"{label}:{line}", "holds a NUL byte; it is not a text file")])
    return text


def label_of(path: Path | str) -> str:
    """Return what messages call a file: its path, kept on one line."""
    text = str(path)
    return text if text.isprintable() and text else plain(text)


def _refused(label: str, what: str) -> FileAccessError:
    return FileAccessError([Problem(label, what)])
