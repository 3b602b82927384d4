"""A machine described in YAML: read, and shown so that it reads back."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from pydantic import ValidationError

from des_cli.model.machine import (
    ASSUMED_JERK_PER_ACCELERATION,
    JOINTS,
    UNBOUNDED,
    DHRow,
    JointLimits,
    Machine,
    OccupantBounds,
)
from des_cli.model.machines import MACHINES
from des_cli.profiles_in.findings import Findings
from des_cli.profiles_in.machine_rows import read_chain_of_section
from des_cli.profiles_in.machine_schema import JointLimits as JointLimitsSection
from des_cli.profiles_in.machine_schema import MachineSection
from des_cli.profiles_in.wording import did_you_mean, one_of, plain
from des_cli.profiles_in.yaml_nodes import Step, parse_yaml
from des_cli.units import STANDARD_GRAVITY_M_S2

_G_COMPONENTS = ("gx", "gy", "gz")


def parse_machine(text: str, label: str) -> Machine:
    """Read a machine from the text of a YAML file.

    Parameters
    ----------
    text : str
    label : str
        What messages call the file.

    Raises
    ------
    ProfileError
        With everything that is wrong.
    """
    findings = Findings(parse_yaml(text, label))
    try:
        section = MachineSection.model_validate(findings.root.plain())
    except ValidationError as error:
        findings.add_validation(error)
        findings.raise_if_any()
        raise
    machine = build_machine(section, (), findings)
    findings.raise_if_any()
    assert machine is not None
    return machine


def is_machine_file(choice: str) -> bool:
    """Tell a file's path from the name of a built-in machine."""
    return choice.endswith((".yaml", ".yml")) or "/" in choice or "\\" in choice


def named_machine(name: str, path: Sequence[Step], findings: Findings) -> Machine | None:
    """Return a built-in machine, or None after saying that there is none."""
    machine = MACHINES.get(name)
    if machine is None:
        hint = did_you_mean(name, MACHINES) or f"; there is {one_of(sorted(MACHINES))}"
        what = f"there is no built-in machine {plain(name)}{hint}, or give a file's path"
        findings.add(path, what)
    return machine


def build_machine(section: Any, path: Sequence[Step], findings: Findings) -> Machine | None:
    """Make the machine that a valid section describes.

    Parameters
    ----------
    section : MachineSection
    path : sequence of str or int
        Where it stands in the document.
    findings : Findings
        Takes what is wrong.

    Returns
    -------
    Machine or None
        None after saying what is wrong.
    """
    known = len(findings.complaints)
    base = None
    if section.base is not None:
        base = named_machine(section.base, [*path, "base"], findings)
    has_base = section.base is not None
    limits = _limits(section, base, has_base, path, findings)
    chain = read_chain_of_section(section, base, path, findings)
    gravity = section.si("gravity", base.gravity if base else STANDARD_GRAVITY_M_S2)
    if len(findings.complaints) > known or chain is None:
        return None
    machine = Machine(
        name=section.name or (base.name if base else "own machine"),
        rows=chain.rows,
        limits=(limits[0], limits[1], limits[2]),
        gravity=gravity,
        lengths=chain.lengths,
        source=section.source or (base.source if base else ""),
        occupant=_occupant(section.occupant, base.occupant if base else OccupantBounds()),
    )
    if base and machine != base and not section.name:
        return replace(machine, name=f"{base.name} (changed)")
    return machine


def _limits(
    section: Any, base: Machine | None, has_base: bool, path: Sequence[Step], findings: Findings
) -> list[JointLimits]:
    found = []
    for index, joint in enumerate(JOINTS):
        own = getattr(section.limits, joint) if section.limits else None
        limits = base.limits[index] if base else JointLimits(math.inf, math.nan, math.nan)
        missing = [] if has_base else ["angle", "rate", "acceleration"]
        if own is not None:
            changes = {
                measure.stem: own.si(measure.stem)
                for measure in own.measures
                if own.given(measure.stem)
            }
            for key in ("angle", "jerk"):
                if getattr(own, key) is not None:
                    changes[key] = math.inf
            missing = [name for name in missing if name not in changes]
            if not has_base:
                changes.setdefault(
                    "jerk", ASSUMED_JERK_PER_ACCELERATION * changes.get("acceleration", math.nan)
                )
            limits = replace(limits, **changes)
        where = [*path, "limits", joint]
        for name in missing:
            keys = next(m.keys for m in JointLimitsSection.measures if m.stem == name)
            findings.add(where, f"the {joint}'s {name} limit is missing: give {one_of(keys)}")
        found.append(limits)
    return found


def _occupant(section: Any, base: OccupantBounds) -> OccupantBounds:
    """Return what the occupant may get: what the section says, the rest as the base has it."""
    if section is None:
        return base
    changes: dict[str, Any] = {}
    for name in _G_COMPONENTS:
        given = getattr(section, f"{name}_g")
        if given is not None:
            changes[name] = tuple(
                open_end if end is None else end
                for end, open_end in zip(given, UNBOUNDED, strict=True)
            )
    if section.g_onset_g_s is not None:
        changes["g_onset"] = section.g_onset_g_s
    if section.given("seat_angular_acceleration"):
        changes["angular_acceleration"] = section.si("seat_angular_acceleration")
    return replace(base, **changes)


def machine_mapping(machine: Machine) -> dict[str, Any]:
    """Return a machine as the mapping that ``machine:`` reads back.

    Lengths are in metres and angles in radians, so that the doubles are the
    same afterwards.
    """
    limits = {}
    for joint, bound in zip(JOINTS, machine.limits, strict=True):
        endless = math.isinf(bound.angle)
        limits[joint] = {
            **({"angle": "endless"} if endless else {"angle_rad": bound.angle}),
            "rate_rad_s": bound.rate,
            "acceleration_rad_s2": bound.acceleration,
            **({"jerk": "unlimited"} if math.isinf(bound.jerk) else {"jerk_rad_s3": bound.jerk}),
        }
    shown: dict[str, Any] = {"name": machine.name}
    if machine.source:
        shown["source"] = machine.source
    if machine.lengths:
        shown["lengths_m"] = dict(machine.lengths)
    shown["limits"] = limits
    if machine.occupant.bounded:
        shown["occupant"] = occupant_mapping(machine.occupant)
    shown["gravity_m_s2"] = machine.gravity
    shown["rows"] = [_row_mapping(row) for row in machine.rows]
    return shown


def occupant_mapping(occupant: OccupantBounds) -> dict[str, Any]:
    """Return bounds for the occupant as the mapping that ``occupant:`` reads back."""
    shown: dict[str, Any] = {}
    for name in _G_COMPONENTS:
        ends = getattr(occupant, name)
        if ends != UNBOUNDED:
            shown[f"{name}_g"] = [None if math.isinf(end) else end for end in ends]
    if not math.isinf(occupant.g_onset):
        shown["g_onset_g_s"] = occupant.g_onset
    if not math.isinf(occupant.angular_acceleration):
        shown["seat_angular_acceleration_rad_s2"] = occupant.angular_acceleration
    return shown


def _row_mapping(row: DHRow) -> dict[str, Any]:
    shown: dict[str, Any] = {
        key: value
        for key, value in (("alpha_rad", row.alpha), ("a_m", row.a), ("d_m", row.d))
        if value
    }
    if row.variable is None:
        return shown | ({"theta_rad": row.offset} if row.offset else {})
    sign = "-" if row.sign < 0 else ""
    offset = f" {'-' if row.offset < 0 else '+'} {abs(row.offset)!r}" if row.offset else ""
    return shown | {"theta": f"{sign}{row.variable}{offset}"}
