"""``des-coriolis`` in a process that has imported everything already.

Half of the time of a short batch goes into imports. Where hundreds are to be stopped at
random instants, one process imports once and each batch is a fork of it; whatever the batch
starts itself is started as ever.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import NoReturn

from tests.support.processes import ENDINGS, MARK

WORDS = "stderr.txt"
"""What a batch says, in its folder."""


class ReadyCommand:
    """The process that forks; a context that ends it."""

    def __init__(self, env: Mapping[str, str]) -> None:
        root = Path(__file__).parents[2]
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.support.ready_command"],
            env={**env, "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": str(root)},
            cwd=root,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def __enter__(self) -> ReadyCommand:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._process.communicate()

    def begin(self, folder: Path, *args: str, mark: str = "") -> int:
        """Start a command line in a folder, and return its process id."""
        assert self._process.stdin is not None
        order = {"folder": str(folder), "args": args, "mark": mark}
        self._process.stdin.write(json.dumps(order) + "\n")
        self._process.stdin.flush()
        return self._number()

    def end(self) -> int:
        """Wait for the end of what was begun; return its exit code, or minus its signal."""
        return self._number()

    def _number(self) -> int:
        assert self._process.stdout is not None
        return int(self._process.stdout.readline())


def _serve() -> None:
    import des_cli.cli.reduce
    import des_cli.pipeline
    import des_cli.release.gate
    import des_cli.runs_out.run_folder
    from des_cli.profiles_in.load import load_profile

    # What is imported on the way of a reduction is imported now.
    des_cli.pipeline.reduce_profile(load_profile("cobra", settings=["time.step_s=0.25"]))
    for line in sys.stdin:
        child = os.fork()
        if not child:
            _become(**json.loads(line))
        print(child, flush=True)
        _, status = os.waitpid(child, 0)
        print(os.waitstatus_to_exitcode(status), flush=True)


def _become(folder: str, args: list[str], mark: str) -> NoReturn:
    from des_cli.__main__ import main

    for name in ENDINGS:
        heard = signal.default_int_handler if name == "SIGINT" else signal.SIG_DFL
        signal.signal(getattr(signal, name), heard)
    os.chdir(folder)
    os.environ[MARK] = mark
    for stream, path in ((sys.stdout, os.devnull), (sys.stderr, WORDS)):
        target = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o666)
        os.dup2(target, stream.fileno())
    sys.argv[1:] = args
    code = 1
    try:
        main()
    except SystemExit as end:
        code = int(end.code or 0)
    finally:
        sys.stderr.flush()
        os._exit(code)


if __name__ == "__main__":
    _serve()
