"""What the operating system says of a file, in plain words."""

from __future__ import annotations

import errno
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from des_cli.errors import Complaint, FileAccessError

_PLAIN_WORDS = {
    errno.ENOENT: "no such file or folder",
    errno.ENOTDIR: "a part of the path is a file, not a folder",
    errno.EACCES: "permission denied",
    errno.EPERM: "permission denied",
    errno.EROFS: "the file system is read-only",
    errno.ENOSPC: "no space left on the device",
    errno.EISDIR: "a folder of that name exists",
    errno.ENOTEMPTY: "a folder of that name exists and is not empty",
    errno.EEXIST: "something of that name exists",
    errno.ENAMETOOLONG: "the name is too long",
    errno.ELOOP: "a symbolic link leads back to itself",
}


@contextmanager
def plain_words(path: Path, failed: str, *, missing: str | None = None) -> Iterator[None]:
    """Turn the operating system's errors into one plain sentence.

    Parameters
    ----------
    path : Path
        What the sentence is about.
    failed : str
        Such as ``cannot be written``.
    missing : str, optional
        What it means here that something is not found.

    Raises
    ------
    FileAccessError
        In place of an OSError, and of the ValueError of a path that no file
        can have.
    BrokenPipeError
        As it is: that a reader went away is no fault of the file.
    """
    try:
        yield
    except BrokenPipeError:
        raise
    except OSError as error:
        if isinstance(error, FileNotFoundError) and missing is not None:
            raise FileAccessError([Complaint(str(path), f"{failed}: {missing}")]) from error
        words = _PLAIN_WORDS.get(error.errno or 0, error.strerror or type(error).__name__)
        raise FileAccessError([Complaint(str(path), f"{failed}: {words}")]) from error
    except ValueError as error:
        raise FileAccessError([Complaint(repr(str(path)), f"{failed}: {error}")]) from error
