"""A Dask scheduler and its workers as processes of their own, on the loopback."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path


class DaskCluster:
    """A scheduler, and workers that stand in a folder where no profile is.

    Parameters
    ----------
    home : Path
        An empty folder.
    env : mapping of str to str
    """

    def __init__(self, home: Path, env: Mapping[str, str]) -> None:
        self._home, self._env = home, dict(env)
        self._file = home / "scheduler.json"
        self.workers: list[subprocess.Popen[bytes]] = []
        options = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--no-show")
        self.scheduler = self._start("scheduler", *options)
        self.address = self._await_address()

    def add_worker(self) -> subprocess.Popen[bytes]:
        """Start a worker with one thread."""
        options = ("--no-nanny", "--no-dashboard", "--nthreads", "1", "--host", "127.0.0.1")
        self.workers.append(self._start("worker", *options))
        return self.workers[-1]

    def log(self, what: str) -> str:
        """Return what the scheduler, or the workers, wrote."""
        return (self._home / f"{what}.log").read_text()

    def end(self) -> None:
        """End all processes."""
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()

    def _start(self, what: str, *options: str) -> subprocess.Popen[bytes]:
        line = (sys.executable, "-m", "dask", what, "--scheduler-file", str(self._file), *options)
        with open(self._home / f"{what}.log", "ab") as log:
            return subprocess.Popen(line, cwd=self._home, env=self._env, stdout=log, stderr=log)

    def _await_address(self) -> str:
        for _ in range(300):
            try:
                return str(json.loads(self._file.read_text())["address"])
            except (OSError, ValueError, KeyError):
                assert self.scheduler.poll() is None, self.log("scheduler")
                time.sleep(0.1)
        raise TimeoutError("the scheduler does not start")


@contextmanager
def dask_cluster(home: Path, env: Mapping[str, str], workers: int) -> Iterator[DaskCluster]:
    """Offer a cluster while the context lasts."""
    home.mkdir()
    cluster = DaskCluster(home, env)
    try:
        for _ in range(workers):
            cluster.add_worker()
        yield cluster
    finally:
        cluster.end()
