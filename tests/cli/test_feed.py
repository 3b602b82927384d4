"""``feed``: rows on stdout, each at its time, and nothing where a check fails."""

from __future__ import annotations

import shutil
import signal
import socket
import subprocess
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

from tests.support.processes import start
from tests.support.run_files import csv_rows
from tests.support.tables import csv_of, resting, riding, swaying


@pytest.fixture
def table(tmp_path: Path) -> str:
    """The name of a table of half a second in the test's folder."""
    (tmp_path / "t.csv").write_bytes(csv_of(swaying(100.0, 0.5)))
    return "t.csv"


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """A clock that waits for nobody, and what it was asked to sleep."""
    slept: list[float] = []

    class Clock:
        def __init__(self) -> None:
            self.time = 0

        def now(self) -> int:
            self.time += 50
            return self.time

        def sleep(self, seconds: float) -> None:
            slept.append(seconds)
            self.time += round(seconds * 1e9)

    monkeypatch.setattr("des_cli.feed.pace.SystemClock", Clock)
    return slept


def test_rows_of_a_table_come_as_they_are(invoke, table: str, patient: list[float]) -> None:
    result = invoke("feed", table, "--at-end", "stop")
    assert result.exit_code == 0, result.stderr
    np.testing.assert_allclose(csv_rows(result.stdout), csv_rows(Path(table).read_text()))
    assert len(patient) == 50
    plan, sent = result.stderr.splitlines()
    assert plan == "t.csv: 51 rows at 100 Hz, 0.5 s"
    assert sent.startswith("t.csv: sent 51 rows, late by 0.000 ms (median), ")


def test_what_is_fed_is_a_table_that_passes(invoke, table: str, patient: list[float]) -> None:
    fed = invoke("-q", "feed", table, "--hz", "130", "--rate", "0.6")
    assert fed.exit_code == 0
    assert (
        fed.stderr
        == "t.csv: --rate 0.6: the arm turns at 0.6 of its speed and makes 0.36 of its G\n"
    )
    rows = csv_rows(fed.stdout)
    np.testing.assert_allclose(np.diff(rows[:, 0]), 1 / 130)
    # It ends at rest.
    assert rows[-1, 1] == 0.0
    assert rows[-1].tolist()[1:] == rows[-2].tolist()[1:]
    assert invoke("verify", "-", input=fed.stdout).exit_code == 0


def test_a_run_is_fed(invoke, small: str, patient: list[float]) -> None:
    options = ("--r1", "2,2,2", "--control", "free", "--axes", "seat", "--ends", "match-start")
    budget = ("--budget", "seat_rate_deviation_relative=0.05", "--no-plots")
    reduced = invoke("-q", "reduce", small, *options, *budget)
    assert reduced.exit_code == 0, reduced.stderr
    result = invoke("feed", "runs/small", "--at-end", "stop", "--hz", "20")
    assert result.exit_code == 0, result.stderr
    expected = csv_rows(Path("runs/small/commands.csv").read_text())
    np.testing.assert_allclose(csv_rows(result.stdout), expected, rtol=1e-12)
    assert invoke("feed", "runs/small", "--arm-deg", "3").exit_code == 2


def test_a_table_comes_on_stdin(invoke, table: str, patient: list[float]) -> None:
    data = Path(table).read_bytes()
    assert invoke("feed", "-", input=data).stdout == invoke("feed", table).stdout


def test_a_table_that_does_not_pass_is_not_fed(invoke, patient: list[float]) -> None:
    data = csv_of(riding())
    broken = data.replace(b"\n0.4,", b"\n0.39,", 1)
    assert broken != data
    result = invoke("feed", "-", input=broken)
    verdict = invoke("verify", "-", input=broken)
    assert (result.exit_code, result.stdout) == (5, "")
    assert result.stderr == verdict.stderr
    cut = invoke("feed", "-", input=data[:-5])
    assert (cut.exit_code, cut.stdout) == (3, "")
    assert invoke("feed", "none.csv").exit_code == 1
    assert patient == []


def test_where_the_machine_stands_is_compared(invoke, table: str, patient: list[float]) -> None:
    result = invoke("feed", table, "--fork-deg", "20")
    assert (result.exit_code, result.stdout) == (5, "")
    assert "start.fork" in result.stderr


def test_a_rate_that_breaks_limits_is_refused_with_the_largest(
    invoke, table: str, patient: list[float]
) -> None:
    result = invoke("feed", table, "--rate", "20", "--at-end", "stop")
    assert (result.exit_code, result.stdout) == (5, "")
    last = result.stderr.splitlines()[-1]
    assert last.startswith("t.csv: the largest rate that keeps them is ")
    largest = last.rpartition(" ")[2]
    assert invoke("feed", table, "--rate", largest, "--at-end", "stop").exit_code == 0


def test_holding_what_moves_is_refused_and_what_rests_ends_in_time(
    invoke, table: str, patient: list[float]
) -> None:
    result = invoke("feed", table, "--at-end", "hold")
    assert (result.exit_code, result.stdout) == (5, "")
    assert result.stderr.splitlines()[-1].endswith("breaks them: give --at-end ramp")
    data = csv_of(resting())
    held = invoke("feed", "-", "--at-end", "hold", "--hold-s", "2", input=data)
    assert held.exit_code == 0, held.stderr
    rows = csv_rows(held.stdout)
    assert len(rows) == 401 + 200
    np.testing.assert_allclose(np.diff(rows[:, 0]), 0.01)
    np.testing.assert_allclose(rows[401:, 1:], np.tile(rows[400, 1:], (200, 1)), atol=1e-9)
    assert ", then held for 2 s" in held.stderr


@pytest.mark.parametrize("preset", ["halstreamer", "veristand", "simulink"])
def test_lines_are_those_that_export_writes(
    invoke, table: str, patient: list[float], preset: str
) -> None:
    fed = invoke("feed", table, "--at-end", "stop", "--preset", preset)
    exported = invoke("export", table, "--hz", "100", "--preset", preset, "-o", "-")
    assert (fed.exit_code, exported.exit_code) == (0, 0)
    assert fed.stdout == exported.stdout


def test_columns_go_on_while_the_last_row_is_held(invoke, patient: list[float]) -> None:
    columns = ("--columns", "elapsed_ms,arm_deg", "--no-header", "--out-separator", "space")
    held = ("--at-end", "hold", "--hold-s", "3")
    result = invoke("feed", "-", *held, *columns, input=csv_of(resting()))
    assert result.exit_code == 0, result.stderr
    rows = np.array([line.split() for line in result.stdout.splitlines()], float)
    assert rows[:, 0].tolist() == [10.0 * number for number in range(701)]
    np.testing.assert_allclose(np.diff(rows[:, 1]), np.degrees(0.01))


def test_a_dry_run_sends_nothing(invoke, table: str, patient: list[float]) -> None:
    result = invoke("feed", table, "--dry-run", "--hz", "130")
    assert (result.exit_code, result.stdout) == (0, "")
    assert result.stderr.startswith("t.csv: 66 rows at 130 Hz, 0.5 s, then ")
    assert patient == []


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--hold-s", "1"], "--hold-s is for --at-end hold."),
        (["--hz", "0.5"], "--hz"),
        (["--rate", "0"], "--rate"),
    ],
)
def test_wrong_use(invoke, table: str, options: list[str], words: str) -> None:
    result = invoke("feed", table, *options)
    assert (result.exit_code, result.stdout) == (2, "")
    assert words in result.stderr


def test_more_rows_than_anyone_sends_are_refused(invoke) -> None:
    long = swaying(10.0, 30_000.0)
    result = invoke("feed", "-", "--hz", "1000", input=csv_of(long))
    assert result.exit_code == 2
    assert "more than 10,000,000 rows: give a lower --hz" in result.stderr


def test_rows_are_told_that_pass_beside_the_tables(invoke, patient: list[float]) -> None:
    result = invoke("feed", "-", "--hz", "130", "--dry-run", input=csv_of(riding()))
    assert "; beside the rows of the table by at most fork 0.0" in result.stderr


def command(*args: str) -> list[str]:
    return [sys.executable, "-m", "des_cli", "feed", *args]


def test_rows_come_one_by_one_through_a_pipe(
    table: str, tmp_path: Path, python_environment: dict[str, str]
) -> None:
    with start(
        *command(table, "--at-end", "stop", "--hz", "50"),
        cwd=tmp_path,
        env=python_environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as process:
        assert process.stdout is not None
        # The first row is there while the last one is yet to come.
        first = process.stdout.readline() + process.stdout.readline()
        assert process.poll() is None
        rest, words = process.communicate()
    assert process.returncode == 0
    assert len(csv_rows((first + rest).decode())) == 26
    assert b"sent 26 rows, late by " in words


def holding(folder: Path, environment: dict[str, str]) -> subprocess.Popen[bytes]:
    """A process that feeds a table and then its last row, until it is ended."""
    (folder / "t.csv").write_bytes(csv_of(resting()))
    return start(
        *command("t.csv", "--at-end", "hold"),
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )


@pytest.mark.parametrize(("name", "code"), [("SIGINT", 130), ("SIGTERM", 143)])
def test_a_signal_ends_at_once(
    name: str, code: int, tmp_path: Path, python_environment: dict[str, str]
) -> None:
    with holding(tmp_path, python_environment) as process:
        assert process.stdout is not None
        for _ in range(3):
            process.stdout.readline()
        process.send_signal(getattr(signal, name))
        rest, words = process.communicate(timeout=20)
    assert process.returncode == code
    # Whole rows, and how late they were.
    assert not rest or rest.endswith(b"\n")
    assert b"late by" in words
    assert b"Traceback" not in words


def test_a_reader_that_goes_away_ends_it(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    with holding(tmp_path, python_environment) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.readline()
        process.stdout.close()
        words = process.stderr.read()
        assert process.wait(timeout=20) == 141
    assert b"late by" in words
    assert b"Traceback" not in words


def listening() -> socket.socket:
    server = socket.socket()
    server.bind(("127.0.0.1", 0))
    server.listen(1)
    return server


def gather(server: socket.socket, into: list[bytes], most: int) -> threading.Thread:
    """Take what is sent to a server, at most so many bytes, and close."""

    def take() -> None:
        connection, _ = server.accept()
        with connection:
            while sum(map(len, into)) < most and (data := connection.recv(4096)):
                into.append(data)

    thread = threading.Thread(target=take, daemon=True)
    thread.start()
    return thread


BASH = shutil.which("bash")
TCP = "exec 3<>/dev/tcp/127.0.0.1/{port} && {feed} >&3"


@pytest.mark.skipif(BASH is None, reason="needs a shell that connects")
@pytest.mark.parametrize(("most", "code"), [(10**9, 0), (100, 141)])
def test_over_a_socket(
    table: str, tmp_path: Path, python_environment: dict[str, str], most: int, code: int
) -> None:
    got: list[bytes] = []
    with listening() as server:
        thread = gather(server, got, most)
        port = server.getsockname()[1]
        feed = f"exec '{sys.executable}' -m des_cli -q feed {table} --at-end stop"
        done = subprocess.run(
            [str(BASH), "-c", TCP.format(port=port, feed=feed)],
            cwd=tmp_path,
            env=python_environment,
            capture_output=True,
            check=False,
            timeout=60,
        )
        thread.join(20)
    assert done.returncode == code, done.stderr
    if not code:
        assert len(csv_rows(b"".join(got).decode())) == 51
    assert b"Traceback" not in done.stderr
