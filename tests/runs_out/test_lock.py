"""One run writes to an output at a time, and a dead one holds nothing."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from des_cli.errors import ExitCode, FileAccessError
from des_cli.runs_out import lock
from des_cli.runs_out.lock import clear_lock, locked, short_stem

pytestmark = pytest.mark.skipif(os.name == "nt", reason="nothing is locked on Windows")

HOLDING = """
import sys
from pathlib import Path
from des_cli.runs_out.lock import locked
with locked(Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read()
"""


@contextmanager
def held_elsewhere(target: Path, env: dict[str, str]) -> Iterator[subprocess.Popen[bytes]]:
    pipe = subprocess.PIPE
    line = [sys.executable, "-c", HOLDING, str(target)]
    with subprocess.Popen(line, stdin=pipe, stdout=pipe, env=env) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"held\n"
        yield process


@pytest.mark.parametrize("existing", ["absent", "folder", "file"])
def test_the_second_is_refused_and_told_who_the_first_is(
    tmp_path: Path, python_environment: dict[str, str], existing: str
) -> None:
    target = tmp_path / "runs" / "x.csv"
    if existing != "absent":
        target.parent.mkdir()
        target.mkdir() if existing == "folder" else target.write_bytes(b"old")
    with held_elsewhere(target, python_environment) as first:
        words = rf"another run \(process {first.pid}\)"
        with pytest.raises(FileAccessError, match=words) as caught, locked(target):
            pass
        assert caught.value.exit_code is ExitCode.FILE
        with locked(tmp_path / "runs" / "y.csv"):
            pass
    with locked(target):
        pass
    left = [path.name for path in tmp_path.rglob("*")]
    assert left == ([] if existing == "absent" else ["runs", "x.csv"])


def test_the_dead_hold_nothing_and_their_lock_is_cleared_away(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    target = tmp_path / "run"
    with held_elsewhere(target, python_environment) as first:
        first.send_signal(signal.SIGKILL)
        first.wait()
    assert [path.name for path in tmp_path.iterdir()] == [".run.lock"]
    with locked(target):
        assert (tmp_path / ".run.lock").read_text() == f"{os.getpid()}\n"
    assert list(tmp_path.iterdir()) == []


def test_only_what_nobody_holds_is_cleared(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    target, file = tmp_path / "run", tmp_path / ".run.lock"
    with held_elsewhere(target, python_environment) as first:
        clear_lock(target)
        assert file.is_file()
        first.send_signal(signal.SIGKILL)
        first.wait()
    clear_lock(target)
    assert list(tmp_path.iterdir()) == []
    file.mkdir()  # not of a lock
    clear_lock(target)
    assert file.is_dir()


def test_a_link_to_a_folder_is_the_folder(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to("real")
    another = pytest.raises(FileAccessError, match="another run")
    with locked(tmp_path / "real"), another, locked(tmp_path / "link"):
        pass


def test_a_folder_beside_which_nothing_may_be_written_is_locked_itself(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target, really = tmp_path / "run", os.open
    target.mkdir()

    def refuse(path: Path, *args: int) -> int:
        if Path(path).suffix == ".lock":
            raise PermissionError(13, "Permission denied")
        return really(path, *args)

    monkeypatch.setattr(os, "open", refuse)
    another = pytest.raises(FileAccessError, match="another run")
    with locked(target), another, locked(target):
        pass
    with pytest.raises(FileAccessError, match="permission denied"), locked(tmp_path / "new"):
        pass


def test_parents_are_made_and_stay_only_with_something_in_them(tmp_path: Path) -> None:
    for kept in (False, True):
        target = tmp_path / "deep" / "er" / "run"
        with locked(target):
            assert target.parent.is_dir()
            if kept:
                target.mkdir()
        assert (tmp_path / "deep").exists() is kept


def test_a_device_is_nobodys(tmp_path: Path) -> None:
    with locked(Path("/dev/null")), locked(Path("/dev/null")):
        pass


def test_long_names_keep_their_own_stem() -> None:
    names = ["ü" * 120 + each for each in "ab"]
    assert len({short_stem(name) for name in names}) == 2
    assert all(len(short_stem(name)) <= 40 for name in names)
    assert short_stem("cobra") == "cobra"


def test_a_signal_at_the_very_end_leaves_no_lock_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    really, calls = lock.undisturbed, []

    def late() -> object:
        calls.append(1)
        if len(calls) == 2:  # the first keeps signals waiting while the lock is taken
            raise KeyboardInterrupt
        return really()

    monkeypatch.setattr(lock, "undisturbed", late)
    with pytest.raises(KeyboardInterrupt), lock.locked(tmp_path / "parent" / "run"):
        assert [path.name for path in (tmp_path / "parent").iterdir()] == [".run.lock"]
    assert list(tmp_path.iterdir()) == []
    assert len(calls) == 3
