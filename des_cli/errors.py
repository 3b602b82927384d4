"""One error tree: each class knows its exit code and carries what explains it.

The command line maps an error to its exit code and prints its lines; nothing
else in the project decides how a failure ends.
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
    INTERRUPTED = 130
    READER_GONE = 141


@dataclass(frozen=True, slots=True)
class Problem:
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
    problems : sequence of Problem
        All of them, one line each.
    """

    exit_code = ExitCode.BUG

    def __init__(self, problems: Sequence[Problem]) -> None:
        self.problems = tuple(problems)
        super().__init__("\n".join(str(problem) for problem in self.problems))

    @classmethod
    def of(cls, what: str, where: str = "") -> DesError:
        """Make an error of a single problem."""
        return cls([Problem(where, what)])

    def __reduce__(self) -> tuple[type[DesError], tuple[tuple[Problem, ...]]]:
        """Let an error cross a process boundary with its problems."""
        return type(self), (self.problems,)


class FileAccessError(DesError):
    """A file could not be read or written."""

    exit_code = ExitCode.FILE


class UsageError(DesError):
    """The command was asked for something that it cannot mean."""

    exit_code = ExitCode.USAGE


class ProfileError(DesError):
    """A profile, or the machine that it names, is rejected."""

    exit_code = ExitCode.PROFILE


class NoSolutionError(DesError):
    """The solver ended without a solution that may be used."""

    exit_code = ExitCode.NO_SOLUTION


class NotReleasedError(DesError):
    """A solution exists, but its verification or a limit failed."""

    exit_code = ExitCode.NOT_RELEASED
