"""Blocks of ``console`` on a page: their commands are run, and what they show is compared."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

FENCE = re.compile(r"^```console\n(.*?)^```", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"`([\w.-]+)`:\n\n```\w+\n(.*?)^```", re.MULTILINE | re.DOTALL)
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
STEPS = re.compile(r"in \d+ iterations")
LAST_CODE = "echo $?"


@dataclass(frozen=True)
class Shown:
    """A command, and the lines that are shown below it; without any nothing is said of them."""

    command: str
    lines: tuple[str, ...]


def commands_of(text: str) -> Iterator[Shown]:
    """Yield the commands of a page in their order."""
    for block in FENCE.findall(text):
        for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
            command, _, lines = re.sub(r"\\\n\s*", "", part).partition("\n")
            yield Shown(command, tuple(lines.splitlines()))


def write_files(text: str, folder: Path) -> None:
    """Write the files that a page shows, each below a line that ends in its name."""
    for name, content in FILE.findall(text):
        (folder / name).write_text(content, encoding="utf-8")


class Shell:
    """Runs commands of a page in a folder.

    Parameters
    ----------
    folder : Path
    environment : mapping
        In which Python finds the tool.
    """

    def __init__(self, folder: Path, environment: Mapping[str, str]) -> None:
        self.folder = folder
        self.environment = environment
        self.code = 0

    def run(self, command: str) -> list[str]:
        """Return what a command prints on both of its outputs, and keep its exit code."""
        if command == LAST_CODE:
            code, self.code = self.code, 0
            return [str(code)]
        # Pictures are three quarters of the time of a run, and no page shows one.
        tool = (
            'des-coriolis() { if [ "$1" = reduce ]; then set -- "$@" --no-plots; fi; '
            f'"{sys.executable}" -m des_cli "$@"; }}\n'
        )
        done = subprocess.run(
            ["bash", "-c", tool + command],
            cwd=self.folder,
            env=dict(self.environment),
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            encoding="utf-8",
            check=False,
        )
        self.code = done.returncode
        return done.stdout.splitlines()


def alike(shown: str, printed: str) -> bool:
    """Whether two lines have the same words, and numbers that agree to 2 %.

    Another kernel of BLAS takes other steps, and a metric that nothing bounds differs in the
    third digit.
    """
    shown, printed = (STEPS.sub("in N iterations", line) for line in (shown, printed))
    if NUMBER.sub("#", shown) != NUMBER.sub("#", printed):
        return False
    pairs = zip(NUMBER.findall(shown), NUMBER.findall(printed), strict=True)
    return all(abs(float(a) - float(b)) <= 0.02 * abs(float(a)) + 0.002 for a, b in pairs)


def missing(shown: Shown, printed: list[str]) -> list[str]:
    """Return the shown lines that were not printed, in this order; ``...`` is any lines."""
    at = 0
    for i, line in enumerate(shown.lines):
        if line.strip() == "...":
            continue
        skipped = i > 0 and shown.lines[i - 1].strip() == "..."
        last = len(printed) if skipped else at + 1
        found = next(
            (k for k in range(at, last) if k < len(printed) and alike(line, printed[k])), None
        )
        if found is None:
            return list(shown.lines[i:])
        at = found + 1
    if shown.lines and shown.lines[-1].strip() != "..." and at < len(printed):
        return [f"(and no more, but: {printed[at]})"]
    return []
