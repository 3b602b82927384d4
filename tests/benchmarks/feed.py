"""How late ``feed`` sends its rows, through a pipe, on this machine as it is.

    python -m tests.benchmarks.feed --repeats 3

10 s at 100 Hz: the 99th percentile is to be at most 5 ms on an idle machine. What the command
itself tells is beside what a reader sees: the spread of the times at which lines arrive.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from tests.benchmarks.processes import PROGRAM, head, row
from tests.support.tables import csv_of, swaying


def arrivals(command: list[str], folder: str) -> tuple[list[float], str]:
    """Return when each line arrived [s], and the last line of words."""
    with subprocess.Popen(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        times = [time.monotonic() for _ in iter(process.stdout.readline, b"")]
        words = process.stderr.read().decode()
    return times[1:], words.splitlines()[-1]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--hz", type=float, nargs="+", default=[100.0, 500.0, 1000.0])
    parser.add_argument("--duration", type=float, default=10.0)
    parser.add_argument("--repeats", type=int, default=1)
    options = parser.parse_args()
    print(head("Hz", "arrival off, 99 % [ms]", "most [ms]", "told"))
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "t.csv").write_bytes(csv_of(swaying(100.0, options.duration)))
        for hz in [each for each in options.hz for _ in range(options.repeats)]:
            line = ("feed", "t.csv", "--at-end", "stop", "--hz", f"{hz:g}")
            times, told = arrivals([sys.executable, *PROGRAM, *line], folder)
            off = np.array(times) - np.arange(len(times)) / hz
            late = 1e3 * (off - np.min(off))
            shares = f"{np.quantile(late, 0.99):.2f}", f"{np.max(late):.2f}"
            print(row([f"{hz:g}", *shares, told.partition("sent ")[2]]), flush=True)


if __name__ == "__main__":
    main()
