"""What a profile may say about the conditioning of its samples."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias, get_args

from pydantic import Field

from des_cli.profiles_in.sections import OMITTED, Measure, Number, Section

Direction: TypeAlias = Literal["x", "y", "z", "-x", "-y", "-z"]
EulerOrder: TypeAlias = Literal["xyz", "xzy", "yxz", "yzx", "zxy", "zyx"]
"""Axes about which the body turns one after another, each already turned by those before."""

EULER_ORDERS: tuple[EulerOrder, ...] = get_args(EulerOrder)

_Positive = Annotated[Number, Field(gt=0, le=1e12)]


class Trim(Section):
    """The part of a record that is flown."""

    from_: Annotated[Number, Measure("time", "the first time kept")] = OMITTED
    to: Annotated[Number, Measure("time", "the last time kept")] = OMITTED


class Resample(Section):
    """A uniform grid in the place of the recorded times."""

    step: Annotated[_Positive, Measure("time", "the time between samples", required=True)] = OMITTED


class BodyAxes(Section):
    """Along which of the recorder's axes the seat's axes point."""

    p: Direction
    q: Direction
    r: Direction


class Smooth(Section):
    """A zero-phase low-pass over the record, before it is reduced."""

    cutoff_hz: Annotated[_Positive, Field(description="where the amplitude is halved [Hz]")]
