"""A machine as the text of a file, to be changed and read back."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from des_cli.model.machine import JOINTS, JointLimits, Machine
from des_cli.model.machines import CHAIN_LENGTHS, MACHINES, ForkAxis, read_chain
from des_cli.profiles_in.machine_file import machine_summary
from des_cli.profiles_in.machine_rows import UNCHAINED
from des_cli.profiles_in.machine_yaml import machine_mapping, occupant_mapping
from des_cli.profiles_in.short_numbers import shortest_unit
from des_cli.profiles_in.yaml_text import yaml_key, yaml_text

_LENGTHS: dict[ForkAxis, str] = {
    "radial": """\
# L2: arm axis to the gimbals' centre. To the seat from there, all joints at zero: Lx down,
# Ly outward, Lz ahead as the arm travels. Lt: up the seat's back to the pilot's head.""",
    "tangential": """\
# L2: arm axis to the gimbals' centre. To the seat from there, all joints at zero: Lx down,
# Ly ahead as the arm travels, Lz inward. Lt: up the seat's back to the pilot's head.""",
}
_FORK_AXIS = """\
# radial: the fork turns about the arm's own direction; tangential: about that of travel."""
_LIMITS = """\
# In both directions. angle: endless, and jerk: unlimited, where there is no limit."""
_OCCUPANT = """\
# What the person in the seat may get; null for an open end. Each bound may be left out."""
_OCCUPANT_EXAMPLE = """\
# occupant:
#   gx_g: [-4, 8]
#   gy_g: [-1, 1]
#   gz_g: [null, 9]
#   g_onset_g_s: 6
#   seat_angular_acceleration_deg_s2: 90"""


def machine_text(machine: Machine, *, full: bool = False) -> str:
    """Return a machine as a YAML file, which a profile's ``machine:`` reads.

    Parameters
    ----------
    machine : Machine
    full : bool
        Whether to write the rows of the chain. Without it they are written only where
        the chain is not one of named lengths, so that what is changed of a length
        changes the machine.

    Returns
    -------
    str
        Every number reads back exactly.
    """
    axis = None if full else _named_chain(machine)
    lines = _full(machine) if axis is None else _short(machine, axis)
    return "\n".join(lines) + "\n"


def _named_chain(machine: Machine) -> ForkAxis | None:
    """Return the fork's axis of a machine that its lengths make, or None for another."""
    chain = read_chain(machine.rows)
    beside = {name: value for name, value in machine.lengths.items() if name != UNCHAINED}
    return chain[1] if chain and chain[0] == beside else None


def _short(machine: Machine, axis: ForkAxis) -> Iterator[str]:
    built_in = MACHINES.get(machine.name) == machine
    if built_in:
        yield f"# {machine_summary(machine)}"
        yield "# Change what you like: what is taken out is as in the base."
        yield f"base: {machine.name}"
        yield "# name: my machine"
        names = [name for name in machine.lengths if name in CHAIN_LENGTHS]
    else:
        yield f"name: {_flow(machine.name)}"
        if machine.source:
            yield f"source: {_flow(machine.source)}"
        names = list(machine.lengths)
    unit, texts = shortest_unit(("m", "ft"), [machine.lengths[name] for name in names])
    each = ", ".join(f"{yaml_key(name)}: {text}" for name, text in zip(names, texts, strict=True))
    yield from (_LENGTHS[axis], f"lengths_{unit.suffix}: {{{each}}}")
    yield from (_FORK_AXIS, f"fork_axis: {axis}")
    yield from (_LIMITS, "limits:")
    for joint, limits in zip(JOINTS, machine.limits, strict=True):
        yield f"  {joint}: {_joint_limits(limits)}"
    yield _OCCUPANT
    bounds = occupant_mapping(machine.occupant)
    if bounds:
        yield from ("occupant:", *(f"  {key}: {_flow(bound)}" for key, bound in bounds.items()))
    else:
        yield _OCCUPANT_EXAMPLE
    yield _measured("gravity", ("m_s2", "ft_s2"), machine.gravity)


def _joint_limits(limits: JointLimits) -> str:
    """Write the limits of a joint, each in the unit in which it is short."""
    return _braced(
        "angle: endless"
        if math.isinf(limits.angle)
        else _measured("angle", ("rad", "deg"), limits.angle),
        _measured("rate", ("rad_s", "deg_s"), limits.rate),
        _measured("acceleration", ("rad_s2", "deg_s2"), limits.acceleration),
        "jerk: unlimited"
        if math.isinf(limits.jerk)
        else _measured("jerk", ("rad_s3", "deg_s3"), limits.jerk),
    )


def _measured(stem: str, suffixes: tuple[str, ...], value: float) -> str:
    unit, (text,) = shortest_unit(suffixes, [value])
    return f"{stem}_{unit.suffix}: {text}"


def _full(machine: Machine) -> Iterator[str]:
    for key, value in machine_mapping(machine).items():
        if isinstance(value, Mapping) and all(isinstance(each, Mapping) for each in value.values()):
            yield from (f"{key}:", *(f"  {name}: {_flow(each)}" for name, each in value.items()))
        elif isinstance(value, list):
            yield from (f"{key}:", *(f"  - {_flow(each)}" for each in value))
        else:
            yield f"{key}: {_flow(value)}"


def _flow(value: Any) -> str:
    """Write a value on one line; keys without quotes where they need none."""
    if isinstance(value, Mapping):
        return _braced(*(f"{yaml_key(key)}: {_flow(each)}" for key, each in value.items()))
    return yaml_text(value)


def _braced(*members: str) -> str:
    return f"{{{', '.join(members)}}}"
