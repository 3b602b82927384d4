"""Bytes from a file or from standard input, and the text in them."""

from __future__ import annotations

import codecs
import errno
import os
import stat
from pathlib import Path
from typing import BinaryIO

from des_cli.errors import Complaint, FileAccessError, ProfileError, UnreadableError
from des_cli.profiles_in.wording import plain

STDIN_LABEL = "<stdin>"

_OPEN = os.O_RDONLY | sum(
    getattr(os, flag, 0) for flag in ("O_BINARY", "O_CLOEXEC", "O_NOCTTY", "O_NONBLOCK")
)
"""Opening waits for nobody, and makes no terminal that of this process."""

_ABSENT = (errno.ENOENT, errno.ENOTDIR, errno.ELOOP, errno.ENAMETOOLONG)
"""What the system says where there is no such file; anything else keeps one from being read."""


def read_source(path: Path, label: str, mib: int | None, *, pipes: bool = False) -> bytes:
    """Return the content of a regular file, or of a pipe that is being written.

    Neither opening nor reading waits for what may never come: a pipe without a writer is
    refused. One with a writer is waited for, as standard input is.

    Parameters
    ----------
    path : Path
    label : str
        What messages call it.
    mib : int or None
        The most that is read [2^20 bytes].
    pipes : bool
        Whether it may be a pipe: where the user gave the name, and no file did.

    Raises
    ------
    FileAccessError
        If there is no such file, it is a folder or a device, or it is too long.
    UnreadableError
        If it cannot be read.
    """
    try:
        # Looked at before it is opened, which alone moves some devices, and again afterwards,
        # when no other can take its place any more.
        _require_kind(os.stat(path).st_mode, label, pipes=pipes)
        with open(os.open(path, _OPEN), "rb") as file:
            mode = os.fstat(file.fileno()).st_mode
            _require_kind(mode, label, pipes=pipes)
            start = _first_of_pipe(file.fileno(), label) if stat.S_ISFIFO(mode) else b""
            return start + read_stream(file, label, mib)
    except (OSError, ValueError) as error:
        # A name with a NUL byte raises ValueError.
        words = getattr(error, "strerror", None) or "is not a file name"
        there = isinstance(error, OSError) and error.errno not in _ABSENT
        kind = UnreadableError if there else FileAccessError
        raise kind([Complaint(label, f"cannot be read: {words}")]) from None


def read_stream(stream: BinaryIO, label: str, mib: int | None) -> bytes:
    """Return what is left of a stream; it is read no further than to see that it is too long.

    Raises
    ------
    FileAccessError
        If it is longer than ``mib`` [2^20 bytes].
    """
    if mib is None:
        return stream.read()
    data = stream.read((mib << 20) + 1)
    if len(data) > mib << 20:
        raise _refused(label, f"is larger than {mib} MiB; --max-mib reads more")
    return data


def _require_kind(mode: int, label: str, *, pipes: bool) -> None:
    if stat.S_ISDIR(mode):
        raise _refused(label, "is a folder, not a file")
    if stat.S_ISFIFO(mode) and not pipes:
        raise _refused(label, "is a pipe, not a file")
    if not (stat.S_ISREG(mode) or stat.S_ISFIFO(mode)):
        raise _refused(label, "is a device, not a file")


def _first_of_pipe(descriptor: int, label: str) -> bytes:
    """Return the first byte of a pipe if it is there already, and let the next ones be awaited."""
    try:
        first = os.read(descriptor, 1)
    except BlockingIOError:
        first = None  # there is a writer, which has not written yet
    if first == b"":
        raise _refused(label, "is a pipe that nobody writes to; pipe into '-' instead")
    os.set_blocking(descriptor, True)
    return first or b""


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
