"""What a sweep varies and where it writes: what is refused before anything is computed."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from des_cli.cli import sweep as module
from des_cli.runs_out import lock
from des_cli.runs_out.lock import locked


@pytest.mark.parametrize("taken", ["points.csv", "curve.png"])
def test_what_exists_is_refused_before_anything_is_computed(
    invoke, small: str, tmp_path, monkeypatch: pytest.MonkeyPatch, taken: str
) -> None:
    (tmp_path / taken).write_bytes(b"mine")
    args = ("sweep", small, "--r2s", "1", "--plot", "curve.png", "-o", "points.csv")
    with monkeypatch.context() as patch:
        patch.setattr(module, "_plan", lambda *_: pytest.fail("went on"))
        result = invoke(*args)
    assert (result.exit_code, (tmp_path / taken).read_bytes()) == (1, b"mine")
    assert result.stderr == f"{taken}: exists; --overwrite replaces it\n"
    assert invoke(*args, "--overwrite").exit_code == 0
    assert (tmp_path / taken).read_bytes() != b"mine"


@pytest.mark.skipif(os.name == "nt", reason="nothing is locked on Windows")
@pytest.mark.parametrize("taken", ["points.csv", "curve.png"])
def test_an_output_that_another_run_writes_is_refused(
    invoke, small: str, tmp_path, monkeypatch: pytest.MonkeyPatch, taken: str
) -> None:
    args = ("sweep", small, "--r2s", "1", "--plot", "curve.png", "-o", "points.csv")
    with monkeypatch.context() as patch, locked(tmp_path / taken):
        patch.setattr(module, "_plan", lambda *_: pytest.fail("went on"))
        result = invoke(*args, "--overwrite")
    assert (result.exit_code, result.stdout) == (1, "")
    words = f"is being written by another run (process {os.getpid()})"
    assert result.stderr.startswith(f"{taken}: {words}; ")

    def again(*_: object) -> None:
        assert invoke(*args, "--overwrite").exit_code == 1

    with monkeypatch.context() as patch:
        patch.setattr(module, "read_stdin", again)
        assert invoke(*args).exit_code == 0
    assert {path.name for path in tmp_path.iterdir()} == {small, "points.csv", "curve.png"}


@pytest.mark.skipif(os.name == "nt", reason="nothing is locked on Windows")
def test_what_the_first_wrote_while_the_second_asked_for_it_stays(
    invoke, small: str, tmp_path, monkeypatch: pytest.MonkeyPatch
) -> None:
    @contextmanager
    def late(target: Path) -> Iterator[None]:
        target.write_bytes(b"of the first")
        yield

    monkeypatch.setattr(lock, "locked", late)
    monkeypatch.setattr(module, "_plan", lambda *_: pytest.fail("went on"))
    result = invoke("sweep", small, "--r2s", "1", "-o", "points.csv")
    assert result.exit_code == 1
    assert result.stderr == "points.csv: exists; --overwrite replaces it\n"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
def test_pipes_are_refused_before_anything_is_computed(
    invoke, small: str, tmp_path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("points.csv", "curve.png"):
        os.mkfifo(tmp_path / name)
    monkeypatch.setattr(module, "_plan", lambda *_: pytest.fail("went on"))
    result = invoke("sweep", small, "--r2s", "1", "--plot", "curve.png", "-o", "points.csv")
    assert result.exit_code == 1
    starts = [line.partition("; ")[0] for line in result.stderr.splitlines()]
    assert starts == [f"{name}: is a pipe, not a file" for name in ("points.csv", "curve.png")]


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["--budgets", "0.1", "--r2s", "1"], "exclude each other"),
        (["--r2", "1", "--r2s", "1"], "exclude each other"),
        (["--tracking", "1"], "--tracking needs --r2s"),
        (["--budgets", "0.1,x"], "not a list of numbers"),
        (["--budgets", "0.1,-1"], "above 0"),
        (["--r2s", "inf"], "above 0"),
        (["--budgets", "seat_rate=0.1"], "is not a metric"),
        (["--controls", "both"], "is not free, scalar or per-joint"),
        (["--plot", "curve.pdf"], "FILE.png"),
        (["--plot", "x.png", "-o", "x.png", "-f", "csv"], "both name x.png"),
        (["--plot", "x.png", "-o", "./x.png", "-f", "csv", "--overwrite"], "both name x.png"),
        (["-o", "x.foo"], "x.foo: .foo is no format of a curve: name it .csv, .ndjson, .json or"),
        (["-o", "x.csv", "-f", "json"], "contradicts"),
        (["--budget", "0.1"], "joint_deviation_relative, which is swept"),
        (["--budget", "0.1", "--r2s", "1"], "--budget and --r2s exclude"),
        (["--budgets", "seat_g_rms_error_g=5%"], "is no share: give it in g"),
        (["--r2s", "1", "--controls", "free"], "r2 and tracking weigh factors"),
        (["--ends", "match-rates"], "match-rates needs control: free"),
        (["--set", "reduction.hold=[arm]"], "hold needs control: per-joint"),
    ],
    ids=lambda value: value if isinstance(value, str) else " ".join(value),
)
def test_wrong_use(invoke, small: str, args: list[str], words: str) -> None:
    result = invoke("sweep", small, *args)
    assert (result.exit_code, result.stdout) == (2, "")
    assert words in result.stderr
