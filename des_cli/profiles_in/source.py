"""Bytes from a file or from standard input, and the text in them."""

from __future__ import annotations

import codecs
import os
import stat
from pathlib import Path

from des_cli.errors import Complaint, FileAccessError, ProfileError
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
        byte, line = _first_wrong_byte(error)
        what = f"is not UTF-8 text (byte {byte}); save it as UTF-8"
        raise ProfileError([Complaint(f"{label}:{line}", what)]) from None
    return _without_nul(text, label)


def decode_table(data: bytes, label: str) -> tuple[str, tuple[str, ...]]:
    """Return the text of a table, and a sentence if it is not UTF-8.

    A recorder's header may hold a degree sign in Latin-1, and a column that
    nobody reads must not reject a file. Any bytes are Latin-1; what is wrong
    with a number or a name that is read is said where it is read.

    Raises
    ------
    ProfileError
        If the text is UTF-16, or holds a NUL.
    """
    try:
        return _without_nul(data.decode("utf-8-sig"), label), ()
    except UnicodeDecodeError as error:
        if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            raise ProfileError([Complaint(label, "is UTF-16 text; save it as UTF-8")]) from None
        byte, line = _first_wrong_byte(error)
    remark = f"the file is not UTF-8 (byte {byte} in line {line}): it is read as Latin-1"
    text = data.removeprefix(codecs.BOM_UTF8).decode("latin-1")
    return _without_nul(text, label), (remark,)


def _first_wrong_byte(error: UnicodeDecodeError) -> tuple[str, int]:
    """Return the first byte that is not UTF-8, and its line."""
    data = error.object  # without the byte-order mark, from behind which the decoder counts
    return f"0x{data[error.start]:02x}", data.count(b"\n", 0, error.start) + 1


def _without_nul(text: str, label: str) -> str:
    nul = text.find("\0")
    if nul >= 0:
        line = text.count("\n", 0, nul) + 1
        raise ProfileError(
            [Complaint(f"{label}:{line}", "holds a NUL byte; it is not a text file")]
        )
    return text


def label_of(path: Path | str) -> str:
    """Return what messages call a file: its path, kept on one line."""
    text = str(path)
    return text if text.isprintable() and text else plain(text)


def _refused(label: str, what: str) -> FileAccessError:
    return FileAccessError([Complaint(label, what)])
