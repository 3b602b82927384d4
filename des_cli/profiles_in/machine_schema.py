"""What the description of a machine may hold, in a profile or in a file of its own."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import AfterValidator, Field

from des_cli.model.machine import Variable
from des_cli.profiles_in.expression import ExpressionError, parse_expression
from des_cli.profiles_in.sections import OMITTED, Measure, Number, Section, fault
from des_cli.profiles_in.wording import shown

DEFAULT_MACHINE = "des"
"""What a profile that names no machine is for."""

VARIABLES: tuple[Variable, ...] = ("arm", "fork", "cab", "seat_yaw", "seat_pitch")

_ONE_TIME = np.zeros(1)
_LENGTH_NAME = re.compile(r"([+-]?)\s*([A-Za-z]\w{0,19})")
_ANGLE = re.compile(rf"([+-]?)\s*({'|'.join(VARIABLES)})\b\s*(.*)", re.DOTALL)

Positive = Annotated[Number, Field(gt=0, le=1e6)]
NotNegative = Annotated[Number, Field(ge=0, le=1e6)]
Text = Annotated[str, Field(strict=True, min_length=1)]


def split_signed_length(text: str) -> tuple[float, str]:
    """Split ``-Lx`` into its sign and the name of the length.

    Raises
    ------
    PydanticCustomError
        If it is no name with an optional sign.
    """
    match = _LENGTH_NAME.fullmatch(text.strip())
    if not match:
        raise fault(f"must be a named length such as Lx or -Lx, is {shown(text)}")
    return (-1.0 if match[1] == "-" else 1.0), match[2]


def split_angle(text: str) -> tuple[Variable | None, int, float]:
    """Split ``-arm + pi/2`` into the variable, its sign and the offset [rad].

    Raises
    ------
    PydanticCustomError
        If it is not a variable, an angle in radians, or their sum.
    """
    match = _ANGLE.fullmatch(text.strip())
    variable: Variable | None = match[2] if match else None  # type: ignore[assignment]
    sign = -1 if match and match[1] == "-" else 1
    rest = match[3].strip() if match else text
    if match and not rest:
        return variable, sign, 0.0
    if match and rest[0] not in "+-":
        raise fault(f"must be a joint, an angle, or their sum, is {shown(text)}")
    try:
        offset = float(parse_expression(rest, variable=False).at(_ONE_TIME)[0][0])
    except ExpressionError:
        words = f"must be {', '.join(VARIABLES)} (with - before), an angle in radians such as "
        raise fault(f"{words}pi/2, or their sum; is {shown(text)}") from None
    if not abs(offset) < 1e6:
        raise fault(f"holds an angle that is no plain number: {shown(text)}")
    return variable, sign, offset


def _checked(check: Any) -> AfterValidator:
    def validate(text: str) -> str:
        check(text)
        return text

    return AfterValidator(validate)


LengthName = Annotated[str, Field(strict=True), _checked(split_signed_length)]
AngleText = Annotated[str, Field(strict=True), _checked(split_angle)]


class Row(Section):
    """One row of the modified Denavit-Hartenberg table."""

    alpha: Annotated[Number, Measure("angle", "the twist alpha")] = OMITTED
    a_number: Annotated[Number, Measure("length", "the length a", others=("a",), stem="a")] = (
        OMITTED
    )
    d_number: Annotated[Number, Measure("length", "the offset d", others=("d",), stem="d")] = (
        OMITTED
    )
    theta_number: Annotated[
        Number, Measure("angle", "the turn theta", others=("theta",), stem="theta")
    ] = OMITTED
    a: Annotated[LengthName, Field(description="a named length: Lx or -Lx")] = OMITTED
    d: Annotated[LengthName, Field(description="a named length: Lx or -Lx")] = OMITTED
    theta: Annotated[AngleText, Field(description="-arm, seat_yaw, pi/2, arm + pi/2")] = OMITTED


class JointLimits(Section):
    """What a joint may do, in both directions."""

    angle_number: Annotated[
        Positive, Measure("angle", "the angle limit", others=("angle",), stem="angle")
    ] = OMITTED
    rate: Annotated[Positive, Measure("rate", "the rate limit")] = OMITTED
    acceleration: Annotated[Positive, Measure("acceleration", "the acceleration limit")] = OMITTED
    jerk_number: Annotated[
        Positive, Measure("jerk", "the jerk limit", others=("jerk",), stem="jerk")
    ] = OMITTED
    angle: Annotated[Literal["endless"], Field(description="a joint without end stops")] = OMITTED
    jerk: Annotated[Literal["unlimited"], Field(description="a joint without a jerk limit")] = (
        OMITTED
    )


class LimitsSection(Section):
    """Limits joint by joint."""

    arm: JointLimits = OMITTED
    fork: JointLimits = OMITTED
    cab: JointLimits = OMITTED


def _check_interval(bounds: list[float | None]) -> list[float | None]:
    least, most = bounds
    if least is None and most is None:
        raise fault("bounds nothing: leave it out")
    if least is not None and most is not None and not least < most:
        raise fault(f"must be [least, most], the least below the most; is {shown(bounds)}")
    return bounds


Interval = Annotated[
    list[Number | None],
    Field(min_length=2, max_length=2, description="[least, most] in g; null for an open end"),
    AfterValidator(_check_interval),
]


class Occupant(Section):
    """What the person in the seat may get."""

    gx_g: Interval = OMITTED
    gy_g: Interval = OMITTED
    gz_g: Interval = OMITTED
    g_onset_g_s: Annotated[
        Positive, Field(description="largest rate of change of a component of the G-vector")
    ] = OMITTED
    seat_angular_acceleration: Annotated[
        Positive, Measure("acceleration", "the seat's largest total angular acceleration")
    ] = OMITTED


class MachineSection(Section):
    """A centrifuge: named lengths or rows, limits, bounds for the occupant, gravity."""

    name: Annotated[Text, Field(max_length=100)] = OMITTED
    base: Text = OMITTED
    fork_axis: Literal["radial", "tangential"] = OMITTED
    limits: LimitsSection = OMITTED
    occupant: Occupant = OMITTED
    rows: Annotated[list[Row], Field(min_length=3, max_length=100)] = OMITTED
    source: Annotated[str, Field(strict=True, max_length=2000)] = OMITTED
    gravity: Annotated[Positive, Measure("specific_force", "gravity", described=False)] = OMITTED
    lengths: Annotated[
        dict[str, NotNegative], Measure("length", "the lengths", described=False)
    ] = OMITTED
