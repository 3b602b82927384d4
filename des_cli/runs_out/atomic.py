"""A file or folder is built aside and only then given its name.

Whatever happens on the way (an exception, Ctrl-C, a full disk, a lost power
line), nothing half-written stands under the name: what is left behind, if the
process is killed outright, is called ``.NAME.partial-XXXXXXXX``.
"""

from __future__ import annotations

import errno
import os
import re
import secrets
import shutil
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from des_cli.errors import Complaint, FileAccessError

# A name has at most 255 bytes; 40 characters of four bytes leave room for the
# rest of the temporary's name.
_STEM_CHARACTERS = 40

_TEMPORARY = re.compile(r"\..*\.partial-[0-9a-f]{8}", re.DOTALL)

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


def write_file(
    path: str | os.PathLike[str],
    data: bytes,
    *,
    overwrite: bool = False,
    accept: Callable[[bytes], None] = lambda _: None,
) -> Path:
    """Write a whole file, or leave everything as it was.

    The bytes go to a temporary beside the target, reach the disk, and then
    take the name. A symbolic link is followed. A device or a pipe is written
    to directly: it has no name to give.

    Parameters
    ----------
    path : path
        Its folder must exist.
    data : bytes
    overwrite : bool
        Whether an existing file may be replaced; it keeps its permissions.
    accept : callable
        Given what was written, as it is read back; what it raises leaves everything as it
        was. A device or a pipe cannot be read back: there it is given what will be written.

    Returns
    -------
    Path
        As given.

    Raises
    ------
    FileAccessError
        If the file exists and may not be replaced, or cannot be written.
    """
    shown = Path(path)
    with plain_words(shown, "cannot be written", missing="its folder does not exist"):
        existing = _mode(shown)
        if existing is not None and not stat.S_ISREG(existing):
            accept(data)
            # Opening a folder fails by itself.
            with open(shown, "wb") as special:
                special.write(data)
            return shown
        if existing is not None and not overwrite:
            raise exists(shown)
        target = Path(os.path.realpath(shown))
        temporary = beside(target)
        try:
            _write_through(temporary, data, None if existing is None else stat.S_IMODE(existing))
            accept(temporary.read_bytes())
            if overwrite:
                os.replace(temporary, target)
            else:
                _name_once(temporary, target, shown)
            sync_folder(target.parent)
        finally:
            with suppress(OSError):
                temporary.unlink()
    return shown


def write_through(path: Path, data: bytes) -> None:
    """Write a new file inside a folder that is itself still being built."""
    with plain_words(path, "cannot be written"):
        _write_through(path, data, None)


@contextmanager
def new_folder(parent: Path, name: str) -> Iterator[Path]:
    """Make a folder to build in, and remove what is left of it afterwards.

    Parameters
    ----------
    parent : Path
        An existing folder on the file system of the target.
    name : str
        What the result will be called.

    Yields
    ------
    Path
        ``parent/.NAME.partial-XXXXXXXX``; rename it, or move its files away.
    """
    folder = beside(parent / name)
    try:
        with plain_words(folder, "cannot be created"):
            folder.mkdir()
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def beside(target: Path) -> Path:
    """Name a temporary in the target's folder, hidden and not used by anyone else."""
    return target.parent / f".{target.name[:_STEM_CHARACTERS]}.partial-{secrets.token_hex(4)}"


def is_temporary(name: str) -> bool:
    """Tell whether a name is one that ``beside`` makes."""
    return _TEMPORARY.fullmatch(name) is not None


def sync_folder(folder: Path) -> None:
    """Make the names in a folder survive a loss of power, where that is possible."""
    # Some network file systems cannot; the data itself is on the disk already.
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def exists(path: Path) -> FileAccessError:
    """Return the error that refuses to replace a file."""
    return FileAccessError([Complaint(str(path), "exists; --overwrite replaces it")])


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


def _mode(path: Path) -> int | None:
    try:
        return path.stat().st_mode
    except FileNotFoundError:
        return None


def _write_through(path: Path, data: bytes, mode: int | None) -> None:
    """Create a file with the permissions that the umask leaves, or the given ones."""
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    descriptor = os.open(path, flags, 0o666)
    with os.fdopen(descriptor, "wb") as stream:
        if mode is not None:
            with suppress(OSError):
                path.chmod(mode)
        stream.write(data)
        stream.flush()
        os.fsync(descriptor)


def _name_once(temporary: Path, target: Path, shown: Path) -> None:
    """Give a file its name unless another process gave it to a file meanwhile."""
    try:
        # Unlike a rename, a link fails where the name is taken.
        os.link(temporary, target)
    except FileExistsError:
        raise exists(shown) from None
    except OSError:
        # No hard links on this file system: the check and the rename are two
        # steps here, and nothing better can be had.
        if target.exists():
            raise exists(shown) from None
        os.replace(temporary, target)
