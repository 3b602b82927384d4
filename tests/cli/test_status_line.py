"""The line that tells what is being done: when it is there, what it says, and that it goes."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from des_cli.cli import status_line
from des_cli.cli.console import QUIET, Console
from des_cli.cli.status_line import StatusLine
from des_cli.model.solution import Iteration

ERASE = "\r\x1b[K"


class Clock:
    """Seconds that grow only when told to."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def still(monkeypatch: pytest.MonkeyPatch) -> None:
    """A thread that never draws by itself."""
    monkeypatch.setattr(StatusLine, "_keep_going", lambda self: None)


def step(number: int) -> Iteration:
    return Iteration(number, 1.0, 0.0, 1.0, 1.0)


@pytest.mark.usefixtures("still")
def test_it_appears_after_a_second_is_rewritten_and_gone() -> None:
    stream, clock = io.StringIO(), Clock()
    with StatusLine(stream, clock=clock) as line:
        line.stage("reading")
        clock.now += 0.9
        line.stage("desired motion")
        assert stream.getvalue() == ""
        clock.now += 1.2
        line.stage("grid 1 of 2")
        clock.now += 1.0
        line.iteration(step(7))
        line.iteration(step(8))  # too soon to be drawn
        clock.now += 1.0
        line.stage("verification")
    drawn = stream.getvalue().split(ERASE)
    shown = ["", "  grid 1 of 2, 2 s", "  grid 1 of 2, step 7, 3 s", "  verification, 4 s", ""]
    assert drawn == shown


@pytest.mark.usefixtures("still")
def test_nothing_is_written_of_short_work() -> None:
    stream = io.StringIO()
    with StatusLine(stream, clock=Clock()) as line:
        line.stage("reading")
        with line.hidden():
            pass
    assert stream.getvalue() == ""


@pytest.mark.usefixtures("still")
def test_of_several_it_counts_those_that_are_done() -> None:
    stream, clock = io.StringIO(), Clock()
    with StatusLine(stream, total=3, noun="points", clock=clock) as line:
        line.stage("reading")
        clock.now += 2.0
        line.advance()
        clock.now += 1.0
        line.stage("desired motion")
    assert stream.getvalue().split(ERASE)[1:-1] == [
        "  1 of 3 points done, 2 s, about 4 s left",
        "  1 of 3 points done, desired motion, 3 s, about 3 s left",
    ]


@pytest.mark.usefixtures("still")
def test_the_time_left_is_at_the_pace_of_what_was_done_last() -> None:
    stream, clock = io.StringIO(), Clock()
    with StatusLine(stream, total=200, clock=clock) as line:
        for _ in range(100):  # kept by --resume
            line.advance()
        for _ in range(40):
            clock.now += 10.0
            line.advance()
        clock.now += 1000.0
        line.stage("overdue")
        for _ in range(60):
            clock.now += 1.0
            line.advance()
    drawn = stream.getvalue().split(ERASE)
    assert "  140 of 200 profiles done, 400 s, about 10 min left" in drawn
    assert "  140 of 200 profiles done, overdue, 1400 s" in drawn
    assert "  200 of 200 profiles done, 1460 s" in drawn


@pytest.mark.usefixtures("still")
def test_it_makes_room_for_what_is_printed_and_comes_back() -> None:
    stream, clock = io.StringIO(), Clock()
    with StatusLine(stream, clock=clock) as line:
        clock.now += 2.0
        line.stage("grid 1 of 1")
        with line.hidden():
            stream.write("a warning\n")
        clock.now += 1.0
        line.stage("baselines")
    assert stream.getvalue() == (
        f"{ERASE}  grid 1 of 1, 2 s{ERASE}a warning\n{ERASE}  baselines, 3 s{ERASE}"
    )


def test_a_thread_keeps_the_seconds_going(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(status_line, "INTERVAL_S", 0.0)
    seen = threading.Event()

    class Watched(io.StringIO):
        def write(self, text: str) -> int:
            if "reading, 5 s" in text:
                seen.set()
            return super().write(text)

    clock = Clock()
    with StatusLine(Watched(), clock=clock) as line:
        line.stage("reading")
        clock.now += 5.0
        assert seen.wait(60.0)  # nobody else draws


def test_a_terminal_that_went_away_does_not_end_the_work() -> None:
    stream, clock = io.StringIO(), Clock()
    with StatusLine(stream, clock=clock) as line:
        stream.close()
        clock.now += 2.0
        line.stage("baselines")


def test_quiet_and_a_pipe_have_none(monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setattr(status_line, "DELAY_S", -1.0)
    monkeypatch.setenv("TERM", "xterm")

    def drawn(stream: io.StringIO, verbosity: int = 0) -> str:
        monkeypatch.setattr(sys, "stderr", stream)
        console = Console()
        console.verbosity = verbosity
        with console.working() as line:
            line.stage("reading")
        return stream.getvalue()

    assert "reading" in drawn(Terminal())
    assert drawn(Terminal(), QUIET) == ""
    assert drawn(io.StringIO()) == ""
    monkeypatch.setenv("TERM", "dumb")
    assert drawn(Terminal()) == ""


AT_ONCE = """\
import des_cli.cli.status_line as status_line
status_line.DELAY_S = status_line.INTERVAL_S = 0.0
from des_cli.cli.main import main
main()
"""

OnTerminal = Callable[..., tuple[str, bytes]]


@pytest.fixture
def on_terminal(tmp_path: Path, python_environment: dict[str, str]) -> OnTerminal:
    """Run a command line whose stderr is a terminal, its line drawn at once."""
    pty = pytest.importorskip("pty")

    def run(*args: str) -> tuple[str, bytes]:
        ours, theirs = pty.openpty()
        process = subprocess.Popen(
            [sys.executable, "-c", AT_ONCE, *args],
            cwd=tmp_path,
            env=python_environment | {"TERM": "xterm", "NO_COLOR": "1"},
            stdout=subprocess.PIPE,
            stderr=theirs,
        )
        os.close(theirs)
        said = b""
        try:
            while block := os.read(ours, 1 << 16):
                said += block
        except OSError:  # how Linux says that the other end is closed
            pass
        os.close(ours)
        data, _ = process.communicate()
        assert process.returncode == 0, said.decode()
        return said.decode(), data

    return run


def words(said: str) -> str:
    """What stays on the terminal once every line that was erased is gone."""
    return re.sub(r"\r\x1b\[K[^\r]*(?=\r\x1b\[K)", "", said).replace(ERASE, "").replace("\r", "")


@pytest.mark.slow
def test_one_profile_on_a_terminal_names_its_stages(
    on_terminal: OnTerminal, write_profile: Callable[..., Path], command
) -> None:
    name = write_profile("free", control="free", limits="enforce").name
    arguments = ("reduce", name, "-o", "-", "--budget", "5%")
    said, data = on_terminal(*arguments)
    stages = [
        "reading free.yaml", "desired motion", "motion inside the limits", "grid 1 of 1",
        "settling the table", "baselines", "verification", "tables",
    ]  # fmt: skip
    places = [said.index(f"{ERASE}  {stage}") for stage in stages]
    assert places == sorted(places)
    assert re.search(r"grid 1 of \d, step \d+, \d+ s", said)
    plain = command(*arguments)
    assert data == plain.stdout
    assert words(said) == plain.stderr.decode()
    assert b"\r" not in plain.stderr
    assert b"\x1b" not in plain.stderr


@pytest.mark.slow
def test_several_profiles_on_a_terminal_are_counted(
    on_terminal: OnTerminal, write_profile: Callable[..., Path], command
) -> None:
    names = [write_profile(name).name for name in ("one", "two")]
    arguments = ("reduce", *names, "--no-plots", "--overwrite")
    said, _ = on_terminal(*arguments)
    assert "0 of 2 profiles done, reading one.yaml" in said
    assert "1 of 2 profiles done, reading two.yaml" in said
    assert words(said) == command(*arguments).stderr.decode()
    said, _ = on_terminal(*arguments, "--jobs", "2")
    assert "  1 of 2 profiles done" in said


@pytest.mark.slow
def test_the_points_of_a_sweep_are_counted(
    on_terminal: OnTerminal, write_profile: Callable[..., Path], command
) -> None:
    write_profile("small")
    arguments = ("sweep", "small.yaml", "--r2s", "1", "--controls", "scalar")
    said, data = on_terminal(*arguments)
    assert "0 of 2 points done, reading" in said
    assert "1 of 2 points done, baselines" in said
    plain = command(*arguments)
    assert (words(said), data) == (plain.stderr.decode(), plain.stdout)
