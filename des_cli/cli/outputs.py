"""Files that a command writes: refused before anything is computed, and held while it is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

from des_cli.errors import Complaint, FileAccessError


@contextmanager
def files_held(names: Sequence[str], overwrite: bool) -> Iterator[None]:
    """Refuse what would be refused when writing, and keep other runs off these files.

    Parameters
    ----------
    names : sequence of str
    overwrite : bool
        Whether what exists may be replaced.

    Raises
    ------
    FileAccessError
        Naming every file that cannot be written.
    """
    from des_cli.runs_out.lock import locked

    _refuse_existing(names, overwrite)
    with ExitStack() as stack:
        for name in names:
            stack.enter_context(locked(Path(name)))
        # Who held one may have written it meanwhile.
        _refuse_existing(names, overwrite)
        yield


def _refuse_existing(names: Sequence[str], overwrite: bool) -> None:
    from des_cli.runs_out.atomic import exists, require_file

    complaints: list[Complaint] = []
    for name in names:
        path = Path(name)
        try:
            require_file(path)
            if not path.parent.is_dir():
                what = "cannot be written: its folder does not exist"
                complaints.append(Complaint(name, what))
            elif path.is_file() and not overwrite:
                raise exists(path)
        except FileAccessError as error:
            complaints += error.complaints
    if complaints:
        raise FileAccessError(complaints)
