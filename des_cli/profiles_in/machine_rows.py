"""The chain of a machine's section: from named lengths, from rows of its own, or its base's."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from des_cli.model.machine import JOINTS, DHRow, Machine
from des_cli.model.machines import CHAIN_LENGTHS, gimballed_centrifuge_rows, read_chain
from des_cli.profiles_in.findings import Findings
from des_cli.profiles_in.machine_schema import split_angle, split_signed_length
from des_cli.profiles_in.wording import did_you_mean, plain
from des_cli.profiles_in.yaml_nodes import Step

UNCHAINED = "L1"
"""A length of the study's Table 1 that no row of its Table 2 has."""

_SAME = 1e-9
"""Relative difference up to which a length and a number in a row are the same."""


@dataclass(frozen=True)
class Chain:
    """The rows of a machine, and the named lengths [m] that belong to them."""

    rows: tuple[DHRow, ...]
    lengths: dict[str, float]


def read_chain_of_section(
    section: Any, base: Machine | None, path: Sequence[Step], findings: Findings
) -> Chain | None:
    """Return the chain that a machine's section describes.

    Parameters
    ----------
    section : MachineSection
    base : Machine, optional
        What its ``base`` names, if there is such a machine.
    path : sequence of str or int
        Where the section stands in the document.
    findings : Findings
        Takes what is wrong.

    Returns
    -------
    Chain or None
        None after saying what is wrong.
    """
    given = section.given("lengths")
    own = {name: value * given[1].to_si for name, value in given[0].items()} if given else {}
    lengths = (dict(base.lengths) if base else {}) | own
    if section.rows is not None:
        return _of_rows(section, own, lengths, path, findings)
    if base and not given and section.fork_axis is None:
        return Chain(base.rows, lengths)
    if section.base is not None and base is None:
        return None
    return _of_lengths(section, base, own, lengths, path, findings)


def _of_lengths(
    section: Any,
    base: Machine | None,
    own: Mapping[str, float],
    lengths: dict[str, float],
    path: Sequence[Step],
    findings: Findings,
) -> Chain | None:
    key = section.given_key("lengths")
    missing = [name for name in CHAIN_LENGTHS if name not in lengths]
    if missing:
        findings.add(
            [*path, key] if key else path,
            f"the length{'s' * (len(missing) > 1)} {', '.join(missing)} must be given "
            "(or rows, or base: des)",
        )
        return None
    for name in own:
        if name not in (*CHAIN_LENGTHS, UNCHAINED):
            hint = did_you_mean(name, CHAIN_LENGTHS) or f"; there are {', '.join(CHAIN_LENGTHS)}"
            findings.add([*path, str(key), name], f"is not a length of the chain{hint}")
    known = read_chain(base.rows) if base else None
    if base and known is None:
        findings.add([*path, "base"], "its chain is not one of named lengths: give rows")
        return None
    axis = section.fork_axis or (known[1] if known else "radial")
    return Chain(gimballed_centrifuge_rows(lengths, fork_axis=axis), lengths)


def _of_rows(
    section: Any,
    own: Mapping[str, float],
    lengths: Mapping[str, float],
    path: Sequence[Step],
    findings: Findings,
) -> Chain:
    """Read own rows; of the base's lengths only those that a row names are the machine's."""
    if section.fork_axis is not None:
        findings.add([*path, "fork_axis"], "says nothing beside rows: leave one of them out")
    rows = _own_rows(section.rows, lengths, [*path, "rows"], findings)
    named = _names(section.rows)
    if own:
        where = [*path, str(section.given_key("lengths"))]
        _check_lengths(own, named, rows, where, findings)
    return Chain(rows, {n: v for n, v in lengths.items() if n in own or n in named})


def _names(rows: Sequence[Any]) -> set[str]:
    """Return the lengths that rows name: ``Lx`` of ``a: -Lx``."""
    texts = [text for row in rows for text in (row.a, row.d) if text is not None]
    return {split_signed_length(text)[1] for text in texts}


def _check_lengths(
    own: Mapping[str, float],
    named: set[str],
    rows: Sequence[DHRow],
    path: Sequence[Step],
    findings: Findings,
) -> None:
    """Say which lengths the rows do not follow, in one line.

    Rows of numbers are what the machine is made of, whatever the lengths beside them say:
    whoever changes a length there means to change the machine.
    """
    chain = read_chain(rows)
    held = chain[0] if chain else {}
    numbers = [abs(number) for row in rows for number in (row.a, row.d)]
    other, absent = [], []
    for name, length in own.items():
        if name in named or name == UNCHAINED:
            continue
        if name in held:
            if not math.isclose(length, held[name], rel_tol=_SAME):
                other.append(f"{plain(name)} {held[name]:.6g} m instead of {length:.6g} m")
        elif not any(math.isclose(length, number, rel_tol=_SAME) for number in numbers):
            absent.append(f"no {plain(name)} of {length:.6g} m")
    if other or absent:
        remedy = "take the rows out" if chain else "name the length in a row, as in a: Lx"
        findings.add(path, f"the rows have {', '.join([*other, *absent])}: {remedy}")


def _own_rows(
    rows: Sequence[Any], lengths: Mapping[str, float], path: Sequence[Step], findings: Findings
) -> tuple[DHRow, ...]:
    made = []
    for index, row in enumerate(rows):
        where = [*path, index]
        variable, sign, offset = None, 1, row.si("theta")
        if row.theta is not None:
            variable, sign, offset = split_angle(row.theta)
        made.append(
            DHRow(
                alpha=row.si("alpha"),
                a=_length(row, "a", lengths, where, findings),
                d=_length(row, "d", lengths, where, findings),
                offset=offset,
                variable=variable,
                sign=sign,
            )
        )
    _check_chain(made, path, findings)
    return tuple(made)


def _length(
    row: Any, key: str, lengths: Mapping[str, float], path: Sequence[Step], findings: Findings
) -> float:
    named = getattr(row, key)
    if named is None:
        return float(row.si(key))
    sign, name = split_signed_length(named)
    if name not in lengths:
        hint = did_you_mean(name, lengths)
        findings.add([*path, key], f"the length {name} is not among the lengths given{hint}")
        return 0.0
    return sign * lengths[name]


def _check_chain(rows: Sequence[DHRow], path: Sequence[Step], findings: Findings) -> None:
    """Say where the joints are not arm, fork and cab, once each and in this order."""
    joints = [row.variable for row in rows if row.variable in JOINTS]
    for joint in JOINTS:
        count = joints.count(joint)
        if count != 1:
            times = "in no row" if count == 0 else f"in {count} rows"
            findings.add(path, f"the {joint} turns {times}; it must turn exactly one")
    if sorted(map(str, joints)) == sorted(JOINTS) and tuple(joints) != JOINTS:
        findings.add(
            path,
            f"the joints stand in the order {', '.join(map(str, joints))}; "
            "from the ground outward they are arm, fork, cab",
        )
    last_joint = max((i for i, row in enumerate(rows) if row.variable in JOINTS), default=-1)
    for index, row in enumerate(rows):
        if row.variable and row.variable not in JOINTS and index < last_joint:
            findings.add(
                [*path, index], f"{row.variable} turns before the cab; the seat sits in the cab"
            )
