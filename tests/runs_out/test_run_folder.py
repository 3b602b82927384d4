"""A run folder: its manifest vouches for every file, or there is no run."""

import hashlib
import json
import math
import os
import shutil
import stat
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from des_cli.errors import FileAccessError, NotReleasedError
from des_cli.model.run import Run
from des_cli.runs_out import run_folder
from des_cli.runs_out.atomic import is_temporary
from des_cli.runs_out.exchange import exchange
from des_cli.runs_out.manifest import is_run
from des_cli.runs_out.run_folder import discard_run, write_run
from des_cli.runs_out.stored_run import read_run
from des_cli.runs_out.tables import trajectory_columns
from tests.support.fuse import Fuse
from tests.support.run_files import entry, rewrite, tree

MakeRun = Callable[..., Run]


FILES = ["commands.csv", "manifest.json", "metrics.json", "trajectory.parquet"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("control", "adjoint", "figures"),
    [("scalar", 3, 8), ("per-joint", 3, 8), ("per-joint", 0, 7), ("free", 0, 6)],
)
def test_everything_reads_back(
    tmp_path: Path, synthetic_run: MakeRun, control: str, adjoint: int, figures: int
) -> None:
    run = synthetic_run(101, control=control)
    solution = replace(run.solution, adjoint=run.solution.adjoint[:, :adjoint])
    run = replace(run, solution=solution)
    folder = tmp_path / "runs" / "cobra"
    written = write_run(run, folder)
    assert written[-1] == folder / "manifest.json"
    assert sorted(str(path.relative_to(folder)) for path in written) == sorted(tree(folder))
    assert len(list((folder / "plots").glob("*.png"))) == figures
    found = read_run(folder)
    assert found.name == "cobra"
    assert found.metrics == run.metrics
    expected = trajectory_columns(run)
    assert list(found.trajectory) == list(expected)
    for name, values in expected.items():
        np.testing.assert_array_equal(found.trajectory[name], values)


@pytest.mark.slow
def test_the_same_run_gives_the_same_bytes_anywhere(tmp_path: Path, synthetic_run: MakeRun) -> None:
    write_run(synthetic_run(), tmp_path / "one")
    write_run(synthetic_run(), tmp_path / "two" / "deeper")
    assert tree(tmp_path / "one") == tree(tmp_path / "two" / "deeper")


@pytest.mark.slow
@pytest.mark.parametrize("plots", [False, True])
def test_a_folder_that_holds_a_run_is_refused_or_replaced(
    stored: Path, synthetic_run: MakeRun, plots: bool
) -> None:
    before = tree(stored)
    with pytest.raises(FileAccessError, match="--overwrite"):
        write_run(synthetic_run(51), stored, plots=plots)
    assert tree(stored) == before
    write_run(synthetic_run(51), stored, plots=plots, overwrite=True)
    assert len(read_run(stored).trajectory["t_s"]) == 51


@pytest.mark.slow
def test_replacing_removes_what_the_new_run_does_not_have(
    stored: Path, synthetic_run: MakeRun
) -> None:
    write_run(synthetic_run(), stored, plots=True, overwrite=True)
    write_run(synthetic_run(), stored, plots=False, overwrite=True)
    assert sorted(path.name for path in stored.iterdir()) == FILES


@pytest.mark.slow
def test_foreign_files_are_refused_and_never_destroyed(
    tmp_path: Path, synthetic_run: MakeRun
) -> None:
    (tmp_path / "plots").mkdir()
    foreign = {"thesis.tex": b"years of work", "plots/mine.png": b"mine"}
    for name, data in foreign.items():
        (tmp_path / name).write_bytes(data)
    with pytest.raises(FileAccessError, match="not empty and holds no run"):
        write_run(synthetic_run(), tmp_path)
    assert tree(tmp_path) == foreign
    write_run(synthetic_run(), tmp_path, overwrite=True)
    write_run(synthetic_run(), tmp_path, plots=False, overwrite=True)
    discard_run(tmp_path)
    assert tree(tmp_path) == foreign


def test_an_empty_folder_is_used_and_a_file_is_refused(
    tmp_path: Path, synthetic_run: MakeRun
) -> None:
    (tmp_path / "empty").mkdir()
    # As a killed process leaves it.
    (tmp_path / "empty" / ".manifest.json.partial-0123abcd").mkdir()
    write_run(synthetic_run(), tmp_path / "empty", plots=False)
    assert is_run(tmp_path / "empty")
    (tmp_path / "file").write_bytes(b"data")
    with pytest.raises(FileAccessError, match="is a file"):
        write_run(synthetic_run(), tmp_path / "file", overwrite=True)
    assert (tmp_path / "file").read_bytes() == b"data"


@pytest.mark.parametrize(
    ("existing", "name"),
    [
        *(("absent", name) for name in ("open", "fsync", "mkdir", "rename")),
        *(("run", name) for name in ("open", "fsync", "mkdir")),
        *(
            (existing, name)
            for existing in ("empty", "run that stays", "foreign")
            for name in ("open", "fsync", "mkdir", "replace")
        ),
    ],
)
def test_an_interruption_at_any_moment_leaves_no_output(
    tmp_path: Path,
    synthetic_run: MakeRun,
    monkeypatch: pytest.MonkeyPatch,
    name: str,
    existing: str,
) -> None:
    """Every call is interrupted once; then there is what was there, or the new run."""
    run, target = synthetic_run(11), tmp_path / "cobra"
    if existing == "run that stays":  # where no two folders can be exchanged
        monkeypatch.setattr(run_folder, "exchange", lambda one, other: False)
    for blow_at in range(1, 50):
        shutil.rmtree(target, ignore_errors=True)
        if existing.startswith("run"):
            write_run(synthetic_run(21), target, plots=False)
        elif existing != "absent":
            target.mkdir()
        if existing == "foreign":
            (target / "thesis.tex").write_bytes(b"years of work")
        old = tree(target)
        with monkeypatch.context() as patch:
            fuse = Fuse(patch, name, blow_at)
            try:
                write_run(run, target, plots=False, overwrite=True)
            except KeyboardInterrupt:
                pass
            else:
                assert fuse.calls < blow_at
                break
        beside = [path.name for path in tmp_path.iterdir()]
        if name == "open" and existing.startswith("run"):
            # The removal of the earlier run was interrupted: the next one clears it away.
            beside = [each for each in beside if not is_temporary(each)]
        assert beside in ([], ["cobra"])
        left = tree(target)
        if left != old:
            assert len(read_run(target).trajectory["t_s"]) == 11
        if existing == "foreign":
            assert left["thesis.tex"] == b"years of work"
    else:
        pytest.fail("the fuse never came to its end")
    assert blow_at > 1, "nothing was interrupted"


def test_a_run_is_replaced_in_one_step(
    stored: Path, synthetic_run: MakeRun, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At the only moment at which anything changes there is the old run, then the new one."""
    seen = []

    def watched(one: Path, other: Path) -> bool:
        seen.append(len(read_run(stored).trajectory["t_s"]))
        done = exchange(one, other)
        seen.append(len(read_run(stored).trajectory["t_s"]))
        return done

    monkeypatch.setattr(run_folder, "exchange", watched)
    stored.chmod(0o750)
    write_run(synthetic_run(51), stored, plots=False, overwrite=True)
    assert seen == [101, 51 if exchange_works(stored) else 101]
    assert len(read_run(stored).trajectory["t_s"]) == 51
    assert stat.S_IMODE(stored.stat().st_mode) == 0o750
    assert [path.name for path in stored.parent.iterdir()] == ["cobra"]


def exchange_works(folder: Path) -> bool:
    one, other = folder / "one", folder / "other"
    one.mkdir()
    other.mkdir()
    return exchange(one, other)


@pytest.mark.parametrize("what", ["link", "file"])
def test_plots_that_are_no_folder_are_not_written_through(
    tmp_path: Path, stored: Path, synthetic_run: MakeRun, what: str
) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    if what == "link":
        (stored / "plots").symlink_to(outside)
    else:
        (stored / "plots").write_bytes(b"mine")
    before = tree(stored)
    with pytest.raises(FileAccessError, match=r"plots: is not a folder of the run's own"):
        write_run(synthetic_run(51), stored, overwrite=True)
    assert tree(stored) == before
    assert list(outside.iterdir()) == []


def test_a_folder_in_the_place_of_a_file_is_not_destroyed(
    stored: Path, synthetic_run: MakeRun
) -> None:
    (stored / "profile.yaml").unlink(missing_ok=True)
    (stored / "commands.csv").unlink()
    (stored / "commands.csv").mkdir()
    (stored / "commands.csv" / "thesis.tex").write_bytes(b"years of work")
    with pytest.raises(FileAccessError, match=r"commands\.csv: is a folder"):
        write_run(synthetic_run(51), stored, plots=False, overwrite=True)
    assert (stored / "commands.csv" / "thesis.tex").read_bytes() == b"years of work"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes in folders")
def test_a_pipe_in_the_folder_is_replaced_and_not_waited_for(
    stored: Path, synthetic_run: MakeRun
) -> None:
    (stored / "commands.csv").unlink()
    os.mkfifo(stored / "commands.csv")
    write_run(synthetic_run(51), stored, plots=False, overwrite=True)
    assert len(read_run(stored).trajectory["t_s"]) == 51


def test_a_value_that_is_no_number_leaves_no_folder(tmp_path: Path, synthetic_run: MakeRun) -> None:
    run = synthetic_run()
    run.before.seat_g[3, 1, 2] = math.nan
    with pytest.raises(NotReleasedError, match="seat_gz_before_g"):
        write_run(run, tmp_path / "cobra")
    assert list(tmp_path.iterdir()) == []


def test_discarding_follows_no_link_out_of_the_folder(tmp_path: Path, stored: Path) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "x.png").write_bytes(b"mine")
    (stored / "plots").symlink_to(outside)
    rewrite(stored, files=[entry(name="plots/x.png")])
    discard_run(stored)
    assert (outside / "x.png").read_bytes() == b"mine"
    assert not is_run(stored)


@pytest.mark.parametrize("done", range(5))
def test_a_removal_that_is_killed_leaves_no_table_and_is_finished_by_the_next(
    stored: Path, monkeypatch: pytest.MonkeyPatch, done: int
) -> None:
    plot = b"png"
    (stored / "plots").mkdir()
    (stored / "plots" / "x.png").write_bytes(plot)
    (stored / "mine.txt").write_bytes(b"mine")
    manifest = json.loads((stored / "manifest.json").read_bytes())
    digest = hashlib.sha256(plot).hexdigest()
    listed = entry(name="plots/x.png") | {"size": len(plot), "sha256": digest}
    rewrite(stored, files=[*manifest["files"], listed])
    really, removed = Path.unlink, []

    def kill(path: Path, **options: bool) -> None:
        if len(removed) == done:
            raise SystemExit
        really(path, **options)
        removed.append(path.name)

    monkeypatch.setattr(Path, "unlink", kill)
    with pytest.raises(SystemExit):
        discard_run(stored)
    monkeypatch.undo()
    assert removed[:1] == ["commands.csv"][:done]
    assert is_run(stored)
    discard_run(stored)
    assert tree(stored) == {"mine.txt": b"mine"}
    assert not (stored / "plots").exists()
