"""What whole processes cost: CPU time, wall time and largest memory, runs taken in turns."""

from __future__ import annotations

import os
import statistics
import subprocess
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PROGRAM = ("-m", "des_cli")

ENVIRONMENT = {
    **{name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"},
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]),
}


@dataclass(frozen=True)
class Cost:
    """What one process, with its children, cost.

    Parameters
    ----------
    cpu_s, wall_s : float
    memory_mib : float
        The largest resident set of any of its processes.
    """

    cpu_s: float
    wall_s: float
    memory_mib: float


def run(command: Sequence[str], folder: Path, accepted: Sequence[int] = (0,)) -> Cost:
    """Run a command in a folder and return what it cost.

    Raises
    ------
    RuntimeError
        If it ends with an exit code that is not accepted.
    """
    began = time.perf_counter()
    with tempfile.TemporaryFile() as words:
        process = subprocess.Popen(
            command, cwd=folder, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=words
        )
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - began
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode not in accepted:
            words.seek(0)
            raise RuntimeError(f"{command} ended with {process.returncode}: {words.read()!r}")
    return Cost(usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss / 1024.0)


def in_turns(
    commands: Mapping[str, Sequence[str]], folder: Path, repeats: int
) -> dict[str, list[Cost]]:
    """Run every command so often, one after the other, so that a slow moment hits all."""
    costs: dict[str, list[Cost]] = {name: [] for name in commands}
    for _ in range(repeats):
        for name, command in commands.items():
            costs[name].append(run(command, folder))
    return costs


def told(costs: Sequence[Cost]) -> list[str]:
    """Return the cells of a table: median CPU time and its spread, wall time, memory."""
    cpu = [cost.cpu_s for cost in costs]
    return [
        f"{statistics.median(cpu):.3g} ({min(cpu):.3g} to {max(cpu):.3g})",
        f"{statistics.median(cost.wall_s for cost in costs):.3g}",
        f"{max(cost.memory_mib for cost in costs):.0f}",
    ]


def row(cells: Sequence[str]) -> str:
    """Return a row of a table."""
    return "| " + " | ".join(cells) + " |"


def head(*cells: str) -> str:
    """Return the head of a table whose first column is text and whose others are numbers."""
    return row(cells) + "\n" + row(["---", *["---:"] * (len(cells) - 1)])


def ratio(mine: Sequence[Cost], others: Sequence[Cost]) -> float:
    """Return the ratio of median CPU times."""
    return statistics.median(cost.cpu_s for cost in mine) / statistics.median(
        cost.cpu_s for cost in others
    )
