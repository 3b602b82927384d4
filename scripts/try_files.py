"""Read every file of some folders as a profile, and tell which end otherwise than in words.

    python scripts/try_files.py FOLDER... [--names FILE]...

Each file is reduced in a process of its own, forked from one that has everything imported,
with bounds on memory and time. What is not right: a traceback or an exit code of a bug, more
than ``MEMORY_MIB`` or ``SECONDS``, a table after a refusal, or anything beside the output.
A file of names holds one a line, such as the big list of naughty strings: each is tried as
the name of a profile in YAML, and of a CSV file.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import signal
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from des_cli.cli.main import program
from des_cli.errors import ExitCode

MEMORY_MIB = 512
SECONDS = 5

NAMED = (
    "format: des-coriolis/1\nname: {name}\ntime: {{start_s: 0, stop_s: 1, step_s: 0.1}}\n"
    "joints: {{arm_rpm: 8 - t, fork_deg: 5*t, cab_deg: 30 - t}}\nreduction: {{limits: warn}}\n"
)
TABLE = b"t_s,arm_rpm,fork_deg,cab_deg\n0,8,0,30\n0.1,8,0.1,29\n0.2,8,0.4,28\n0.3,8,0.9,27\n"


def main() -> int:
    """Try what is asked; print what is not right, and how many ended in which way."""
    import des_cli.batch.execution
    import des_cli.pipeline
    import des_cli.profiles_in.load
    import des_cli.runs_out.run_folder  # noqa: F401

    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", type=Path, metavar="FOLDER")
    parser.add_argument("--names", action="append", default=[], type=Path, metavar="FILE")
    options = parser.parse_args()
    ends: Counter[str] = Counter()
    wrong = 0
    for label, file, data in (*_files(options.folders), *_named(options.names)):
        end, faults = _try(file, data)
        ends[end] += 1
        for fault in faults:
            wrong += 1
            print(f"{label}: {fault}", flush=True)
    print(", ".join(f"{count} with {end}" for end, count in sorted(ends.items())))
    print(f"{wrong} not right")
    return bool(wrong)


def _files(folders: list[Path]) -> Iterator[tuple[str, str, bytes]]:
    """Yield a label, a file name and its content."""
    for path in sorted(path for folder in folders for path in folder.rglob("*")):
        if path.is_file():
            yield str(path), path.name, path.read_bytes()


def _named(lists: list[Path]) -> Iterator[tuple[str, str, bytes]]:
    """Yield the same of files made of names."""
    for path in lists:
        for number, line in enumerate(path.read_text("utf-8").split("\n"), start=1):
            text = NAMED.format(name=json.dumps(line))
            yield f"{path}:{number} (YAML)", "named.yaml", text.encode()
            safe = line.replace("/", "_").replace("\0", "_").encode()[:200]
            yield f"{path}:{number} (CSV)", f"{safe.decode(errors='ignore')}.csv", TABLE


def _try(name: str, data: bytes) -> tuple[str, list[str]]:
    """Reduce one file; return how that ended, and what is not right about it."""
    with tempfile.TemporaryDirectory() as folder:
        home = Path(folder)
        (home / "in").mkdir()
        (home / "in" / name).write_bytes(data)
        (home / "work").mkdir()
        child = os.fork()
        if child == 0:
            _reduce(home, f"../in/{name}")
        _, status, usage = os.wait4(child, 0)
        code = os.waitstatus_to_exitcode(status)
        words = (home / "words").read_text(errors="replace") if (home / "words").exists() else ""
        faults = []
        if code < 0:
            faults.append(f"ended by {signal.Signals(-code).name}")
        if code == ExitCode.BUG or "Traceback" in words:
            faults.append(f"a bug: {words[:300]!r}")
        if usage.ru_maxrss > MEMORY_MIB << 10:
            faults.append(f"took {usage.ru_maxrss >> 10} MiB")
        written = [path for path in (home / "work").rglob("*") if path.is_file()]
        if code and written:
            faults.append(f"ended with {code} and wrote {written[0].name}")
        if any(not path.is_relative_to(home / "work" / "runs") for path in written):
            faults.append("wrote outside of its folder")
        others = {path.name for path in home.iterdir()} - {"in", "work", "words"}
        if others or len(list((home / "in").iterdir())) != 1:
            faults.append(f"wrote beside its folder: {sorted(others)}")
    return str(code), faults


def _reduce(home: Path, name: str) -> None:
    """Run the command in this process, which ends here."""
    signal.alarm(SECONDS)
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
    words = os.open(home / "words", os.O_WRONLY | os.O_CREAT)
    os.dup2(words, 2)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    os.chdir(home / "work")
    try:
        program.main(["reduce", "--no-plots", "-o", "runs", "--", name])
    except SystemExit as end:
        os._exit(end.code if isinstance(end.code, int) else 1)
    finally:
        os._exit(ExitCode.BUG)


if __name__ == "__main__":
    sys.exit(main())
