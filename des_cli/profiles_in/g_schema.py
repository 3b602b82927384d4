"""The ``g:`` section of a YAML profile: G against time, as centrifuge users write it."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, Discriminator, Field, Tag

from des_cli.profiles_in.command_schema import Command, NumberKind, SegmentsKind, TextKind
from des_cli.profiles_in.sections import OMITTED, Measure, Number, Section, fault

G_STEMS = ("gx", "gy", "gz")
RATE_STEMS = ("p", "q")

MOST_G = 100.0
"""Largest component of an asked G [g]: beyond any machine with a person in it."""

NotNegative = Annotated[Number, Field(ge=0, le=1e12)]
Positive = Annotated[Number, Field(gt=0, le=1e12)]
GValue = Annotated[Number, Field(ge=-MOST_G, le=MOST_G)]

Washout = Annotated[Positive, Measure("time", "the washout time of the rates")]

_WORDS = (
    "a number, an expression in t, a list of segments {from_s, to_s, value}, or a list of onsets "
    "{hold_g, hold_s}, {to_g, onset_g_s, hold_s}"
)


class Onset(Section):
    """The G at the start and how long it holds, or a ramp at a constant onset and a hold."""

    hold_g: GValue = Field(default=OMITTED, description="the G at the start; of the first alone")
    to_g: GValue = Field(default=OMITTED, description="the G that the ramp leads to")
    onset_g_s: Positive = Field(default=OMITTED, description="how fast, up or down [g/s]")
    hold_s: NotNegative = Field(default=OMITTED, description="how long it then holds [s]")


def _check_onsets(onsets: list[Onset]) -> list[Onset]:
    first, *rest = onsets
    if first.hold_g is None:
        raise fault("starts from nowhere: give {hold_g, hold_s} first", (0,))
    if first.to_g is not None or first.onset_g_s is not None:
        raise fault("is a hold and a ramp in one: give {hold_g, hold_s}, then the ramp", (0,))
    if first.hold_s is None:
        raise fault("does not say how long: give hold_s", (0,))
    level = first.hold_g
    for index, onset in enumerate(rest, 1):
        if onset.hold_g is not None:
            words = "holds the G at the start, of the first alone; give to_g and onset_g_s"
            raise fault(words, (index, "hold_g"), of_key=True)
        if onset.to_g is None or onset.onset_g_s is None:
            raise fault("is not a whole ramp: give to_g and onset_g_s", (index,))
        if onset.to_g == level:
            words = f"is the G that was there before ({level:g} g): lengthen that hold"
            raise fault(words, (index, "to_g"))
        level = onset.to_g
    if not rest and first.hold_s == 0:
        raise fault("lasts no time: give a longer hold_s, or a ramp", (0, "hold_s"))
    return onsets


def _kind(value: Any) -> str | None:
    """Tell onsets from segments, and a number from text."""
    if isinstance(value, bool):
        return None
    if isinstance(value, list):
        own = set(Onset.model_fields)
        onsets = any(isinstance(each, dict) and own & set(each) for each in value)
        return "<onsets>" if onsets else "<list>"
    return {int: "<number>", float: "<number>", str: "<text>"}.get(type(value))


GComponent = Annotated[
    Annotated[list[Onset], AfterValidator(_check_onsets), Tag("<onsets>")]
    | NumberKind
    | TextKind
    | SegmentsKind,
    Discriminator(
        _kind,
        custom_error_type="profile",
        custom_error_message="{words}",
        custom_error_context={"words": f"must be {_WORDS}"},
    ),
]


class G(Section):
    """The G-vector that the pilot is to feel, in his signs, and perhaps rates beside it."""

    p: Annotated[Command, Measure("rate", "the roll rate p")] = OMITTED
    q: Annotated[Command, Measure("rate", "the pitch rate q")] = OMITTED
    gx_g: Annotated[GComponent, Field(description="asked Gx")] = OMITTED
    gy_g: Annotated[GComponent, Field(description="asked Gy")] = OMITTED
    gz_g: Annotated[GComponent, Field(description="asked Gz")] = OMITTED
    washout: Washout = OMITTED
