"""What profiles come to on one kernel of the linear algebra, told as JSON on stdout.

    OPENBLAS_CORETYPE=Haswell python -m tests.support.kernels cobra_felt rapid_onset

A library chooses its kernel as it is loaded: each kernel needs a process of its own.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass

from des_cli.errors import DesError, ExitCode
from des_cli.pipeline import reduce_profile
from des_cli.profiles_in.builtin import builtin_profiles
from des_cli.profiles_in.load import load_profile
from des_cli.release.gate import require_table
from des_cli.runs_out.tables import command_columns, encode_table

KERNELS = ("Haswell", "Prescott", "SkylakeX")
"""With 256 bits, with 128, and with 512: three orders of summation."""

NEEDED = {"Haswell": "avx2", "Prescott": "sse3", "SkylakeX": "avx512f"}
"""What a processor must have, as the system lists it; Linux calls SSE3 ``pni``."""


@dataclass(frozen=True, slots=True)
class Ended:
    """How a profile ended: its exit code, its status, and what was taken off (None: nothing)."""

    exit_code: int
    status: str
    reduction: float | None
    said: str = ""


def available(kernel: str) -> bool:
    """Return whether this processor has the instructions of a kernel, as far as is known."""
    try:
        with open("/proc/cpuinfo", encoding="ascii") as file:
            flags = next(line for line in file if line.startswith("flags")).split()
    except (OSError, StopIteration):
        return False
    return NEEDED[kernel].replace("sse3", "pni") in flags


def on_kernel(kernel: str, names: Sequence[str]) -> dict[str, Ended]:
    """Reduce built-in profiles on a kernel, each as far as its table."""
    env = os.environ | {"OPENBLAS_CORETYPE": kernel, "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "tests.support.kernels", *names]
    told = subprocess.run(command, env=env, check=True, capture_output=True, text=True).stdout
    return {name: Ended(**ended) for name, ended in json.loads(told).items()}


def _ended(name: str) -> Ended:
    run = reduce_profile(load_profile(name))
    reduction = run.results.coriolis.reduction("vector")
    code, said = ExitCode.DONE, ""
    try:
        run.require_release()
        require_table(run, encode_table(command_columns(run), "csv"))
    except DesError as error:
        code, said = error.exit_code, str(error)
    return Ended(int(code), run.solution.status, reduction, said)


def main() -> None:
    """Tell how each profile ends that is named, or each that there is."""
    names = sys.argv[1:] or [profile.name for profile in builtin_profiles()]
    print(json.dumps({name: asdict(_ended(name)) for name in names}))


if __name__ == "__main__":
    main()
