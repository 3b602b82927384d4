"""What a YAML profile may hold: the contract of ``docs/formats.md`` as a model."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag, TypeAdapter
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue

from des_cli.model.machine import Joint
from des_cli.model.metric import STUDY_METRIC, MetricKey
from des_cli.model.profile import (
    Algorithm,
    Axes,
    Control,
    Ends,
    FreeParameter,
    JacobianAt,
    LimitsPolicy,
    Method,
    Objective,
)
from des_cli.profiles_in.command_schema import Command, choice
from des_cli.profiles_in.conditioning_schema import (
    BodyAxes,
    EulerOrder,
    Resample,
    Smooth,
    Trim,
)
from des_cli.profiles_in.dialect import parse_decimal, parse_separator
from des_cli.profiles_in.g_schema import G, Washout
from des_cli.profiles_in.gaps import GapPolicy
from des_cli.profiles_in.machine_schema import DEFAULT_MACHINE, MachineSection
from des_cli.profiles_in.sampling import MAX_MAGNITUDE
from des_cli.profiles_in.sections import OMITTED, Measure, Number, Section, fault
from des_cli.profiles_in.wording import shown
from des_cli.units import suffixes

_NAME = re.compile(r"\w([\w .,+()-]{0,98}[\w)+])?")
_NAME_BYTES = 200
"""A folder's name has room for 255, and what is added while it is built."""

_RESERVED = re.compile(r"(con|prn|aux|nul|(com|lpt)[0-9¹²³])(?: *\..*)?", re.IGNORECASE)


def check_name(name: str) -> str:
    """Return a profile's name if a folder may be named after it; else raise `fault`'s error."""
    if not _NAME.fullmatch(name) or len(name.encode()) > _NAME_BYTES:
        raise fault(
            "must be 1 to 100 letters, digits, spaces and . , + - _ ( ), "
            f"for a folder is named after it; it is {shown(name)}"
        )
    if is_reserved(name):
        raise fault(f"is a device and no folder on Windows: {shown(name)}")
    return name


def is_reserved(name: str) -> bool:
    """Whether Windows takes a name for a device, in whatever case and with any ending."""
    return _RESERVED.fullmatch(name) is not None


def _in_words(parse: Callable[[str], str]) -> Callable[[str], str]:
    """Return a parser whose ValueError is a sentence for the user."""

    def check(text: str) -> str:
        try:
            return parse(text)
        except ValueError as error:
            raise fault(f"{error}, is {shown(text)}") from None

    return check


Angle = Annotated[Number, Field(ge=-MAX_MAGNITUDE, le=MAX_MAGNITUDE)]
"""In any unit: the sine of a larger one has no digits that mean something."""


class Seat(Section):
    """How the seat is fixed in the cab."""

    yaw: Annotated[Angle, Measure("angle", "the seat's yaw")] = OMITTED
    pitch: Annotated[Angle, Measure("angle", "the seat's pitch-back")] = OMITTED


class Initial(Section):
    """Joint angles at the start; with joint commands only the arm's."""

    arm: Annotated[Angle, Measure("angle", "the arm's initial angle")] = OMITTED
    fork: Annotated[Angle, Measure("angle", "the fork's initial angle")] = OMITTED
    cab: Annotated[Angle, Measure("angle", "the cab's initial angle")] = OMITTED


class Time(Section):
    """The grid of profile times."""

    # read_time asks for each, unless onsets of G make the times
    start: Annotated[Number, Measure("time", "the first time")] = OMITTED
    stop: Annotated[Number, Measure("time", "the last time")] = OMITTED
    step: Annotated[Number, Measure("time", "the time between samples")] = OMITTED


ARM_ANGLES = tuple(f"arm_{suffix}" for suffix in suffixes("angle"))
"""Keys that give the arm by its angle instead of its rate."""


class Joints(Section):
    """A velocity (or angle) command for the arm, position commands for the fork and the cab."""

    arm: Annotated[
        Command, Measure("rate", "the arm's rate or angle", required=True, others=ARM_ANGLES)
    ] = OMITTED
    fork: Annotated[Command, Measure("angle", "the fork's angle", required=True)] = OMITTED
    cab: Annotated[Command, Measure("angle", "the cab's angle", required=True)] = OMITTED


class BodyRates(Section):
    """Roll, pitch and yaw rate of the seat, in seat axes."""

    p: Annotated[Command, Measure("rate", "the roll rate p", required=True)] = OMITTED
    q: Annotated[Command, Measure("rate", "the pitch rate q", required=True)] = OMITTED
    r: Annotated[Command, Measure("rate", "the yaw rate r", required=True)] = OMITTED


Separator = Annotated[
    str,
    Field(strict=True, description="what stands between the columns: , ; | tab or space"),
    AfterValidator(_in_words(parse_separator)),
]
Decimal = Annotated[
    str,
    Field(strict=True, description="the decimal sign: . or ,"),
    AfterValidator(_in_words(parse_decimal)),
]


class SamplesReading(Section):
    """How the samples of a CSV file are read."""

    euler: EulerOrder = OMITTED
    separator: Separator = OMITTED
    decimal: Decimal = OMITTED
    washout: Washout = OMITTED


class Samples(SamplesReading):
    """Commands recorded in a CSV file beside the profile."""

    file: Annotated[str, Field(strict=True, min_length=1)]
    columns: dict[str, Annotated[str, Field(strict=True)]] = Field(
        default_factory=dict, description="our name, with its unit: name in the file's header"
    )


Positive = Annotated[Number, Field(gt=0, le=1e12)]
NotNegative = Annotated[Number, Field(ge=0, le=1e12)]
Three = Field(min_length=3, max_length=3)


_each_joint = choice("a number, or one for each of arm, fork and cab")
PositiveEach = Annotated[
    Annotated[Positive, Tag("<number>")] | Annotated[list[Positive], Three, Tag("<list>")],
    _each_joint,
]
NotNegativeEach = Annotated[
    Annotated[NotNegative, Tag("<number>")] | Annotated[list[NotNegative], Three, Tag("<list>")],
    _each_joint,
]


def _row_kind(value: Any) -> str | None:
    rows = isinstance(value, list) and any(isinstance(row, list) for row in value)
    return "<matrix>" if rows else "<diagonal>" if isinstance(value, list) else None


Weight = Annotated[
    Annotated[list[NotNegative], Three, Tag("<diagonal>")]
    | Annotated[list[Annotated[list[Number], Three]], Three, Tag("<matrix>")],
    Discriminator(
        _row_kind,
        custom_error_type="profile",
        custom_error_message="{words}",
        custom_error_context={"words": "must be 3 numbers, or 3 rows of 3"},
    ),
]


def _refuse_percent(value: Any) -> Any:
    """Say how a percentage is written in a file, where the unit of a number is in its key."""
    if isinstance(value, str) and value.endswith("%"):
        raise fault(f"must be a number, is {shown(value)}; a share of 5 % is written 0.05")
    return value


Most = Annotated[Number, Field(ge=1e-9, le=1e12), BeforeValidator(_refuse_percent)]
"""Of a budget: a smaller one is rounding, and its square need not be a number."""


def _budget_kind(value: Any) -> str | None:
    if isinstance(value, dict):
        return "<by metric>"
    return None if isinstance(value, list) else "<number>"


Budget = Annotated[
    Annotated[Most, Tag("<number>")]
    | Annotated[
        dict[MetricKey, Most],
        Field(min_length=1),
        Tag("<by metric>"),
    ],
    Discriminator(
        _budget_kind,
        custom_error_type="profile",
        custom_error_message="{words}",
        custom_error_context={"words": "must be a number, or metrics with a number each"},
    ),
    Field(description=f"largest {STUDY_METRIC}, or fidelity metrics and their limits"),
]


def _check_unequal(names: list[str]) -> list[str]:
    for index, name in enumerate(names):
        if name in names[:index]:
            raise fault(f"names {name} twice", (index,))
    return names


class ReductionSection(Section):
    """How to reduce the Coriolis; what is left out keeps its default."""

    method: Method = OMITTED
    algorithm: Algorithm = OMITTED
    control: Control = OMITTED
    axes: Axes = OMITTED
    jacobian: JacobianAt = OMITTED
    r1: Weight = OMITTED
    r2: PositiveEach = OMITTED
    tracking: NotNegativeEach = OMITTED
    budget: Budget = OMITTED
    limits: LimitsPolicy = OMITTED
    iterations: Annotated[int, Field(strict=True, ge=1, le=10_000)] = OMITTED
    max_iterations: Annotated[int, Field(strict=True, ge=1, le=1_000_000)] = OMITTED
    hold: list[Joint] = OMITTED
    ends: Ends = OMITTED
    objective: Objective = OMITTED
    optimise: Annotated[list[FreeParameter], AfterValidator(_check_unequal)] = OMITTED
    allow_change: Annotated[
        Positive,
        Field(description="share of the recorded seat rate or G that may change first"),
    ] = OMITTED
    tolerance: Positive = OMITTED
    lead_in: Annotated[NotNegative, Measure("time", "the time to ramp from rest to the start")] = (
        OMITTED
    )
    lead_out: Annotated[NotNegative, Measure("time", "the time to ramp from the end to rest")] = (
        OMITTED
    )


MachineChoice = Annotated[
    Annotated[str, Field(strict=True, min_length=1), Tag("<text>")]
    | Annotated[MachineSection, Tag("<mapping>")],
    choice("a machine's name, the path of a machine file, or a mapping"),
]


class ProfileSettings(Section):
    """What a profile says beside its commands."""

    elsewhere: ClassVar[Mapping[str, str]] = {
        "g": "is for profiles in YAML; what belongs to a recorded G, such as washout_s, is below "
        "samples"
    }
    name: Annotated[str, Field(strict=True), AfterValidator(check_name)] = OMITTED
    machine: MachineChoice = DEFAULT_MACHINE
    seat: Seat = OMITTED
    initial: Initial = OMITTED
    samples: SamplesReading = OMITTED
    gap: GapPolicy = OMITTED
    trim: Trim = OMITTED
    axes: BodyAxes = OMITTED
    resample: Resample = OMITTED
    smooth: Smooth = OMITTED
    reduction: ReductionSection = OMITTED


class ProfileDocument(ProfileSettings):
    """A maneuver profile of des-coriolis."""

    format: Literal["des-coriolis/1"]
    seat: Seat = OMITTED
    initial: Initial = OMITTED
    time: Time = OMITTED
    joints: Joints = OMITTED
    body_rates: BodyRates = OMITTED
    g: G = OMITTED
    samples: Samples = OMITTED
    trim: Trim = OMITTED
    resample: Resample = OMITTED
    reduction: ReductionSection = OMITTED


class _Schema(GenerateJsonSchema):
    """A schema without the None that stands for a key left out."""

    def default_schema(self, schema: Any) -> JsonSchemaValue:
        """Leave out a default of None."""
        found = super().default_schema(schema)
        if found.get("default", ...) is None:
            found.pop("default")
        return found


def profile_json_schema() -> dict[str, Any]:
    """Return the JSON Schema of a YAML profile, for editors and checkers."""
    schema = TypeAdapter(ProfileDocument).json_schema(schema_generator=_Schema)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}
