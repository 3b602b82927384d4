"""How any exception ends: its exit code and its lines, decided in this one place.

The command line uses it for a command, and the batch runner for one profile of
many.
"""

from __future__ import annotations

import os
import traceback
from dataclasses import dataclass

from des_cli.errors import DesError, ExitCode


@dataclass(frozen=True, slots=True)
class Failure:
    """The end of something that did not end well.

    Parameters
    ----------
    exit_code : ExitCode
    lines : tuple of str
        One problem each, for a person.
    traceback : str
        For the developers; empty for an error that the user can mend.
    """

    exit_code: ExitCode
    lines: tuple[str, ...]
    traceback: str = ""

    @classmethod
    def of(cls, error: BaseException) -> Failure:
        """Say how an exception ends.

        Parameters
        ----------
        error : BaseException
            An error of the project's own tree, one of the operating system, an
            interruption, or anything unexpected, which is a bug.
        """
        match error:
            case DesError():
                return cls(error.exit_code, tuple(str(problem) for problem in error.problems))
            case KeyboardInterrupt():
                return cls(ExitCode.INTERRUPTED, ("interrupted",))
            case BrokenPipeError():
                # Nobody is left who reads: no words.
                return cls(ExitCode.READER_GONE, ())
            case OSError():
                return cls(ExitCode.FILE, (_operating_system_line(error),))
            case MemoryError():
                return cls(ExitCode.FILE, ("not enough memory; use fewer samples or fewer --jobs",))
        first_line = (str(error).splitlines() or [""])[0]
        text = f"bug: {type(error).__name__}: {first_line}".rstrip(": ")
        return cls(ExitCode.BUG, (text,), "".join(traceback.format_exception(error)))


def _operating_system_line(error: OSError) -> str:
    what = error.strerror or str(error) or type(error).__name__
    where = error.filename
    if where is None or isinstance(where, int):
        return what
    return f"{os.fsdecode(where)}: {what}"
