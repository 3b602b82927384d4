"""A disk that is full, wherever that shows: said in a line, nothing torn, nothing lost."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from des_cli.errors import FileAccessError
from des_cli.model.run import Run
from des_cli.runs_out import run_folder
from des_cli.runs_out.atomic import write_file
from des_cli.runs_out.manifest import is_run
from des_cli.runs_out.run_folder import write_run
from des_cli.runs_out.stored_run import read_run
from tests.support.fuse import Fuse
from tests.support.run_files import tree

pytestmark = pytest.mark.slow

MakeRun = Callable[..., Run]
CALLS = ("open", "fsync", "mkdir", "rename", "replace", "link")
FULL = "no space left on"
LONG, SHORT = 21, 11
"""Samples of the earlier run, and of the one that is written."""


def written(run: Run, target: Path) -> str:
    """Write a run and read it back; return what is said where that fails."""
    try:
        write_run(run, target, plots=False)
    except FileAccessError as error:
        return str(error)
    read_run(target)
    return ""


def held(target: Path, old: dict[str, bytes]) -> None:
    """Assert that there is what was there, or the new run, and no leftover."""
    now = tree(target)
    if now != old:
        assert len(read_run(target).trajectory["t_s"]) == SHORT
    assert not leftovers(target)


def leftovers(target: Path) -> list[str]:
    return [name for name in os.listdir(target.parent) if name.startswith(".")]


@pytest.mark.parametrize("exchange", [True, False])
@pytest.mark.parametrize("earlier", [True, False])
@pytest.mark.parametrize("name", CALLS)
def test_at_every_call_the_earlier_run_stays_or_the_new_one_stands(
    tmp_path: Path,
    synthetic_run: MakeRun,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    earlier: bool,
    exchange: bool,
) -> None:
    if not exchange:
        monkeypatch.setattr(run_folder, "exchange", lambda one, other: False)
    run, target = synthetic_run(SHORT), tmp_path / "cobra"
    for fail_at in range(1, 60):
        shutil.rmtree(target, ignore_errors=True)
        if earlier:
            write_run(synthetic_run(LONG), target, plots=False)
        old = tree(target)
        with monkeypatch.context() as patch:
            fuse = Fuse(patch, name, fail_at, OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)))
            try:
                write_run(run, target, plots=False, overwrite=True)
            except FileAccessError as error:
                told = str(error)
            else:
                told = ""
        if fuse.calls < fail_at:
            break
        if told:
            assert told.startswith(str(tmp_path))
            assert FULL in told.lower()
            assert "\n" not in told
        if name == "open" and leftovers(target):
            # The earlier run could not be cleared away: the next one does.
            assert earlier
            (left,) = leftovers(target)
            shutil.rmtree(target.parent / left)
        if exchange or not earlier:
            held(target, old)
        elif tree(target) != old and is_run(target):
            # Where folders cannot be exchanged there is a moment without a run, and no other.
            assert len(read_run(target).trajectory["t_s"]) == SHORT
    else:
        pytest.fail("the disk never had room")


def in_a_child(do: Callable[[], object], limit: int) -> int:
    """Do something in a process that may write no file longer than a limit [bytes]."""
    import resource

    child = os.fork()
    if child == 0:
        code = 70
        try:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
            do()
            code = 0
        except FileAccessError as error:
            code = 1 if "\n" not in str(error) else 70
        finally:
            os._exit(code)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs a limit of a process of its own")
def test_a_file_that_finds_no_room_at_any_byte(tmp_path: Path, synthetic_run: MakeRun) -> None:
    run, target = synthetic_run(SHORT), tmp_path / "cobra"
    write_run(synthetic_run(LONG), target, plots=False)
    old, ends = tree(target), set()
    for limit in (0, 1, 100, 1000, 3000, 5000, 8000, 12_000, 20_000, 40_000, 1 << 20):
        code = in_a_child(lambda: write_run(run, target, plots=False, overwrite=True), limit)
        ends.add(code)
        assert code in (0, 1), limit
        assert code == 0 or tree(target) == old, limit
        held(target, old)
    assert ends == {0, 1}


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Callable[[int], Path]]:
    """Mount a file system in memory with so many KiB; skipped where that is not allowed."""
    made: list[Path] = []

    def mount(kib: int) -> Path:
        place = tmp_path / f"disk{len(made)}"
        place.mkdir()
        command = ["mount", "-t", "tmpfs", "-o", f"size={kib}k", "tmpfs", str(place)]
        if shutil.which("mount") is None or subprocess.run(command, capture_output=True).returncode:
            pytest.skip("no file system may be mounted here")
        made.append(place)
        return place

    yield mount
    for place in made:
        subprocess.run(["umount", str(place)], check=True)


def test_on_a_real_small_disk(small_disk: Callable[[int], Path], synthetic_run: MakeRun) -> None:
    run, ends = synthetic_run(SHORT), set()
    for kib in (4, 8, 16, 24, 32, 48, 64, 128, 256, 512):
        disk = small_disk(kib)
        told = written(run, disk / "cobra")
        ends.add(bool(told))
        assert FULL in told.lower() or not told
        assert (disk / "cobra").exists() != bool(told)
        assert not [name for name in os.listdir(disk) if ".partial-" in name]
    assert ends == {False, True}


def test_a_table_alone_on_a_small_disk(small_disk: Callable[[int], Path]) -> None:
    disk = small_disk(64)
    write_file(disk / "x.csv", b"old" * 4096)
    with pytest.raises(FileAccessError, match=FULL):
        write_file(disk / "x.csv", b"new" * 32_768, overwrite=True)
    assert tree(disk) == {"x.csv": b"old" * 4096}
