"""Commands as a profile gives them: numbers, expressions in t, and lists of segments."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, Discriminator, Field, Tag

from des_cli.profiles_in.expression import Expression, ExpressionError, parse_expression
from des_cli.profiles_in.sections import OMITTED, Measure, Number, Section, fault


def _parse(text: str) -> Expression:
    try:
        return parse_expression(text)
    except ExpressionError as error:
        raise fault(str(error)) from None


def kind_of(value: Any) -> str | None:
    """Tell numbers, text and lists apart, so that each is checked as what it is."""
    if isinstance(value, bool):
        return None
    kinds = {int: "<number>", float: "<number>", str: "<text>", list: "<list>", dict: "<mapping>"}
    return kinds.get(type(value))


def choice(words: str) -> Discriminator:
    """Return what picks a kind of value, or says in words which there are."""
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
    choice("a number or an expression in t"),
]


class Segment(Section):
    """One stretch of a command, from and to a profile time."""

    from_: Annotated[Number, Measure("time", "the start of a segment", required=True)] = OMITTED
    to: Annotated[Number, Measure("time", "the end of a segment", required=True)] = OMITTED
    value: Annotated[
        Constant, Field(description="number or expression in t, in the unit of the command")
    ]


def _check_segments(segments: list[Segment]) -> list[Segment]:
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


NumberKind = Annotated[Number, Tag("<number>")]
TextKind = Annotated[ExpressionText, Tag("<text>")]
SegmentsKind = Annotated[list[Segment], AfterValidator(_check_segments), Tag("<list>")]
Command = Annotated[
    NumberKind | TextKind | SegmentsKind,
    choice("a number, an expression in t, or a list of segments {from_s, to_s, value}"),
]
