"""A machine by its name or from a file of its own."""

from __future__ import annotations

from pathlib import Path

from des_cli.model.machine import Machine
from des_cli.model.machines import MACHINES
from des_cli.profiles_in.caps import DEFAULT_CAPS
from des_cli.profiles_in.findings import Findings
from des_cli.profiles_in.machine_yaml import (
    is_machine_file,
    named_machine,
    parse_machine,
)
from des_cli.profiles_in.source import decode, label_of, read_source
from des_cli.profiles_in.yaml_nodes import Node


def load_machine(choice: str, option: str) -> Machine:
    """Return a built-in machine, or one from a YAML file.

    Parameters
    ----------
    choice : str
        What ends in ``.yaml`` or ``.yml`` or holds a slash is a file, as in a
        profile.
    option : str
        What messages call the place of the choice.

    Raises
    ------
    ProfileError
        If no built-in machine has that name, or with all that is wrong in the
        file.
    FileAccessError
        If the file cannot be read.
    """
    if choice in MACHINES:
        return MACHINES[choice]
    if is_machine_file(choice):
        label = label_of(choice)
        return parse_machine(
            decode(read_source(Path(choice), label, DEFAULT_CAPS.mib), label), label
        )
    findings = Findings(Node(option, {}))
    machine = named_machine(choice, (), findings)
    findings.raise_if_any()
    assert machine is not None, "otherwise something was found"
    return machine


def machine_summary(machine: Machine) -> str:
    """Return the first sentence of a machine's source."""
    return machine.source.split(". ")[0].rstrip(".") + "." if machine.source else ""
