"""``reduce``: what is refused, what has no solution, and with which exit code."""

import os
import socket

import numpy as np
import pytest

from des_cli import pipeline
from des_cli.runs_out.lock import locked
from des_cli.runs_out.manifest import is_run
from tests.support.run_files import csv_rows


@pytest.mark.parametrize("way", ["reduce", "dry-run", "validate"])
def test_what_excludes_something_else_is_2(invoke, small: str, tmp_path, way: str) -> None:
    options = (
        "--limits",
        "enforce",
        "--algorithm",
        "report-sweep",
        "--set",
        "reduction.hold=[arm]",
    )
    command = ("validate", small) if way == "validate" else ("reduce", small)
    result = invoke(*command, *options, *(["--dry-run"] if way == "dry-run" else []))
    assert (result.exit_code, result.stdout) == (2, "")
    lines = result.stderr.splitlines()
    assert len(lines) == 2
    assert all(line.startswith("small: reduction: ") for line in lines)
    assert "--limits warn" in lines[0]
    assert "per-joint" in lines[1]
    assert {path.name for path in tmp_path.iterdir()} == {small}


def test_sweeps_that_run_away_are_4_in_one_line(invoke, tmp_path) -> None:
    options = ("--algorithm", "report-sweep", "--iterations", "20", "--r2", "0.02")
    result = invoke("reduce", "cobra", "--set", "time.step_s=0.05", *options)
    assert (result.exit_code, result.stdout) == (4, "")
    (line,) = result.stderr.splitlines()
    assert line.startswith("cobra: diverged: sweep ")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("fork", ["0", '"-60*(1 - cos(pi*t/5))"'])
@pytest.mark.parametrize(
    "args",
    [["--budget", "0.05"], ["--budget", "seat_rate_deviation_relative=0.1"], ["--r2", "1"]],
    ids=" ".join,
)
def test_a_motion_without_coriolis_stays_as_it_is(invoke, write_profile, fork, args) -> None:
    # the arm alone, and the fork alone
    arm = "8" if fork == "0" else "0"
    still = write_profile("still", arm_rpm=arm, fork_deg=fork, cab_deg="0").name
    result = invoke("reduce", still, "-o", "-", *args)
    assert result.exit_code == 0, result.stderr
    desired = invoke("reduce", still, "-o", "-", "--algorithm", "report-sweep").stdout
    np.testing.assert_allclose(csv_rows(result.stdout), csv_rows(desired), rtol=0, atol=1e-3)


def test_a_machine_at_rest_stays_at_rest(invoke, write_profile) -> None:
    rest = write_profile("rest", arm_rpm="0", fork_deg="0", cab_deg="0").name
    for args in (["--budget", "0.05"], ["--budget", "seat_rate_deviation_relative=0.1"], []):
        result = invoke("reduce", rest, "-o", "-", *args)
        assert result.exit_code == 0, result.stderr
        assert not csv_rows(result.stdout)[:, 1:].any()


def test_check_refuses_a_motion_beyond_the_limits(invoke, write_profile, tmp_path) -> None:
    fast = write_profile("fast", arm_rpm='"8.8 + 20*t"').name
    for out in ("x.csv", "folder"):
        result = invoke("reduce", fast, "--limits", "check", "-o", out)
        assert result.exit_code == 5
        assert "exceeds the limit" in result.stderr
        assert not (tmp_path / out).exists()


def test_no_solution_is_4_and_leaves_no_table(invoke, small: str, tmp_path) -> None:
    args = ("--set", "reduction.max_iterations=1", "--r2", "0.01")
    for out in ("x.csv", "folder", "-"):
        result = invoke("reduce", small, *args, "-o", out)
        assert (result.exit_code, result.stdout) == (4, "")
        assert result.stderr.startswith("small: ")
        assert {path.name for path in tmp_path.iterdir()} == {small}


def test_a_rejected_profile_is_3_with_every_problem(invoke, write_profile, tmp_path) -> None:
    bad = write_profile("bad", fork_deg="sin(", machine="dse").name
    result = invoke("reduce", bad)
    assert (result.exit_code, result.stdout) == (3, "")
    assert len(result.stderr.splitlines()) == 2
    assert not (tmp_path / "runs").exists()


def test_a_failed_overwrite_leaves_no_older_table(invoke, small: str, tmp_path) -> None:
    broken = ("--set", "reduction.max_iterations=1", "--r2", "0.01", "--overwrite")
    for out in ("x.csv", "folder"):
        assert invoke("reduce", small, "--no-plots", "-o", out).exit_code == 0
        result = invoke("reduce", small, *broken, "-o", out)
        assert result.exit_code == 4
        assert f"withdrew the earlier {out}" in result.stderr
        assert not (tmp_path / "x.csv").exists()
        assert not list(tmp_path.glob("folder/*.*"))


@pytest.mark.parametrize("args", [[], ["--jobs", "2", "--keep-going"]], ids=["one", "batch"])
def test_a_profile_that_was_broken_leaves_no_older_table(
    invoke, write_profile, tmp_path, args: list[str]
) -> None:
    names = [write_profile(name).name for name in (("bad", "good") if args else ("bad",))]
    assert invoke("reduce", *names, "--no-plots", *args).exit_code == 0
    write_profile("bad", fork_deg="sin(")
    result = invoke("-q", "reduce", *names, "--no-plots", "--overwrite", *args)
    assert result.exit_code == (1 if args else 3)
    assert "withdrew the earlier runs/bad" in result.stderr
    assert not list((tmp_path / "runs" / "bad").iterdir())
    assert is_run(tmp_path / "runs" / "good") is bool(args)


def test_a_profile_that_was_broken_never_passes_over_an_older_table(
    invoke, write_profile, tmp_path
) -> None:
    name = write_profile("bad").name
    assert invoke("reduce", name, "--no-plots").exit_code == 0
    write_profile("bad", fork_deg="sin(")
    result = invoke("-q", "reduce", name, "--no-plots")
    assert result.exit_code == 3
    assert "left the earlier runs/bad as it is" in result.stderr
    (tmp_path / name).write_text("name: [")
    result = invoke("-q", "reduce", name, "--no-plots", "--overwrite")
    assert result.exit_code == 3
    assert "left an earlier run of bad.yaml in runs" in result.stderr
    assert is_run(tmp_path / "runs" / "bad")


@pytest.mark.skipif(os.name == "nt", reason="nothing is locked on Windows")
@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize("out", ["x.csv", "folder", "runs"])
def test_an_output_that_another_run_writes_is_refused(
    invoke, write_profile, tmp_path, out: str, overwrite: bool
) -> None:
    names = [write_profile(name).name for name in (("one", "two") if out == "runs" else ("one",))]
    target = tmp_path / "runs" / "one" if out == "runs" else tmp_path / out
    args = ("--no-plots", "-o", out, *(["--overwrite"] if overwrite else []))
    with locked(target):
        result = invoke("reduce", *names, *args, "--keep-going")
    assert result.exit_code == 1
    assert f"is being written by another run (process {os.getpid()})" in result.stderr
    assert not target.exists()
    assert is_run(tmp_path / "runs" / "two") is (out == "runs")


def test_an_existing_output_is_refused_before_solving(invoke, small: str, tmp_path) -> None:
    for out in ("x.csv", "folder"):
        assert invoke("reduce", small, "--no-plots", "-o", out).exit_code == 0
        target = tmp_path / out
        before = (target if target.is_file() else target / "commands.csv").read_bytes()
        result = invoke("reduce", small, "-v", "--r2", "8", "-o", out)
        assert result.exit_code == 1
        assert "--overwrite" in result.stderr
        assert "iter" not in result.stderr
        after = (target if target.is_file() else target / "commands.csv").read_bytes()
        assert before == after
        again = ("reduce", small, "--no-plots", "--r2", "8", "-o", out, "--overwrite")
        assert invoke(*again).exit_code == 0
        replaced = (target if target.is_file() else target / "commands.csv").read_bytes()
        assert replaced != before


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
@pytest.mark.parametrize("how", [[], ["--overwrite"], ["--dry-run"]], ids=" ".join)
@pytest.mark.parametrize(
    ("out", "words"),
    [
        ("pipe.csv", "pipe.csv: is a pipe, not a file; write to '-', and into the pipe with >"),
        ("socket.csv", "socket.csv: is not a file; name another"),
        ("pipe", "pipe: is no folder; a run needs a folder, name another"),
        ("file", "file: is a file; a run needs a folder, name another"),
        ("file/below/it", "file: is a file; a run needs a folder, name another"),
        ("link", "link: is a link that leads nowhere; a run needs a folder, name another"),
        ("link/below", "link: is a link that leads nowhere; a run needs a folder, name another"),
        (None, "runs/small: is a link that leads nowhere; a run needs a folder, name another"),
    ],
)
def test_what_can_hold_no_output_is_refused_before_solving(
    invoke,
    small: str,
    tmp_path,
    monkeypatch: pytest.MonkeyPatch,
    out: str | None,
    words: str,
    how: list[str],
) -> None:
    for name in ("pipe.csv", "pipe"):
        os.mkfifo(tmp_path / name)
    (tmp_path / "file").write_bytes(b"mine")
    (tmp_path / "runs").mkdir()
    for name in ("link", "runs/small"):
        (tmp_path / name).symlink_to("nowhere")
    monkeypatch.setattr(pipeline, "reduce_profile", lambda *_, **__: pytest.fail("solved"))
    before = sorted(tmp_path.rglob("*"))
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind("socket.csv")
        result = invoke("reduce", small, *how, *([] if out is None else ["-o", out]))
        (tmp_path / "socket.csv").unlink()
    assert (result.exit_code, result.stdout, result.stderr) == (1, "", f"{words}\n")
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.skipif(not os.path.exists("/dev/stdout"), reason="there is no such device here")
def test_a_pipe_without_a_name_is_written_to(command, small: str) -> None:
    table = command("-q", "reduce", small, "-o", "-").stdout
    done = command("-q", "reduce", small, "-o", "/dev/stdout", "-f", "csv")
    assert (done.returncode, done.stdout) == (0, table)


def test_a_missing_folder_of_a_table_is_refused_before_solving(invoke, small: str) -> None:
    result = invoke("reduce", small, "-v", "-o", "no/x.csv")
    assert result.exit_code == 1
    assert result.stderr.count("\n") == 1


def test_dry_run_writes_nothing(invoke, small: str, tmp_path) -> None:
    result = invoke("reduce", small, "--dry-run")
    assert (result.exit_code, result.stdout) == (0, "")
    assert "would be reduced into runs/small" in result.stderr
    assert {path.name for path in tmp_path.iterdir()} == {small}


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["-f", "json"], "add -o FILE"),
        (["-o", "x.csv", "-f", "json"], "contradicts"),
        (["-o", ".", "-f", "json"], "is a folder"),
        (["-o", "x.csv", "--resume"], "--resume needs run folders"),
        (["other.yaml", "-o", "x.csv"], "several profiles"),
        (["other.yaml", "-o", "-"], "several profiles"),
        (["--set", "reduction.r2"], "KEY=VALUE"),
        (["--set", "=1"], "KEY=VALUE"),
        (["--column", "t_s"], "NAME=HEADER"),
        (["--column", "t_s=a", "--column", "t_s=b"], "given twice"),
        (["--separator", "x"], "must be ',', ';', '|', tab or space"),
        (["--decimal", ":"], "must be '.' or ','"),
        (["--separator", ";"], "this is YAML: give samples.separator"),
        (["--jobs", "-1"], "--jobs"),
        (["--iterations", "0"], "--iterations"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else None,
)
def test_wrong_use_is_2(invoke, small: str, args: list[str], words: str) -> None:
    result = invoke("reduce", small, *args)
    assert (result.exit_code, result.stdout) == (2, "")
    assert words in result.stderr
