"""How a run grows with the rows of its table: the same maneuver sampled finer, or a longer one.

    python -m tests.benchmarks.rows --rows 100000 1000000

Whole processes, ``reduce x.csv -o o.csv`` at the defaults, from a CSV to a verified command
table. The maneuver is smooth, its cells have all digits, and its limits are those of the DES.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

from tests.benchmarks.processes import PROGRAM, head, in_turns, row, told

PERIOD_S = 12.0
DURATIONS_S = (10.0, 1000.0, 10_000.0)


def write_maneuver(path: Path, rows: int, duration: float) -> None:
    """Write an arm that speeds up and slows down while fork and cab sway."""
    t = np.linspace(0.0, duration, rows)
    w = 2.0 * np.pi / PERIOD_S
    columns = (
        t,
        7.0 + 1.2 * np.sin(w * t),
        -30.0 * (1.0 - np.cos(w * t)),
        20.0 * np.sin(0.7 * w * t) + 10.0 * np.cos(w * t),
    )
    cells = zip(*(column.tolist() for column in columns), strict=True)
    with path.open("w") as stream:
        stream.write("t_s,arm_rpm,fork_deg,cab_deg\n")
        stream.writelines(f"{t!r},{arm!r},{fork!r},{cab!r}\n" for t, arm, fork, cab in cells)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rows", type=int, nargs="+", default=[1000, 10_000, 100_000, 1_000_000])
    parser.add_argument("--durations", type=float, nargs="+", default=list(DURATIONS_S))
    parser.add_argument("--repeats", type=int, default=1)
    options = parser.parse_args()
    print(head("rows", "duration s", "CPU-s", "wall s", "MiB"))
    with tempfile.TemporaryDirectory() as folder:
        for duration in options.durations:
            for rows in options.rows:
                if duration / rows > 0.05:
                    continue  # too coarse to hold the maneuver
                write_maneuver(Path(folder, "x.csv"), rows, duration)
                arguments = ("reduce", "x.csv", "-o", "o.csv", "--overwrite", "-q")
                command = (sys.executable, *PROGRAM, *arguments)
                costs = in_turns({"": command}, Path(folder), options.repeats)[""]
                print(row([str(rows), f"{duration:g}", *told(costs)]), flush=True)


if __name__ == "__main__":
    main()
