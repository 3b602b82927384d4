"""What a YAML profile may hold: the contract of ``docs/formats.md`` as a model."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, Discriminator, Field, Tag, TypeAdapter
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
from des_cli.profiles_in.conditioning_schema import (
    BodyAxes,
    EulerOrder,
    Resample,
    Smooth,
    Trim,
)
from des_cli.profiles_in.dialect import parse_decimal, parse_separator
from des_cli.profiles_in.expression import Expression, ExpressionError, parse_expression
from des_cli.profiles_in.g_schema import WASHOUT_TIME, g_section
from des_cli.profiles_in.gaps import GapPolicy
from des_cli.profiles_in.machine_schema import DEFAULT_MACHINE, MachineSection
from des_cli.profiles_in.sections import OMITTED, Measure, Number, Section, fault, measured
from des_cli.profiles_in.wording import shown
from des_cli.units import suffixes

_NAME = re.compile(r"\w([\w .,+()-]{0,98}[\w)+])?")


def _check_name(name: str) -> str:
    if not _NAME.fullmatch(name):
        raise fault(
            "must be 1 to 100 letters, digits, spaces and . , + - _ ( ), "
            f"for a folder is named after it; it is {shown(name)}"
        )
    return name


def _parse(text: str) -> Expression:
    try:
        return parse_expression(text)
    except ExpressionError as error:
        raise fault(str(error)) from None


def _in_words(parse: Callable[[str], str]) -> Callable[[str], str]:
    """Return a parser whose ValueError is a sentence for the user."""

    def check(text: str) -> str:
        try:
            return parse(text)
        except ValueError as error:
            raise fault(f"{error}, is {shown(text)}") from None

    return check


def kind_of(value: Any) -> str | None:
    """Tell numbers, text and lists apart, so that each is checked as what it is."""
    if isinstance(value, bool):
        return None
    kinds = {int: "<number>", float: "<number>", str: "<text>", list: "<list>", dict: "<mapping>"}
    return kinds.get(type(value))


def _choice(words: str) -> Discriminator:
    return Discriminator(
        kind_of,
        custom_error_type="profile",
        custom_error_message="{words}",
        custom_error_context={"words": f"must be {words}"},
    )


ExpressionText = Annotated[
    str,
    Field(strict=True, description="arithmetic in t, the profile's time in seconds"),
    AfterValidator(_parse),
]
Constant = Annotated[
    Annotated[Number, Tag("<number>")] | Annotated[ExpressionText, Tag("<text>")],
    _choice("a number or an expression in t"),
]

_FROM = Measure("from", "time", "the start of a segment")
_TO = Measure("to", "time", "the end of a segment")
Segment = measured(
    "Segment",
    "One stretch of a command, from and to a profile time.",
    (_FROM, _TO),
    value=(Constant, Field(description="number or expression in t, in the unit of the command")),
)


def _check_segments(segments: list[Any]) -> list[Any]:
    if not segments:
        raise fault("is an empty list: give at least one segment")
    for index, segment in enumerate(segments):
        start, stop = segment.si("from"), segment.si("to")
        if not stop > start:
            where = (index, segment.given_key("to"))
            raise fault(f"must be greater than {segment.written('from')}", where)
        if index and not _same_time(start, previous := segments[index - 1].si("to")):
            kind = "a gap" if start > previous else "an overlap"
            raise fault(
                f"leaves {kind}: it must be where the previous segment ends ({previous:.12g} s)",
                (index, segment.given_key("from")),
            )
    return segments


def _same_time(a: float, b: float) -> bool:
    return abs(a - b) <= 1e-9 * max(1.0, abs(a), abs(b))


_Number = Annotated[Number, Tag("<number>")]
_Text = Annotated[ExpressionText, Tag("<text>")]
_Segments = Annotated[list[Segment], AfterValidator(_check_segments), Tag("<list>")]  # type: ignore[valid-type]
Command = Annotated[
    _Number | _Text | _Segments,
    _choice("a number, an expression in t, or a list of segments {from_s, to_s, value}"),
]

Seat = measured(
    "Seat",
    "How the seat is fixed in the cab.",
    (
        Measure("yaw", "angle", "the seat's yaw", required=False),
        Measure("pitch", "angle", "the seat's pitch-back", required=False),
    ),
)
Initial = measured(
    "Initial",
    "Joint angles at the start; with joint commands only the arm's.",
    tuple(
        Measure(joint, "angle", f"the {joint}'s initial angle", required=False)
        for joint in ("arm", "fork", "cab")
    ),
)
Time = measured(
    "Time",
    "The grid of profile times.",
    (
        # read_time asks for each, unless onsets of G make the times
        Measure("start", "time", "the first time", required=False),
        Measure("stop", "time", "the last time", required=False),
        Measure("step", "time", "the time between samples", required=False),
    ),
)
ARM_ANGLES = tuple(f"arm_{suffix}" for suffix in suffixes("angle"))
"""Keys that give the arm by its angle instead of its rate."""

Joints = measured(
    "Joints",
    "A velocity (or angle) command for the arm, position commands for the fork and the cab.",
    (
        Measure("arm", "rate", "the arm's rate or angle", others=ARM_ANGLES),
        Measure("fork", "angle", "the fork's angle"),
        Measure("cab", "angle", "the cab's angle"),
    ),
    Command,
)
BodyRates = measured(
    "BodyRates",
    "Roll, pitch and yaw rate of the seat, in seat axes.",
    (
        Measure("p", "rate", "the roll rate p"),
        Measure("q", "rate", "the pitch rate q"),
        Measure("r", "rate", "the yaw rate r"),
    ),
    Command,
)
G = g_section(_Number | _Text | _Segments, Command)


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


class SamplesReadingBase(Section):
    """Keys of how samples are read that have no unit."""

    euler: EulerOrder = OMITTED
    separator: Separator = OMITTED
    decimal: Decimal = OMITTED


SamplesReading = measured(
    "SamplesReading",
    "How the samples of a CSV file are read.",
    (WASHOUT_TIME,),
    Annotated[Number, Field(gt=0, le=1e12)],
    base=SamplesReadingBase,
)


class Samples(SamplesReading):  # type: ignore[misc, valid-type]
    """Commands recorded in a CSV file beside the profile."""

    file: Annotated[str, Field(strict=True, min_length=1)]
    columns: dict[str, Annotated[str, Field(strict=True)]] = Field(
        default_factory=dict, description="our name, with its unit: name in the file's header"
    )


Positive = Annotated[Number, Field(gt=0, le=1e12)]
NotNegative = Annotated[Number, Field(ge=0, le=1e12)]
Three = Field(min_length=3, max_length=3)


_each_joint = _choice("a number, or one for each of arm, fork and cab")
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


def _budget_kind(value: Any) -> str | None:
    if isinstance(value, dict):
        return "<by metric>"
    return None if isinstance(value, list) else "<number>"


Budget = Annotated[
    Annotated[Positive, Tag("<number>")]
    | Annotated[
        dict[MetricKey, Positive],
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


class ReductionBase(Section):
    """Keys of a reduction without a unit."""

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


ReductionSection = measured(
    "ReductionSection",
    "How to reduce the Coriolis; what is left out keeps its default.",
    (
        Measure("lead_in", "time", "the time to ramp from rest to the start", required=False),
        Measure("lead_out", "time", "the time to ramp from the end to rest", required=False),
    ),
    NotNegative,
    base=ReductionBase,
)


MachineChoice = Annotated[
    Annotated[str, Field(strict=True, min_length=1), Tag("<text>")]
    | Annotated[MachineSection, Tag("<mapping>")],  # type: ignore[valid-type]
    _choice("a machine's name, the path of a machine file, or a mapping"),
]


class ProfileSettings(Section):
    """What a profile says beside its commands."""

    elsewhere: ClassVar[Mapping[str, str]] = {
        "g": "is for profiles in YAML; what belongs to a recorded G, such as washout_s, is below "
        "samples"
    }
    name: Annotated[str, Field(strict=True), AfterValidator(_check_name)] = OMITTED
    machine: MachineChoice = DEFAULT_MACHINE
    seat: Seat = OMITTED  # type: ignore[valid-type]
    initial: Initial = OMITTED  # type: ignore[valid-type]
    samples: SamplesReading = OMITTED  # type: ignore[valid-type]
    gap: GapPolicy = OMITTED
    trim: Trim = OMITTED  # type: ignore[valid-type]
    axes: BodyAxes = OMITTED
    resample: Resample = OMITTED  # type: ignore[valid-type]
    smooth: Smooth = OMITTED
    reduction: ReductionSection = OMITTED  # type: ignore[valid-type]


class ProfileDocument(ProfileSettings):
    """A maneuver profile of des-coriolis."""

    format: Literal["des-coriolis/1"]
    seat: Seat = OMITTED  # type: ignore[valid-type]
    initial: Initial = OMITTED  # type: ignore[valid-type]
    time: Time = OMITTED  # type: ignore[valid-type]
    joints: Joints = OMITTED  # type: ignore[valid-type]
    body_rates: BodyRates = OMITTED  # type: ignore[valid-type]
    g: G = OMITTED  # type: ignore[valid-type]
    samples: Samples = OMITTED
    trim: Trim = OMITTED  # type: ignore[valid-type]
    resample: Resample = OMITTED  # type: ignore[valid-type]
    reduction: ReductionSection = OMITTED  # type: ignore[valid-type]


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
