"""A file stands whole under its name, or not at all."""

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from des_cli.errors import ExitCode, FileAccessError
from des_cli.runs_out import atomic
from des_cli.runs_out.atomic import new_folder, write_file


def names(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_writes_the_bytes_and_leaves_nothing_else(tmp_path: Path) -> None:
    target = tmp_path / "x.csv"
    assert write_file(target, b"a\n1\n") == target
    assert target.read_bytes() == b"a\n1\n"
    assert names(tmp_path) == ["x.csv"]


def test_refuses_an_existing_file_and_names_the_option(tmp_path: Path) -> None:
    target = tmp_path / "x.csv"
    target.write_bytes(b"old")
    with pytest.raises(FileAccessError, match="--overwrite") as caught:
        write_file(target, b"new")
    assert caught.value.exit_code is ExitCode.FILE
    assert target.read_bytes() == b"old"
    write_file(target, b"new", overwrite=True)
    assert target.read_bytes() == b"new"
    assert names(tmp_path) == ["x.csv"]


def test_refuses_a_file_that_appeared_while_it_wrote(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "x.csv"
    sync = os.fsync

    def someone_else_is_faster(descriptor: int) -> None:
        target.write_bytes(b"theirs")
        sync(descriptor)

    monkeypatch.setattr(os, "fsync", someone_else_is_faster)
    with pytest.raises(FileAccessError, match="--overwrite"):
        write_file(target, b"ours")
    assert target.read_bytes() == b"theirs"
    assert names(tmp_path) == ["x.csv"]


@pytest.mark.parametrize("already", [None, b"taken"])
def test_file_systems_without_hard_links_are_served_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, already: bytes | None
) -> None:
    target = tmp_path / "x.csv"

    def no_link(source: Path, name: Path) -> None:
        if already is not None:
            target.write_bytes(already)
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "link", no_link)
    if already is None:
        write_file(target, b"new")
        assert target.read_bytes() == b"new"
    else:
        with pytest.raises(FileAccessError, match="--overwrite"):
            write_file(target, b"new")
        assert target.read_bytes() == already
    assert names(tmp_path) == ["x.csv"]


@pytest.mark.parametrize(
    ("overwrite", "call"),
    [(False, "fsync"), (False, "link"), (True, "fsync"), (True, "replace")],
)
@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError])
def test_an_interruption_leaves_everything_as_it_was(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    overwrite: bool,
    call: str,
    error: type[BaseException],
) -> None:
    target = tmp_path / "x.csv"
    if overwrite:
        target.write_bytes(b"old")

    def interrupt(*args: object) -> None:
        raise error

    monkeypatch.setattr(os, call, interrupt)
    with pytest.raises(error):
        write_file(target, b"new", overwrite=overwrite)
    monkeypatch.undo()
    assert names(tmp_path) == (["x.csv"] if overwrite else [])
    if overwrite:
        assert target.read_bytes() == b"old"


@pytest.mark.skipif(os.name == "nt", reason="no SIGKILL on Windows")
@pytest.mark.parametrize("kill_at", [1, 2])
def test_a_killed_process_leaves_no_half_file(
    tmp_path: Path, python_environment: dict[str, str], kill_at: int
) -> None:
    """Killed when the data is written but not synced, and before the folder is."""
    script = f"""
import os, signal
from des_cli.runs_out.atomic import write_file
sync, calls = os.fsync, 0
def kill(descriptor):
    global calls
    calls += 1
    if calls == {kill_at}:
        os.kill(os.getpid(), signal.SIGKILL)
    sync(descriptor)
os.fsync = kill
write_file("x.csv", b"0123456789" * 100_000)
"""
    ended = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, env=python_environment, check=False
    )
    assert ended.returncode == -9
    target = tmp_path / "x.csv"
    assert target.exists() == (kill_at == 2)
    if target.exists():
        assert target.stat().st_size == 1_000_000
    assert all(atomic.is_temporary(name) for name in names(tmp_path) if name != "x.csv")


@pytest.mark.skipif(os.name == "nt", reason="no permissions of POSIX on Windows")
def test_permissions_are_those_of_the_umask_and_of_the_file_replaced(tmp_path: Path) -> None:
    target = tmp_path / "x.csv"
    mask = os.umask(0o027)
    try:
        write_file(target, b"new")
        assert stat.S_IMODE(target.stat().st_mode) == 0o640
        target.chmod(0o604)
        write_file(target, b"newer", overwrite=True)
        assert stat.S_IMODE(target.stat().st_mode) == 0o604
    finally:
        os.umask(mask)


def test_a_link_is_followed_and_stays_a_link(tmp_path: Path) -> None:
    (tmp_path / "real.csv").write_bytes(b"old")
    link = tmp_path / "link.csv"
    link.symlink_to("real.csv")
    write_file(link, b"new", overwrite=True)
    assert link.is_symlink()
    assert (tmp_path / "real.csv").read_bytes() == b"new"


def test_a_device_is_written_to_and_not_replaced() -> None:
    write_file("/dev/null", b"gone")
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
def test_a_pipe_with_a_name_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for overwrite in (False, True):
        with pytest.raises(FileAccessError, match="pipe: is a pipe, not a file"):
            write_file(tmp_path / "pipe", b"new", overwrite=overwrite)
    read, write = os.pipe()
    write_file(f"/dev/fd/{write}", b"new")
    assert os.read(read, 9) == b"new"
    for each in (read, write):
        os.close(each)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("absent/x.csv", "its folder does not exist"),
        ("folder", "is a folder; name a file"),
        ("file/x.csv", "a part of the path is a file"),
        ("x" * 300, "the name is too long"),
        ("nul\0byte", "null"),
    ],
)
def test_what_cannot_be_written_is_said_in_one_line(tmp_path: Path, name: str, words: str) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(FileAccessError, match=words) as caught:
        write_file(tmp_path / name, b"new", overwrite=True)
    assert len(caught.value.complaints) == 1
    assert names(tmp_path) == ["file", "folder"]


def test_the_longest_names_have_temporaries_too(tmp_path: Path) -> None:
    target = tmp_path / ("ü" * 127)
    write_file(target, b"new")
    assert target.read_bytes() == b"new"


def test_a_new_folder_is_gone_after_an_exception(tmp_path: Path) -> None:
    def fail() -> None:
        with new_folder(tmp_path, "run") as folder:
            (folder / "x").write_bytes(b"half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert names(tmp_path) == []


def test_what_a_killed_process_left_is_removed_and_what_is_being_built_is_not(
    tmp_path: Path,
) -> None:
    target, stays = tmp_path / "run", [".run.partial-x", ".run2.partial-0123abcd", "run"]
    left = [".run.partial-0123abcd", ".run.partial-4567abcd"]
    (tmp_path / left[0]).mkdir()
    (tmp_path / left[0] / "x").write_bytes(b"half")
    (tmp_path / left[1]).write_bytes(b"half")
    for name in stays:
        (tmp_path / name).mkdir()
    with new_folder(tmp_path, "run") as first:
        assert names(tmp_path) == sorted([*stays, first.name])
        with new_folder(tmp_path, "run") as second:
            assert names(tmp_path) == sorted([*stays, first.name, second.name])
        write_file(tmp_path / "x", b"")
        assert first.is_dir()
    assert target.is_dir()


@pytest.mark.parametrize(
    ("name", "expected"),
    [(".x.partial-0123abcd", True), (".x.partial-", False), ("x.partial-0123abcd", False)],
)
def test_temporaries_are_known_by_their_names(name: str, expected: bool) -> None:
    assert atomic.is_temporary(name) is expected
    assert atomic.is_temporary(atomic.beside(Path("runs/cobra")).name)
