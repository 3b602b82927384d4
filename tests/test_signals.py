"""A signal ends the command with its exit code, and leaves nothing behind."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.processes import ENDINGS, start

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals of a POSIX system")

WORDS = {
    "SIGHUP": b"hung up\n",
    "SIGINT": b"interrupted\n",
    "SIGPIPE": b"",
    "SIGTERM": b"terminated\n",
}

# Tells on stdout when it is about to wait for stdin, so that the signal comes
# neither too early nor too late.
WAITING = """
import sys
import des_cli.cli.reduce as module
from des_cli.cli.main import main

def read_stdin(sources, caps, read=module.read_stdin):
    print("waiting", flush=True)
    return read(sources, caps)

module.read_stdin = read_stdin
sys.argv[1:] = ["reduce", "-", "-o", "x.csv"]
main()
"""


def waiting(folder: Path, env: dict[str, str], *ignored: str) -> subprocess.Popen[bytes]:
    pipe = subprocess.PIPE
    return start(
        *(sys.executable, "-c", WAITING),
        cwd=folder,
        env=env,
        ignored=ignored,
        stdin=pipe,
        stdout=pipe,
        stderr=pipe,
    )


@pytest.mark.parametrize("name", sorted(ENDINGS))
def test_each_ends_with_its_code_in_a_word_and_leaves_nothing(
    tmp_path: Path, python_environment: dict[str, str], name: str
) -> None:
    with waiting(tmp_path, python_environment) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert process.stdout.readline() == b"waiting\n"
        process.send_signal(getattr(signal, name))
        assert process.wait(timeout=60) == ENDINGS[name]
        assert process.stderr.read() == WORDS[name]
    assert list(tmp_path.iterdir()) == []


def test_what_is_ignored_from_the_start_stays_ignored(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    with waiting(tmp_path, python_environment, "SIGHUP", "SIGINT") as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"waiting\n"
        process.send_signal(signal.SIGHUP)
        process.send_signal(signal.SIGINT)
        _, words = process.communicate(b"name: [", timeout=60)
    assert process.returncode == 3, words


def test_ctrl_c_while_the_command_is_imported_is_no_traceback(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    script = """
import os, signal, sys
from importlib.abc import MetaPathFinder

class Interrupting(MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == "click":
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Interrupting())
from des_cli.__main__ import main
main()
"""
    process = start(
        *(sys.executable, "-c", script),
        cwd=tmp_path,
        env=python_environment,
        stderr=subprocess.PIPE,
    )
    with process:
        _, words = process.communicate(timeout=60)
    assert (process.returncode, words) == (-signal.SIGINT, b"")


def code_of(script: str, folder: Path, environment: dict[str, str]) -> int:
    """The exit code of a script."""
    return subprocess.run(
        [sys.executable, "-c", script], cwd=folder, env=environment, check=False
    ).returncode


# The signal comes while something is done that makes another error of whatever is raised.
LOST = """
import os, signal, sys
from des_cli.errors import Stopped
from des_cli.signals import raise_if_stopped, stopping

with stopping():
    raise_if_stopped(ImportError("of its own"))
    try:
        os.kill(os.getpid(), signal.SIGTERM)
        signal.sigtimedwait([], 1)
    except Stopped:
        pass
    try:
        raise_if_stopped(ImportError("initialization failed"))
    except Stopped as again:
        sys.exit(int(again.exit_code))
"""


@pytest.mark.skipif(not hasattr(signal, "sigtimedwait"), reason="signals of a POSIX system")
def test_an_error_that_came_of_a_signal_is_the_signal(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    assert code_of(LOST, tmp_path, python_environment) == 143


# Cython does so while it loads a module, where it registers its types.
SWALLOWED = """
import os, signal, sys, time
from importlib.machinery import ExtensionFileLoader
from des_cli.errors import Stopped
from des_cli.signals import stopping

class Swallowing(ExtensionFileLoader):
    def exec_module(self, module):
        try:
            os.kill(os.getpid(), signal.SIGTERM)
            time.sleep(0.05)
        except BaseException:
            pass

with stopping():
    try:
        Swallowing("name", "path").exec_module(None)
        time.sleep(5)
    except Stopped as stop:
        sys.exit(int(stop.exit_code))
"""


def test_a_signal_is_not_lost_in_compiled_code_that_is_being_loaded(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    assert code_of(SWALLOWED, tmp_path, python_environment) == 143


# The thread that awaits the end of the parent sends the worker a signal of its own.
WORKER = """
import os, signal, sys, threading, time
from multiprocessing import Pipe
from des_cli.batch import worker
from des_cli.signals import undisturbed

def work():
    try:
        with undisturbed():
            ours.close()
            deadline = time.monotonic() + 0.3
            while time.monotonic() < deadline:
                pass
            print("whole", flush=True)
    finally:
        print("put away", flush=True)

theirs, ours = Pipe(duplex=False)
worker.begin(os.getppid(), theirs)
worker.do(work)
"""


def test_what_a_worker_does_undisturbed_is_done(
    tmp_path: Path, python_environment: dict[str, str]
) -> None:
    done = subprocess.run(
        [sys.executable, "-c", WORKER],
        stdout=subprocess.PIPE,
        cwd=tmp_path,
        env=python_environment,
        check=False,
    )
    assert (done.returncode, done.stdout) == (1, b"whole\nput away\n")
