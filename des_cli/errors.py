"""One error tree: each class knows its exit code and carries what explains it.

How any exception ends, its exit code and its lines, is decided here and nowhere else:
for a command, and for one profile of many.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum


class ExitCode(IntEnum):
    """How a command ends; scripts depend on these numbers."""

    DONE = 0
    FILE = 1
    USAGE = 2
    PROFILE = 3
    NO_SOLUTION = 4
    NOT_RELEASED = 5
    BUG = 70
    HUNG_UP = 129
    INTERRUPTED = 130
    READER_GONE = 141
    TERMINATED = 143


@dataclass(frozen=True, slots=True)
class Complaint:
    """One thing that is wrong, in words for the person who can mend it.

    Parameters
    ----------
    where : str
        The place: ``cobra.yaml:12:14: joints.arm_rpm[1].to_s`` or as much of
        it as is known; empty where there is no place to name.
    what : str
        What is wrong and what to do.
    """

    where: str
    what: str

    def __str__(self) -> str:
        return f"{self.where}: {self.what}" if self.where else self.what


class DesError(Exception):
    """Base of every error that a user can mend.

    Parameters
    ----------
    complaints : sequence of Complaint
        All of them, one line each.
    """

    exit_code = ExitCode.BUG

    def __init__(self, complaints: Sequence[Complaint]) -> None:
        self.complaints = tuple(complaints)
        super().__init__("\n".join(str(complaint) for complaint in self.complaints))

    @classmethod
    def of(cls, what: str, where: str = "") -> DesError:
        """Make an error of a single complaint."""
        return cls([Complaint(where, what)])

    def __reduce__(self) -> tuple[type[DesError], tuple[tuple[Complaint, ...]]]:
        """Let an error cross a process boundary with its complaints."""
        return type(self), (self.complaints,)


class FileAccessError(DesError):
    """A file could not be read or written."""

    exit_code = ExitCode.FILE


class UnreadableError(FileAccessError):
    """A file is there, and the system does not let it be read: nothing is known of it."""


class UsageError(DesError):
    """The command was asked for something that it cannot mean."""

    exit_code = ExitCode.USAGE


class ProfileError(DesError):
    """A profile, or the machine that it names, is rejected."""

    exit_code = ExitCode.PROFILE


class BrokenRunError(DesError):
    """A run or a command table, given to be checked, was changed, was cut or is none."""

    exit_code = ExitCode.PROFILE


class NoSolutionError(DesError):
    """The solver ended without a solution that may be used."""

    exit_code = ExitCode.NO_SOLUTION


class NotReleasedError(DesError):
    """A solution exists, but its verification or a limit failed."""

    exit_code = ExitCode.NOT_RELEASED


class Stopped(KeyboardInterrupt):
    """A signal ends the process: whatever lets Ctrl-C pass lets it pass.

    Parameters
    ----------
    exit_code : ExitCode
        128 and the number of the signal.
    """

    def __init__(self, exit_code: ExitCode) -> None:
        self.exit_code = exit_code
        super().__init__()


_STOPPED_WORDS = {
    ExitCode.HUNG_UP: ("hung up",),
    ExitCode.INTERRUPTED: ("interrupted",),
    ExitCode.TERMINATED: ("terminated",),
    # Nobody is left who reads: no words.
    ExitCode.READER_GONE: (),
}


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
                return cls(error.exit_code, tuple(str(complaint) for complaint in error.complaints))
            case Stopped():
                return cls(error.exit_code, _STOPPED_WORDS[error.exit_code])
            case KeyboardInterrupt():
                return cls(ExitCode.INTERRUPTED, _STOPPED_WORDS[ExitCode.INTERRUPTED])
            case BrokenPipeError():
                return cls(ExitCode.READER_GONE, _STOPPED_WORDS[ExitCode.READER_GONE])
            case OSError():
                return cls(ExitCode.FILE, (_operating_system_line(error),))
            case MemoryError():
                return cls(ExitCode.FILE, ("not enough memory; use fewer samples or fewer --jobs",))
        first_line = (str(error).splitlines() or [""])[0]
        text = f"bug: {type(error).__name__}: {first_line}".rstrip(": ")
        from traceback import format_exception

        return cls(ExitCode.BUG, (text,), "".join(format_exception(error)))


def _operating_system_line(error: OSError) -> str:
    what = error.strerror or str(error) or type(error).__name__
    where = error.filename
    return f"{where}: {what}" if isinstance(where, str) else what
