"""A batch that is stopped at a random instant: nothing is torn, nobody goes on.

Every fifth batch has workers. In every other there are earlier runs that it is to replace.
"""

import os
import random
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from des_cli.runs_out.stored_run import read_run
from tests.cli.conftest import SMALL
from tests.support.processes import ENDINGS, MARK, marked, start
from tests.support.ready_command import WORDS, ReadyCommand
from tests.support.run_files import tree

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="needs Linux's /proc"),
]

KILLS = int(os.environ.get("DES_CORIOLIS_KILLS", "30"))
SIGNALS = int(os.environ.get("DES_CORIOLIS_SIGNALS", "10"))
"""Of how many batches each is tried; CONTRIBUTING.md tells of more."""

NAMES = ("one", "two", "three")
WORKERS_EVERY = 5


class Batch:
    """The command line that is stopped, and what it writes when it is not."""

    def __init__(self, command: ReadyCommand, home: Path) -> None:
        self._command, self._home, self._number = command, home, 0
        for name in NAMES:
            (home / f"{name}.yaml").write_text(SMALL.format(name=name).replace("0.05", "0.1"))
        self.earlier = self._whole("earlier", "--r2", "8")
        self.later = self._whole("later")
        assert self.earlier.keys() == self.later.keys() == set(NAMES)
        assert all(self.earlier[name] != self.later[name] for name in NAMES)
        self.duration = {jobs: self._time(jobs) for jobs in (1, 2)}

    def folder(self, earlier: bool) -> Path:
        """Return a new folder for runs, with the earlier ones in it if they are asked for."""
        self._number += 1
        folder = self._home / f"runs{self._number}"
        for name in NAMES if earlier else ():
            for file, data in self.earlier[name].items():
                (folder / name / file).parent.mkdir(parents=True, exist_ok=True)
                (folder / name / file).write_bytes(data)
        return folder

    def begin(self, out: Path, jobs: int, *options: str) -> int:
        files = [f"{name}.yaml" for name in NAMES]
        line = ("reduce", *files, "--no-plots", "-o", out.name, "--jobs", str(jobs), *options)
        return self._command.begin(self._home, *line, mark=str(out))

    def end(self) -> tuple[int, str]:
        """Return the exit code and the words."""
        return self._command.end(), (self._home / WORDS).read_text()

    def run(self, out: Path, jobs: int, *options: str) -> None:
        self.begin(out, jobs, *options)
        code, words = self.end()
        assert code == 0, words

    def _whole(self, name: str, *options: str) -> dict[str, dict[str, bytes]]:
        self.run(self._home / name, 1, *options)
        return runs_in(self._home / name)

    def _time(self, jobs: int) -> float:
        began = time.monotonic()
        self.run(self.folder(earlier=False), jobs)
        return time.monotonic() - began


def runs_in(out: Path) -> dict[str, dict[str, bytes]]:
    """Return the bytes of every run, each of which its manifest vouches for."""
    if not out.exists():
        return {}
    found = {}
    for folder in sorted(out.iterdir()):
        if folder.is_dir() and not folder.name.startswith("."):
            read_run(folder)
            found[folder.name] = tree(folder)
    return found


def hidden(out: Path) -> list[str]:
    return [path.name for path in out.rglob(".*")]


def left_of(mark: Path) -> dict[int, str]:
    """Return what still runs of a batch after it was given the time to end."""
    for _ in range(300):
        alive = marked(str(mark))
        if not alive:
            break
        time.sleep(0.1)
    return alive


@pytest.fixture(scope="module")
def batch(
    tmp_path_factory: pytest.TempPathFactory, python_environment: dict[str, str]
) -> Iterator[Batch]:
    with ReadyCommand(python_environment) as command:
        yield Batch(command, tmp_path_factory.mktemp("stopped"))


def stop(batch: Batch, number: int, seed: str, sent: signal.Signals) -> tuple[Path, int, str]:
    """Stop a batch at a random instant; return where it wrote, its exit code and its words."""
    instant = random.Random(f"{seed} {number}")
    jobs = 1 if number % WORKERS_EVERY else 2
    replacing = number % 2 == 1
    out = batch.folder(earlier=replacing)
    process = batch.begin(out, jobs, *(["--overwrite"] if replacing else []))
    time.sleep(instant.uniform(0.0, 0.8 * batch.duration[jobs]))
    with suppress(ProcessLookupError):  # it had ended
        os.kill(process, sent)
    code, words = batch.end()
    assert left_of(out) == {}, "workers go on without their parent"
    for name, files in runs_in(out).items():
        allowed = [batch.later[name], *([batch.earlier[name]] if replacing else [])]
        assert files in allowed, f"{name} is neither of the runs"
    if replacing:
        assert runs_in(out).keys() == set(NAMES), "an earlier run is lost"
    return out, code, words


def test_killed_outright_nothing_is_torn_and_the_next_run_ends_as_ever(batch: Batch) -> None:
    stopped = 0
    for number in range(KILLS):
        out, code, _ = stop(batch, number, "kill", signal.SIGKILL)
        assert code in (0, -signal.SIGKILL)
        stopped += code != 0
        batch.run(out, 1, "--overwrite" if number % 2 else "--resume")
        assert runs_in(out) == batch.later
        assert hidden(out) == []
    assert stopped > 0


@pytest.mark.parametrize("name", sorted(ENDINGS))
def test_a_signal_ends_with_its_code_and_leaves_nothing_half_built(batch: Batch, name: str) -> None:
    sent, stopped = signal.Signals[name], 0
    for number in range(SIGNALS):
        out, code, words = stop(batch, number, name, sent)
        # Before and after there is anything to put away, the signal itself ends it.
        assert code in (0, ENDINGS[name], -sent), words
        stopped += code == ENDINGS[name]
        assert "Traceback" not in words
        assert hidden(out) == []
    assert stopped > 0


@pytest.mark.parametrize("name", sorted(ENDINGS))
def test_a_signal_to_all_of_a_terminal_ends_without_a_traceback(
    batch: Batch, tmp_path: Path, python_environment: dict[str, str], name: str
) -> None:
    """A terminal sends it to the workers too, and to what multiprocessing started."""
    words = tmp_path / WORDS
    out = batch.folder(earlier=False)
    line = ("-m", "des_cli", "reduce", *(f"{each}.yaml" for each in NAMES), "-o", out.name)
    with words.open("wb") as stderr:
        process = start(
            sys.executable,
            *line,
            *("--no-plots", "--jobs", "2"),
            cwd=out.parent,
            env={**python_environment, MARK: str(out)},
            stderr=stderr,
            start_new_session=True,
        )
    for _ in range(3000):
        if sum("spawn_main" in each for each in marked(str(out)).values()) == 2:
            break
        time.sleep(0.01)
    os.killpg(process.pid, signal.Signals[name])
    assert process.wait() == ENDINGS[name]
    assert left_of(out) == {}
    assert "Traceback" not in words.read_text()
    assert "resource_tracker" not in words.read_text()
