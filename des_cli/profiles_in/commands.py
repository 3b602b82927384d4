"""Commands written as expressions, made into the commands of the model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from des_cli.model.arrays import Floats
from des_cli.model.motion import mean_of_sides
from des_cli.model.profile import BodyRates, JointCommands
from des_cli.profiles_in.caps import DEFAULT_CAPS
from des_cli.profiles_in.command_schema import Command
from des_cli.profiles_in.findings import Findings
from des_cli.profiles_in.sampling import (
    FINEST,
    LONGEST,
    MAX_WORK,
    SHORTEST_STEP,
    Piece,
    SamplingError,
    Sides,
    count_samples,
    first_jump,
    grid_with_joints,
    pieces_of,
    regular_grid,
    sample_middle,
    sample_sides,
)
from des_cli.profiles_in.sections import Measure, Section
from des_cli.profiles_in.wording import one_of
from des_cli.profiles_in.yaml_nodes import Step
from des_cli.units import Unit, split_unit

COMMAND: TypeAdapter[Any] = TypeAdapter(Command)

_GRID = ("start", "stop", "step")

_JUMP_TOLERANCE = 1e-9
"""A position jump that rounding explains, relative to 1 rad."""

_COVER_TOLERANCE = 1e-9
"""How far, in parts of 1 s or of the time, segments may miss the ends of the profile."""


def read_time(
    section: Section,
    findings: Findings,
    default: Mapping[str, float] | None = None,
    *,
    most_samples: int = DEFAULT_CAPS.rows,
) -> tuple[float, float, float] | None:
    """Return start, stop and step [s], or None after saying what is wrong.

    Parameters
    ----------
    section : Section
    findings : Findings
    default : mapping of str to float, optional
        What those are that are not given [s]; without it each must be.
    most_samples : int
    """
    default = default or {}
    known = len(findings.complaints)
    for measure in section.measures:
        if section.given(measure.stem) is None and measure.stem not in default:
            findings.add(["time"], f"{measure.title} is missing: give {one_of(measure.keys)}")
    if len(findings.complaints) > known:
        return None
    start, stop, step = (section.si(stem, default.get(stem, 0.0)) for stem in _GRID)
    if not stop > start:
        given = section.given_key("stop")
        least = section.written("start") if section.given_key("start") else f"{start:g} s"
        findings.add(["time", *([given] if given else [])], f"must be greater than {least}")
    if not step > 0:
        findings.add(["time", str(section.given_key("step"))], "must be greater than 0")
    if len(findings.complaints) > known:
        return None
    return checked_grid((start, stop, step), section, findings, most_samples)


def checked_grid(
    grid: tuple[float, float, float], section: Section | None, findings: Findings, most: int
) -> tuple[float, float, float] | None:
    """Return start, stop and step [s], or None after saying what no motion is sampled by."""
    start, stop, step = grid
    what = ""
    if stop - start > LONGEST:
        what = f"lasts longer than {LONGEST:g} s"
    elif step < SHORTEST_STEP:
        what = f"must be at least {SHORTEST_STEP:g} s"
    elif step < FINEST * max(abs(start), abs(stop)):
        what = "is too short to tell times of this size apart"
    elif count_samples(start, stop, step) > most:
        what = f"makes more than {most} samples; give a longer step, or --max-rows"
    if not what:
        return grid
    key = section.given_key("stop" if what.startswith("lasts") else "step") if section else None
    findings.add(["time", key] if key else (), what)
    return None


def read_commands(
    section: Section, name: str, time: tuple[float, float, float], findings: Findings
) -> tuple[Floats, JointCommands | BodyRates] | None:
    """Sample the commands of a ``joints`` or ``body_rates`` section.

    Parameters
    ----------
    section : Section
    name : {"joints", "body_rates"}
    time : tuple of float
        Start, stop and step [s].
    findings : Findings
        Takes what is wrong.

    Returns
    -------
    t, commands : (n,) array and JointCommands or BodyRates, or None
        None after saying what is wrong.
    """
    given = {
        measure.stem: (str(section.given_key(measure.stem)), section.given(measure.stem))
        for measure in section.measures
    }
    assert all(each for _, each in given.values()), "the schema asks for each"
    values = {stem: (key, each[0]) for stem, (key, each) in given.items() if each}
    return _read(values, name, time, findings)


def check_commands(
    measures: Sequence[Measure],
    values: Mapping[str, Any],
    name: str,
    time: tuple[float, float, float],
    findings: Findings,
) -> None:
    """Say what is wrong with the other commands of a section that the schema refused.

    Parameters
    ----------
    measures : sequence of Measure
        What the section holds.
    values : mapping
        The section as it stands in the file.
    name, time, findings
        As of `read_commands`.
    """
    right = {}
    for measure in measures:
        keys = [key for key in measure.keys if key in values]
        if len(keys) == 1:
            with suppress(ValidationError):
                right[measure.stem] = (keys[0], COMMAND.validate_python(values[keys[0]]))
    _read(right, name, time, findings)


def _read(
    values: Mapping[str, tuple[str, Any]],
    name: str,
    time: tuple[float, float, float],
    findings: Findings,
) -> tuple[Floats, JointCommands | BodyRates] | None:
    """Sample commands, given by their stem as their key and their value."""
    pieces: dict[str, tuple[Piece, ...]] = {}
    units: dict[str, Unit] = {}
    paths: dict[str, list[Step]] = {}
    for stem, (key, value) in values.items():
        parts, unit = pieces_of(value), split_unit(key)[1]
        assert unit is not None, "the keys of a measure have units"
        if covers(parts, time, [name, key], findings):
            pieces[stem], units[stem], paths[stem] = parts, unit, [name, key]
    if not pieces:
        return None
    t = grid_with_joints(
        regular_grid(*time), (piece.start for parts in pieces.values() for piece in parts)
    )
    if len(t) * sum(map(largest_size, pieces.values())) > MAX_WORK:
        findings.add([name], "takes too much arithmetic; give a longer step or simpler expressions")
        return None
    sample = _sample_joints if name == "joints" else sample_body_rates
    commands = sample(pieces, units, paths, t, findings)
    return None if commands is None else (t, commands)


def largest_size(pieces: tuple[Piece, ...]) -> int:
    """Return the operations of a command at a sample at the most: one piece covers it."""
    return max(piece.expression.size for piece in pieces)


def covers(
    pieces: tuple[Piece, ...],
    time: tuple[float, float, float],
    path: list[Step],
    findings: Findings,
) -> bool:
    """Tell whether segments reach from the start to the stop; say where they do not."""
    known = len(findings.complaints)
    start, stop, _ = time
    first, last = pieces[0], pieces[-1]
    slack = _COVER_TOLERANCE * max(1.0, abs(start), abs(stop))
    if first.start > start + slack:
        findings.add(
            [*path, 0],
            f"starts at {first.start:.12g} s and leaves the time from {start:.12g} s uncovered",
        )
    if last.stop < stop - slack:
        findings.add(
            [*path, len(pieces) - 1],
            f"ends at {last.stop:.12g} s and leaves the time to {stop:.12g} s uncovered",
        )
    return len(findings.complaints) == known


def _sides(
    stem: str,
    pieces: Mapping[str, tuple[Piece, ...]],
    units: Mapping[str, Unit],
    paths: Mapping[str, list[Step]],
    t: Floats,
    findings: Findings,
    *,
    rates: bool,
) -> Sides | None:
    try:
        return sample_sides(pieces[stem], t, units[stem].to_si, rates=rates)
    except SamplingError as error:
        findings.add(paths[stem], str(error))
        return None


def _sample_joints(
    pieces: Mapping[str, tuple[Piece, ...]],
    units: Mapping[str, Unit],
    paths: Mapping[str, list[Step]],
    t: Floats,
    findings: Findings,
) -> JointCommands | None:
    angles = [stem for stem in pieces if units[stem].quantity == "angle"]
    found = {
        stem: _sides(stem, pieces, units, paths, t, findings, rates=stem in angles)
        for stem in pieces
    }
    for stem, sides in found.items():
        jump = first_jump(sides, t, _JUMP_TOLERANCE) if sides and stem in angles else None
        if jump:
            at, before, after = (jump[0], *(value / units[stem].to_si for value in jump[1:]))
            unit = units[stem].suffix
            findings.add(
                _piece_path(paths[stem], pieces[stem], at),
                f"the position jumps at t = {at:.12g} s from {before:.12g} to {after:.12g} {unit}; "
                "no joint can follow: make both sides equal there",
            )
    arm, *both = (found.get(stem) for stem in ("arm", "fork", "cab"))
    if arm is None or not all(both) or findings.complaints:
        return None
    by_angle = "arm" in angles
    return JointCommands(
        arm_rate=_arm_rate_of_angle(arm) if by_angle else np.append(arm.start, arm.end[-1]),
        position=np.column_stack([np.append(each.start, each.end[-1]) for each in both if each]),
        rate_start=np.column_stack([each.rate_start for each in both if each]),
        rate_end=np.column_stack([each.rate_end for each in both if each]),
        arm_start=float(arm.start[0]) if by_angle else None,
    )


def _arm_rate_of_angle(arm: Sides) -> Floats:
    """Return the rate of an arm that is given by its angle, at every sample.

    A velocity command has one value a sample: where the rate steps the mean of both
    sides, with which the arm has turned as far before and after it.
    """
    return mean_of_sides(np.stack([arm.rate_start, arm.rate_end], axis=1))


def _piece_path(path: list[Step], pieces: tuple[Piece, ...], at: float) -> list[Step]:
    """Point at the segment that starts at a time, if one does."""
    for piece in pieces:
        if piece.index is not None and abs(piece.start - at) <= _COVER_TOLERANCE * max(1.0, at):
            return [*path, piece.index, "value"]
    return path


def sample_body_rates(
    pieces: Mapping[str, tuple[Piece, ...]],
    units: Mapping[str, Unit],
    paths: Mapping[str, list[Step]],
    t: Floats,
    findings: Findings,
) -> BodyRates | None:
    """Sample p, q and r on a grid (n,), or say what is wrong with them."""
    columns: list[tuple[Floats, Floats, Floats]] = []
    for stem in pieces:
        sides = _sides(stem, pieces, units, paths, t, findings, rates=False)
        if sides is None:
            continue
        try:
            middle = sample_middle(pieces[stem], t, units[stem].to_si)
        except SamplingError as error:
            findings.add(paths[stem], str(error))
            continue
        columns.append((sides.start, middle, sides.end))
    if len(columns) < 3:
        return None
    start, middle, end = (np.column_stack(list(parts)) for parts in zip(*columns, strict=True))
    return BodyRates(start, middle, end)
