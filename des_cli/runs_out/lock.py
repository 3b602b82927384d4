"""Who is writing: a lock that the kernel releases when its process ends, however it ends.

While a profile is reduced into a folder or file, ``.NAME.lock`` stands beside it, holds
the process id and is locked (``flock``). A second run finds it locked and is refused. The
file of a killed run is not locked any more: the next one takes it over.
"""

from __future__ import annotations

import errno
import hashlib
import os
import shutil
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from des_cli.errors import Complaint, FileAccessError
from des_cli.runs_out.plain_words import plain_words
from des_cli.signals import undisturbed

try:
    import fcntl
except ImportError:  # Windows: there nothing is locked
    fcntl = None  # type: ignore[assignment]

# A name has at most 255 bytes; 40 characters of four bytes leave room for what
# is put around them.
_STEM_CHARACTERS = 40

_TRIES = 100
"""Of taking a lock file that another process is just removing."""


@contextmanager
def locked(target: Path) -> Iterator[None]:
    """Keep other runs from writing to a folder or file while the context lasts.

    Its parents are made where they are missing, and taken away again if nothing was put
    into them.

    Raises
    ------
    FileAccessError
        If another process writes there, which is named, or nothing can be written there.
    """
    with suppress(OSError):
        mode = target.stat().st_mode
        if not (stat.S_ISREG(mode) or stat.S_ISDIR(mode)):
            # A device or a pipe is whoever's writes to it.
            yield
            return
    home = Path(os.path.realpath(target))
    path = _lock_file(home)
    made: list[Path] = []
    held: list[int] = []
    try:
        with undisturbed():
            _make_parents(home, target, made)
            _take(home, target, path, held)
        yield
    finally:
        try:
            _let_go(held, path, made)
        except KeyboardInterrupt:
            # A signal came just before they were kept waiting; no other one is heard.
            _let_go(held, path, made)
            raise


def clear_lock(target: Path) -> None:
    """Remove the lock file of a process that was killed when it had written all."""
    path = _lock_file(Path(os.path.realpath(target)))
    if path.is_file():
        remove_unless_held(path)


def short_stem(name: str) -> str:
    """Return a part of a name that has room for more, and still belongs to it alone."""
    if len(name) <= _STEM_CHARACTERS:
        return name
    digest = hashlib.sha256(os.fsencode(name)).hexdigest()[:8]
    return f"{name[: _STEM_CHARACTERS - 9]}-{digest}"


def hold(descriptor: int) -> bool | None:
    """Lock an open file or folder for as long as it is open.

    Returns
    -------
    bool or None
        False if another process holds it; None where that cannot be known.
    """
    if fcntl is None:
        return None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno in (errno.EWOULDBLOCK, errno.EACCES):
            return False
        return None  # a file system without locks
    return True


def is_still(descriptor: int, path: Path) -> bool:
    """Tell whether an open file still stands under its name."""
    try:
        return os.path.samestat(os.fstat(descriptor), os.lstat(path))
    except FileNotFoundError:
        return False


def remove_unless_held(path: Path) -> None:
    """Remove a file or folder that no process holds, and nobody needs any more."""
    if os.name == "nt":  # there nobody can tell
        return
    with suppress(OSError):
        # neither through a link nor waiting for the other end of a pipe
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
        try:
            if hold(descriptor) and is_still(descriptor, path):
                remove_all(path)
        finally:
            os.close(descriptor)


def remove_all(path: Path) -> None:
    """Remove a file, or a folder with all that is in it, as far as that is possible."""
    with suppress(OSError):
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink()


def _lock_file(home: Path) -> Path:
    return home.parent / f".{short_stem(home.name)}.lock"


def _let_go(held: list[int], path: Path, made: list[Path]) -> None:
    """Release a lock, and remove what was made for it; also for a second time."""
    with undisturbed():
        while held:
            os.close(held.pop())
        remove_unless_held(path)
        for folder in made:
            with suppress(OSError):
                folder.rmdir()


def _make_parents(home: Path, target: Path, made: list[Path]) -> None:
    """Make the missing parents of a target, and note them, the innermost first."""
    for parent in home.parents:
        if parent.exists():
            break
        made.append(parent)
    with plain_words(target, "cannot be written"):
        home.parent.mkdir(parents=True, exist_ok=True)


def _take(home: Path, target: Path, path: Path, held: list[int]) -> None:
    """Open and lock a target's lock file, and note its descriptor."""
    flags = os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0)
    with plain_words(target, "cannot be written"):
        for _ in range(_TRIES):
            try:
                descriptor = os.open(path, flags, 0o666)
            except PermissionError:
                if not home.is_dir():
                    raise
                _take_folder(home, target, held)
                return
            except FileNotFoundError:
                # Who made the parents too has just taken them away.
                home.parent.mkdir(parents=True, exist_ok=True)
                continue
            if hold(descriptor) is False:
                other = _owner(descriptor)
                os.close(descriptor)
                raise _refused(target, other)
            if is_still(descriptor, path):
                held.append(descriptor)
                with suppress(OSError):  # a full disk: then it has no number to tell
                    os.ftruncate(descriptor, 0)
                    os.write(descriptor, b"%d\n" % os.getpid())
                return
            os.close(descriptor)
    raise _refused(target, "")


def _take_folder(home: Path, target: Path, held: list[int]) -> None:
    """Lock a folder itself, beside which nothing may be written: a mounted one, say."""
    descriptor = os.open(home, os.O_RDONLY)
    if hold(descriptor) is False:
        os.close(descriptor)
        raise _refused(target, "")
    held.append(descriptor)


def _owner(descriptor: int) -> str:
    number = os.read(descriptor, 32).strip()
    return f" (process {number.decode()})" if number.isdigit() else ""


def _refused(target: Path, owner: str) -> FileAccessError:
    what = f"is being written by another run{owner}; wait for its end, or name another output"
    return FileAccessError([Complaint(str(target), what)])
