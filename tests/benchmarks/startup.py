"""Start-up beside what it cannot do without: importing the libraries that a command uses.

    python -m tests.benchmarks.startup --repeats 15

``--help`` beside ``import click``; ``reduce cobra -o x.csv``, which solves and verifies, beside
importing click, numpy, scipy.linalg, pyarrow.csv and ruamel.yaml. Whole processes, in turns.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from tests.benchmarks.processes import PROGRAM, head, in_turns, ratio, row, told

FLOOR = "import click, numpy, scipy.linalg, pyarrow.csv, ruamel.yaml"
COBRA = ("reduce", "cobra", "-o", "x.csv", "--overwrite", "-q")
COMMANDS = {
    "python -c pass": ("-c", "pass"),
    "import click": ("-c", "import click"),
    "--help": (*PROGRAM, "--help"),
    "reduce --help": (*PROGRAM, "reduce", "--help"),
    FLOOR: ("-c", FLOOR),
    "validate cobra": (*PROGRAM, "validate", "cobra"),
    "reduce cobra -o x.csv": (*PROGRAM, *COBRA),
    "reduce cobra_felt -o x.csv": (*PROGRAM, *(COBRA[0], "cobra_felt", *COBRA[2:])),
}
PEERS = {
    "--help": "import click",
    "reduce --help": "import click",
    "validate cobra": FLOOR,
    "reduce cobra -o x.csv": FLOOR,
    "reduce cobra_felt -o x.csv": FLOOR,
}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=15)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        commands = {name: (sys.executable, *command) for name, command in COMMANDS.items()}
        in_turns(commands, Path(folder), 1)  # compiles, and fills the caches
        costs = in_turns(commands, Path(folder), options.repeats)
    print(head("process", "CPU-s", "wall s", "MiB", "ratio", "to"))
    for name in commands:
        peer = PEERS.get(name)
        shown = [f"{ratio(costs[name], costs[peer]):.2f}", f"`{peer}`"] if peer else ["", ""]
        print(row([f"`{name}`", *told(costs[name]), *shown]))


if __name__ == "__main__":
    main()
