"""A run as a profile of its own: the command table beside it, with the seat as it was found.

Where a reduction found constants of the machine together with the motion, the table alone
does not tell what the pilot feels: the seat is part of it.
"""

from __future__ import annotations

import numpy as np

from des_cli.model.machines import MACHINES
from des_cli.model.run import Run
from des_cli.profiles_in.machine_yaml import machine_mapping
from des_cli.profiles_in.yaml_text import yaml_text


def encode_run_profile(run: Run, table: str) -> bytes:
    """Return the YAML of a profile that plays a run's command table.

    Parameters
    ----------
    run : Run
    table : str
        Name of the command table's file in the same folder.
    """
    machine = run.profile.machine
    built_in = MACHINES.get(machine.name) == machine
    document = {
        "format": "des-coriolis/1",
        "name": run.profile.name,
        "machine": machine.name if built_in else machine_mapping(machine),
        "seat": {"yaw_rad": run.seat.yaw, "pitch_rad": run.seat.pitch},
        "initial": {"arm_rad": float(run.commands.angle[0, 0])},
        "samples": {"file": table},
        # A command table says what happens between its rows, however far they are apart.
        "gap": "bridge",
    }
    lines = [
        f"# {run.profile.name}, as it was reduced: the commands and the seat belong together.",
        *(_found(run)),
        # every double reads back exactly
        *(f"{key}: {yaml_text(value)}" for key, value in document.items()),
    ]
    return ("\n".join(lines) + "\n").encode()


def _found(run: Run) -> list[str]:
    return [
        f"# {name}: {np.round(before, 3):g} -> {np.round(after, 3):g} deg"
        for name, each in (run.results.parameters or {}).items()
        for before, after in [each.angle.known or (np.nan, np.nan)]
    ]
