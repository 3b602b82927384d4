"""A machine by its name or from a file of its own, and the text of such a file."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from des_cli.model.machine import Machine
from des_cli.model.machines import MACHINES
from des_cli.profiles_in.findings import Findings
from des_cli.profiles_in.machine_yaml import (
    is_machine_file,
    machine_mapping,
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
        return parse_machine(decode(read_source(Path(choice), label), label), label)
    findings = Findings(Node(option, {}))
    machine = named_machine(choice, (), findings)
    findings.raise_if_any()
    assert machine is not None, "otherwise something was found"
    return machine


def machine_summary(machine: Machine) -> str:
    """Return the first sentence of a machine's source."""
    return machine.source.split(". ")[0].rstrip(".") + "." if machine.source else ""


def machine_text(machine: Machine) -> str:
    """Return a machine as a YAML file, which a profile's ``machine:`` reads.

    The numbers read back exactly.
    """
    lines = []
    for key, value in machine_mapping(machine).items():
        if isinstance(value, Mapping) and all(isinstance(each, Mapping) for each in value.values()):
            lines += [f"{key}:", *(f"  {name}: {_flow(each)}" for name, each in value.items())]
        elif isinstance(value, list):
            lines += [f"{key}:", *(f"  - {_flow(each)}" for each in value)]
        else:
            lines.append(f"{key}: {_flow(value)}")
    return "\n".join(lines) + "\n"


def _flow(value: Any) -> str:
    """Write a value on one line; a text in the quotes of JSON, which are YAML's too."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key}: {_flow(each)}" for key, each in value.items()) + "}"
    return json.dumps(value, ensure_ascii=False)
