"""What many profiles cost: in one batch, one at a time, by two processes, on a cluster.

    python -m tests.benchmarks.batch --count 40

Each profile has 1,001 samples, is reduced at the defaults, and its run folder has no plots.
CPU time is of all processes of a command, memory of the command's own process alone. On the
cluster, which is one worker on this machine, only the command is counted: it reads, writes
and releases.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from tests.benchmarks.processes import ENVIRONMENT, PROGRAM, Cost, head, in_turns, row, run
from tests.support.dask_cluster import dask_cluster

PROFILE = """\
format: des-coriolis/1
time: {{start_s: 0, stop_s: 10, step_s: 0.01}}
joints:
  arm_rpm: "8.8 - {slower}*t"
  fork_deg: "-60*(1 - cos(pi*t/5))"
  cab_deg: "30 - 2.5*t"
"""
LOOP = 10
"""Profiles of the loop over single calls."""

REPEATS = 3
"""Of the batches by one and by two processes, which take turns."""


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=40)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        _measure(Path(folder), options.count)


def _measure(home: Path, count: int) -> None:
    files = [f"p{k:04d}.yaml" for k in range(count)]
    for k, name in enumerate(files):
        (home / name).write_text(PROFILE.format(slower=0.5 + 0.2 * k / count))
    run(_reduce([files[0]], "first"), home)  # compiles, and fills the caches
    batch = run(_reduce(files, "batch"), home)
    loop = [run(_reduce([name], f"loop/{Path(name).stem}"), home) for name in files[:LOOP]]
    same = run(_reduce(files[:LOOP], "ten"), home)
    few = max(count // 4, 1)
    batch_few = run(_reduce(files[:few], "batchfew"), home)
    turns = {jobs: _reduce(files, f"by{jobs}", "--jobs", jobs, "--overwrite") for jobs in "12"}
    taken = in_turns(turns, home, REPEATS)
    kept = run(_reduce(files, "batch", "--resume"), home)
    with dask_cluster(home / "cluster", ENVIRONMENT, 1) as cluster:
        there = ("--scheduler", cluster.address)
        run(_reduce(files[:1], "thereone", *there), home)
        sent_few = run(_reduce(files[:few], "therefew", *there), home)
        sent = run(_reduce(files, "there", *there), home)
    print(head(f"{count} profiles", "CPU-s", "wall s", "CPU-s each"))
    for name, cost in (
        ("one batch", batch),
        ("`--jobs 2`", taken["2"][0]),
        ("`--resume`, all kept", kept),
        ("`--scheduler`, the command alone", sent),
    ):
        print(_row(name, [cost], count))
    print(_row(f"{LOOP} of them, one batch", [same], LOOP))
    print(_row(f"{LOOP} of them, a call each", loop, LOOP))
    each = sum(cost.cpu_s for cost in loop) / same.cpu_s
    print(f"\nCPU time of a call each to that of one batch: {each:.2f}")
    walls = {jobs: min(cost.wall_s for cost in costs) for jobs, costs in taken.items()}
    print(
        f"wall time of --jobs 1 to that of --jobs 2, least of each: {walls['1'] / walls['2']:.2f}"
    )
    size = sum(path.stat().st_size for path in (home / "batch").rglob("*") if path.is_file())
    print(f"bytes of a run folder: {size / count:,.0f}")
    for name, cost, part in (("batch", batch, batch_few), ("--scheduler", sent, sent_few)):
        more = (cost.cpu_s - part.cpu_s) / (count - few)
        print(f"CPU time of each further profile, {name}: {more:.3f} s")
    for number in (max(few, 3), count):
        peak = _own_peak_mib(_reduce(files[:number], f"few{number}", "--jobs", "2"), home)
        print(f"largest memory of the command with --jobs 2, {number} profiles: {peak:.1f} MiB")


def _reduce(names: Sequence[str], out: str, *options: str) -> list[str]:
    line = (sys.executable, *PROGRAM, "-q", "reduce", *names, "--no-plots", "-o", out)
    return [*line, *options]


def _row(name: str, costs: Sequence[Cost], count: int) -> str:
    cpu, wall = sum(cost.cpu_s for cost in costs), sum(cost.wall_s for cost in costs)
    return row([name, f"{cpu:.1f}", f"{wall:.1f}", f"{cpu / count:.3f}"])


def _own_peak_mib(command: Sequence[str], folder: Path) -> float:
    """Return the largest resident set of a process without its children [MiB]."""
    process = subprocess.Popen(
        command, cwd=folder, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    peak = 0.0
    while process.poll() is None:
        status = Path(f"/proc/{process.pid}/status").read_text()
        sizes = [line.split()[1] for line in status.splitlines() if line.startswith("VmHWM:")]
        peak = max([peak, *(int(size) / 1024.0 for size in sizes)])
        try:
            process.wait(0.05)
        except subprocess.TimeoutExpired:
            continue
    if process.returncode:
        raise RuntimeError(f"{command} ended with {process.returncode}")
    return peak


if __name__ == "__main__":
    main()
