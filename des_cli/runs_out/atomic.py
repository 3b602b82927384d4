"""A file or folder is built aside and only then given its name.

Whatever happens on the way (an exception, Ctrl-C, a full disk, a lost power
line), nothing half-written stands under the name: what is left behind, if the
process is killed outright, is called ``.NAME.partial-XXXXXXXX``. While it is built it is
locked, so that the next who builds something of that name knows what nobody builds any more.
"""

from __future__ import annotations

import os
import re
import secrets
import stat
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from des_cli.errors import Complaint, FileAccessError
from des_cli.runs_out.lock import hold, is_still, remove_all, remove_unless_held, short_stem
from des_cli.runs_out.plain_words import plain_words
from des_cli.signals import undisturbed

_TEMPORARY = re.compile(r"\..*\.partial-[0-9a-f]{8}", re.DOTALL)


def write_file(
    path: str | os.PathLike[str],
    data: bytes,
    *,
    overwrite: bool = False,
    accept: Callable[[bytes], None] = lambda _: None,
) -> Path:
    """Write a whole file, or leave everything as it was.

    The bytes go to a temporary beside the target, reach the disk, and then
    take the name. A symbolic link is followed. What `require_file` lets pass and is no
    file, a device or a pipe without a name, is written to directly.

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
    require_file(shown)
    with plain_words(shown, "cannot be written", missing="its folder does not exist"):
        existing = _mode(shown)
        if existing is not None and not stat.S_ISREG(existing):
            accept(data)
            with open(shown, "wb") as special:
                special.write(data)
            return shown
        if existing is not None and not overwrite:
            raise exists(shown)
        target = Path(os.path.realpath(shown))
        clear_leftovers(target)
        with ExitStack() as stack:
            temporary = _hold_new(target, _create, os.O_RDONLY, stack)
            _to_disk(temporary, data)
            accept(temporary.read_bytes())
            if existing is not None:
                with suppress(OSError):
                    temporary.chmod(stat.S_IMODE(existing))
            if overwrite:
                os.replace(temporary, target)
            else:
                _name_once(temporary, target, shown)
            sync_folder(target.parent)
    return shown


def require_file(path: Path) -> None:
    """Refuse a name that cannot be a file's, for what it stands for now.

    A device is none, but can be written to, and so can a pipe that has no name of its own:
    ``/dev/stdout``, or ``>(command)`` of a shell. One that has a name is waited for until
    somebody reads it, perhaps for ever.

    Raises
    ------
    FileAccessError
    """
    with plain_words(path, "cannot be written", missing="its folder does not exist"):
        mode = _mode(path)
        if mode is None or stat.S_ISREG(mode) or stat.S_ISCHR(mode):
            return
        if stat.S_ISFIFO(mode):
            if not os.path.lexists(os.path.realpath(path)):
                return
            what = "is a pipe, not a file; write to '-', and into the pipe with >"
        elif stat.S_ISDIR(mode):
            what = "is a folder; name a file"
        else:
            what = "is not a file; name another"
    raise FileAccessError([Complaint(str(path), what)])


def write_through(path: Path, data: bytes) -> None:
    """Write a new file inside a folder that is itself still being built."""
    with plain_words(path, "cannot be written"):
        _create(path)
        _to_disk(path, data)


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
    target = parent / name
    clear_leftovers(target)
    with ExitStack() as stack:
        with plain_words(target, "cannot be written"):
            folder = _hold_new(target, Path.mkdir, os.O_RDONLY, stack)
        yield folder


def clear_leftovers(target: Path) -> None:
    """Remove what a killed process left of building something of this name."""
    begin = f".{short_stem(target.name)}.partial-"
    with suppress(OSError):
        for path in list(target.parent.iterdir()):
            if path.name.startswith(begin) and is_temporary(path.name):
                remove_unless_held(path)


def beside(target: Path) -> Path:
    """Name a temporary in the target's folder, hidden and not used by anyone else."""
    return target.parent / f".{short_stem(target.name)}.partial-{secrets.token_hex(4)}"


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


def _mode(path: Path) -> int | None:
    try:
        return path.stat().st_mode
    except FileNotFoundError:
        return None


def _hold_new(target: Path, make: Callable[[Path], object], flags: int, stack: ExitStack) -> Path:
    """Make a temporary of a target that is held, and is removed when the stack is left."""
    while True:
        temporary = beside(target)
        stack.callback(_put_away, temporary)
        with undisturbed():
            make(temporary)
            if os.name == "nt":  # there no folder can be opened, and no open file renamed
                return temporary
            descriptor = os.open(temporary, flags)
            stack.callback(os.close, descriptor)
        if _is_ours(descriptor, temporary):
            return temporary


def _put_away(temporary: Path) -> None:
    with undisturbed():
        remove_all(temporary)


def _is_ours(descriptor: int, path: Path) -> bool:
    # Before it was held, someone who clears leftovers may have taken it for one.
    return hold(descriptor) is not False and is_still(descriptor, path)


def _create(path: Path) -> None:
    """Create an empty file, with the permissions that the umask leaves."""
    os.close(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))


def _to_disk(path: Path, data: bytes) -> None:
    with open(path, "r+b") as stream:
        stream.write(data)
        stream.flush()
        os.fsync(stream.fileno())


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
