"""Processes of the command, started as a shell would start them in the foreground."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

ENDINGS = {"SIGHUP": 129, "SIGINT": 130, "SIGPIPE": 141, "SIGTERM": 143}

MARK = "DES_CORIOLIS_TEST_PROCESS"
"""In the environment of a process and of all that it starts."""


def start(
    *line: str, cwd: Path, env: Mapping[str, str], ignored: tuple[str, ...] = (), **options: Any
) -> subprocess.Popen[bytes]:
    """Start a process that hears signals, whatever this one was started with."""

    def hear() -> None:
        for name in ENDINGS:
            heard = signal.SIG_IGN if name in ignored else signal.SIG_DFL
            signal.signal(getattr(signal, name), heard)

    return subprocess.Popen(line, cwd=cwd, env=dict(env), preexec_fn=hear, **options)


def marked(mark: str) -> dict[int, str]:
    """Return the command lines of all living processes with a mark, by their ids."""
    found = {}
    for folder in Path("/proc").iterdir():
        if not folder.name.isdigit() or int(folder.name) == os.getpid():
            continue
        try:
            if f"{MARK}={mark}".encode() in (folder / "environ").read_bytes().split(b"\0"):
                found[int(folder.name)] = (folder / "cmdline").read_text().replace("\0", " ")
        except OSError:  # ended meanwhile, or somebody else's
            continue
    return found
