"""A YAML profile, made into the model's ``Profile``."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from pydantic import ValidationError

from des_cli.errors import DesError, ProfileError
from des_cli.model.arrays import Floats
from des_cli.model.machine import JOINTS, Machine, Seat
from des_cli.model.profile import BodyRates, GCommand, JointCommands, Profile
from des_cli.profiles_in.caps import DEFAULT_CAPS, Caps
from des_cli.profiles_in.commands import check_commands, read_commands, read_time
from des_cli.profiles_in.conditioning import (
    Conditioning,
    check_smoothing,
    check_washout,
    read_conditioning,
    refuse_beside_expressions,
)
from des_cli.profiles_in.findings import Findings
from des_cli.profiles_in.g_commands import read_g
from des_cli.profiles_in.gaps import GapHandling
from des_cli.profiles_in.machine_yaml import (
    build_machine,
    is_machine_file,
    named_machine,
    parse_machine,
)
from des_cli.profiles_in.overrides import OPTION, apply_settings
from des_cli.profiles_in.profile_csv import parse_samples
from des_cli.profiles_in.record_checks import unfollowed_turning
from des_cli.profiles_in.reduction_section import read_reduction
from des_cli.profiles_in.referred import Referred
from des_cli.profiles_in.schema import BodyRates as BodyRatesSection
from des_cli.profiles_in.schema import Joints as JointsSection
from des_cli.profiles_in.schema import ProfileDocument, ProfileSettings
from des_cli.profiles_in.sections import Section
from des_cli.profiles_in.setting import AnySetting
from des_cli.profiles_in.source import decode, decode_table, label_of, read_source
from des_cli.profiles_in.wording import one_of
from des_cli.profiles_in.yaml_nodes import Node, parse_yaml

_COMMANDS = ("joints", "body_rates", "g", "samples")
_AnySection = TypeVar("_AnySection", bound=Section)
Commands = tuple[Floats, JointCommands | BodyRates | GCommand]


@dataclass
class Reading:
    """One profile while it is read.

    Parameters
    ----------
    label : str
        What messages call the file.
    folder : Path
        Where files stand that the profile refers to.
    digest : hashlib hash
        Takes the bytes of the profile and of every file that it refers to.
    conditioning : Conditioning
        What is done to recorded samples.
    gaps : GapHandling
        What is done where samples are missing.
    remarks : list of str
        Takes sentences for the user on what was done to read it.
    caps : Caps
        The most that is read.
    machine : Machine, optional
        As soon as it is known.
    files : list of Referred
        Takes the files that the profile refers to.
    """

    label: str
    folder: Path
    digest: Any
    conditioning: Conditioning = field(default_factory=Conditioning)
    gaps: GapHandling = field(default_factory=GapHandling)
    remarks: list[str] = field(default_factory=list)
    caps: Caps = DEFAULT_CAPS
    machine: Machine | None = None
    files: list[Referred] = field(default_factory=list)

    def referred(self, key: str, name: str, place: str) -> tuple[str, bytes]:
        """Return label and content of a file that the profile refers to.

        Parameters
        ----------
        key : str
            ``machine`` or ``samples.file``.
        name : str
        place : str
            Where it is named: a path in a profile starts at the profile's
            folder, one of an option at the current folder.
        """
        by_option = place.startswith(OPTION)
        path = Path(name) if by_option else self.folder / name
        label = label_of(path)
        data = read_source(path, label, self.caps.mib)
        self.digest.update(hashlib.sha256(data).digest())
        self.files.append(Referred(key, name, data, by_option))
        return label, data


def parse_profile(
    text: str, reading: Reading, name: str, settings: Sequence[AnySetting]
) -> Profile:
    """Read a YAML profile.

    Parameters
    ----------
    text : str
    reading : Reading
    name : str
        Used where the profile has none.
    settings : sequence of Setting or str

    Raises
    ------
    ProfileError
        With everything that is wrong with it.
    FileAccessError
        If a file that it refers to cannot be read and nothing else is wrong.
    """
    document, findings = parse_document(text, reading.label, settings)
    return finish(document, document_commands, reading, name, findings)


def parse_document(
    text: str, label: str, settings: Sequence[AnySetting]
) -> tuple[ProfileDocument, Findings]:
    """Read the sections of a YAML profile, before anything is made of them.

    Returns
    -------
    ProfileDocument, Findings
        What they say, and what is wrong with them.
    """
    root = parse_yaml(text, label)
    findings = Findings(root)
    if not isinstance(root.value, dict):
        findings.add((), "is not a profile: a profile is a mapping that starts with format:")
        findings.raise_if_any()
    findings.complaints += apply_settings(root, settings)
    return validated(ProfileDocument, findings), findings


def parse_settings(settings: Sequence[AnySetting], label: str) -> tuple[ProfileSettings, Findings]:
    """Read the settings of a profile that has only samples of its own.

    Returns
    -------
    ProfileSettings, Findings
        What the settings say, and what is wrong with them.
    """
    root = Node(label, {})
    findings = Findings(root)
    findings.complaints += apply_settings(root, settings)
    return validated(ProfileSettings, findings), findings


def validated(model: type[_AnySection], findings: Findings) -> _AnySection:
    """Return the sections of a document that are right, and say what is wrong.

    Members that fail are left out, so that the rest can be checked further.
    """
    data = findings.root.plain()
    try:
        return model.model_validate(data)
    except ValidationError as error:
        failed = findings.add_validation(error)
    rest = {key: value for key, value in data.items() if key not in failed}
    rest = {key: value for key, value in rest.items() if key in model.known_keys()}
    required = {"format": "des-coriolis/1"} if "format" in model.model_fields else {}
    return model.model_validate(required | rest)


def finish(
    document: ProfileSettings,
    commands_of: Callable[[Any, Reading, Findings], Commands | None],
    reading: Reading,
    name: str,
    findings: Findings,
) -> Profile:
    """Put a profile together from its sections, or raise with all that is wrong."""
    machine: Machine | None = None
    unread: DesError | None = None
    commands: Commands | None = None
    try:
        machine = read_machine(document, reading, findings)
    except DesError as error:
        unread = error
    reading.machine = machine
    reading.conditioning = read_conditioning(document, findings)
    reading.gaps.policy = document.gap
    try:
        commands = commands_of(document, reading, findings)
    except DesError as error:
        unread = error if unread is None else ProfileError([*unread.complaints, *error.complaints])
    if commands is not None:
        check_smoothing(reading.conditioning, commands[0], findings)
        check_washout(document.samples, commands[1], findings)
        if isinstance(commands[1], BodyRates) and (
            what := unfollowed_turning(commands[0], commands[1])
        ):
            findings.add((), what)
    reduction = read_reduction(document.reduction, findings)
    initial = read_initial(document.initial, commands, findings)
    if unread is not None and findings.complaints:
        findings.complaints += unread.complaints
    findings.raise_if_any()
    if unread is not None:
        raise unread
    assert machine is not None, "otherwise something was found"
    assert commands is not None, "otherwise something was found"
    if reading.gaps.parts > 1:
        name = f"{document.name or name}-{reading.gaps.part}"
        reading.remarks += later_start(reading.gaps, commands, initial)
    else:
        name = document.name or name
    return Profile(
        name=name,
        t=commands[0],
        command=commands[1],
        machine=machine,
        seat=read_seat(document.seat),
        initial_angle=initial,
        reduction=reduction,
        sha256=reading.digest.hexdigest(),
        smooth_cutoff_hz=reading.conditioning.cutoff_hz,
        remarks=tuple(reading.remarks),
    )


def read_machine(document: ProfileSettings, reading: Reading, findings: Findings) -> Machine | None:
    """Return the machine: built-in, from a file, or described in the profile."""
    choice: Any = document.machine
    if not isinstance(choice, str):
        return build_machine(choice, ("machine",), findings)
    if is_machine_file(choice):
        label, data = reading.referred("machine", choice, findings.root.place_of(["machine"]))
        return parse_machine(decode(data, label), label)
    return named_machine(choice, ("machine",), findings)


def read_seat(section: Any) -> Seat:
    """Return how the seat is fixed; the model's default where nothing is said."""
    default = Seat()
    if section is None:
        return default
    return Seat(yaw=section.si("yaw", default.yaw), pitch=section.si("pitch", default.pitch))


def read_initial(section: Any, commands: Commands | None, findings: Findings) -> Floats:
    """Return the joint angles at the first sample, (3,) [rad]."""
    given = [section.si(joint) if section is not None else 0.0 for joint in JOINTS]
    if commands is not None and not isinstance(commands[1], BodyRates):
        by_g = isinstance(commands[1], GCommand)
        leader = "the first G asks" if by_g else "its position command does"
        arm_start = commands[1].arm_start if isinstance(commands[1], JointCommands) else None
        for joint in JOINTS[1:] if arm_start is None else JOINTS:
            key = section.given_key(joint) if section is not None else None
            if key:
                words = f"the {joint} starts where {leader}; leave this out"
                findings.add(["initial", key], words, of_key=True)
        if arm_start is not None:
            given[0] = arm_start
    if commands is not None and isinstance(commands[1], JointCommands):
        given[1:] = commands[1].position[0].tolist()
    return np.array(given)


def later_start(handling: GapHandling, commands: Commands, initial: Floats) -> list[str]:
    """Return a remark on where a later stretch of body rates starts, which no row tells.

    Parameters
    ----------
    handling : GapHandling
        Of a record that gaps split.
    commands : tuple
        Times and commands of the stretch.
    initial : (3,) array
        Joint angles at its first sample [rad].
    """
    t, command = commands
    if not isinstance(command, BodyRates) or handling.part in (None, 1):
        return []
    angles = zip(JOINTS, np.degrees(initial), strict=True)
    start = ", ".join(f"{joint} {angle:.6g}" for joint, angle in angles)
    return [
        f"part {handling.part} starts from the profile's initial angles, {start} deg, as every "
        f"part does: where the machine stood otherwise, read this part alone by --trim "
        f"{t[0]:.12g}:{t[-1]:.12g} (or trim) with initial angles of its own"
    ]


def document_commands(
    document: ProfileDocument, reading: Reading, findings: Findings
) -> Commands | None:
    """Return times and commands of a YAML profile, or None after saying what is wrong."""
    present = findings.root.value
    assert isinstance(present, dict)
    # A section that was left out, or that the schema refused, is None.
    sections: dict[str, Any] = {name: getattr(document, name) for name in (*_COMMANDS, "time")}
    given = [name for name in _COMMANDS if name in present]
    if not given:
        findings.add((), f"has no commands: give {one_of(_COMMANDS)}")
    for name in given[1:]:
        findings.add([name], f"stands beside {given[0]}: keep one of them", of_key=True)
    if given[:1] == ["samples"]:
        if "time" in present:
            findings.add(["time"], "the times come from the samples: leave this out", of_key=True)
        return (
            None
            if sections["samples"] is None
            else _sampled(sections["samples"], reading, findings)
        )
    if given:
        refuse_beside_expressions(present, given[0], findings)
    if given == ["g"]:
        usable = sections["g"] is not None and ("time" not in present or sections["time"])
        if not usable:
            return None
        return read_g(sections["g"], sections["time"], findings, most_samples=reading.caps.rows)
    if "time" not in present:
        findings.add((), "time is missing: give time: {start_s: …, stop_s: …, step_s: …}")
    time = (
        None
        if sections["time"] is None
        else read_time(sections["time"], findings, most_samples=reading.caps.rows)
    )
    if time is None or len(given) != 1:
        return None
    section, name = sections[given[0]], given[0]
    if section is not None:
        return read_commands(section, name, time, findings)
    refused = present[name].plain()
    if isinstance(refused, dict):
        measures = (JointsSection if name == "joints" else BodyRatesSection).measures
        check_commands(measures, refused, name, time, findings)
    return None


def _sampled(section: Any, reading: Reading, findings: Findings) -> Commands:
    place = findings.root.place_of(["samples", "file"])
    label, data = reading.referred("samples.file", section.file, place)
    text, remarks = decode_table(data, label)
    reading.remarks += remarks
    return parse_samples(
        text,
        label,
        section.columns,
        separator=section.separator,
        decimal=section.decimal,
        conditioning=reading.conditioning,
        gaps=reading.gaps,
        remarks=reading.remarks,
        most_rows=reading.caps.rows,
        machine=reading.machine,
    )
