"""Every exception has one exit code and one line."""

import errno
import pickle

import pytest

from des_cli.errors import (
    Complaint,
    DesError,
    ExitCode,
    Failure,
    FileAccessError,
    NoSolutionError,
    NotReleasedError,
    ProfileError,
    UnreadableError,
    UsageError,
)


@pytest.mark.parametrize(
    ("kind", "code"),
    [
        (FileAccessError, 1),
        (UnreadableError, 1),
        (UsageError, 2),
        (ProfileError, 3),
        (NoSolutionError, 4),
        (NotReleasedError, 5),
    ],
)
def test_own_errors_keep_their_code_and_all_their_lines(kind: type[DesError], code: int) -> None:
    failure = Failure.of(kind([Complaint("a.yaml:1:2", "is wrong"), Complaint("", "also this")]))
    assert failure.exit_code == code
    assert failure.lines == ("a.yaml:1:2: is wrong", "also this")
    assert failure.traceback == ""


def test_operating_system_errors_name_the_file() -> None:
    failure = Failure.of(PermissionError(errno.EACCES, "Permission denied", "x.csv"))
    assert (failure.exit_code, failure.lines) == (1, ("x.csv: Permission denied",))
    failure = Failure.of(OSError(errno.ENOSPC, "No space left on device"))
    assert failure.lines == ("No space left on device",)


def test_a_gone_reader_is_told_nothing() -> None:
    failure = Failure.of(BrokenPipeError(errno.EPIPE, "Broken pipe"))
    assert (failure.exit_code, failure.lines) == (ExitCode.READER_GONE, ())


def test_interruption() -> None:
    assert Failure.of(KeyboardInterrupt()).exit_code == 130


def test_anything_else_is_a_bug_in_one_line_with_a_traceback() -> None:
    def inner() -> None:
        raise ValueError("first line\nsecond line")

    with pytest.raises(ValueError, match="first line") as caught:
        inner()
    failure = Failure.of(caught.value)
    assert failure.exit_code == 70
    assert failure.lines == ("bug: ValueError: first line",)
    assert "in inner" in failure.traceback


def test_a_bug_without_words() -> None:
    assert Failure.of(AssertionError()).lines == ("bug: AssertionError",)


def test_failures_cross_process_boundaries() -> None:
    failure = Failure.of(ValueError("x"))
    assert pickle.loads(pickle.dumps(failure)) == failure
