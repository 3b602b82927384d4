"""What is wrong with a document: each with its place, in the order of the file, and bounded."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import pytest
from pydantic import BaseModel, Field, TypeAdapter, ValidationError

from des_cli.errors import Complaint, ProfileError
from des_cli.profiles_in.findings import MAX_COMPLAINTS, Findings, bounded
from des_cli.profiles_in.overrides import apply_settings
from des_cli.profiles_in.yaml_nodes import Step, parse_yaml

TEXT = """\
name: x
joints:
  arm_rpm:
    - {from_s: 0, to_s: 5}
    - {from_s: 5, to_s: 4}
"""


def lines_of(findings: Findings) -> list[str]:
    with pytest.raises(ProfileError) as caught:
        findings.raise_if_any()
    return [str(complaint) for complaint in caught.value.complaints]


def error_of(kind: Any, value: Any) -> ValidationError:
    with pytest.raises(ValidationError) as caught:
        TypeAdapter(kind).validate_python(value)
    return caught.value


def test_nothing_wrong_raises_nothing() -> None:
    Findings(parse_yaml(TEXT, "x")).raise_if_any()


def test_problems_come_once_each_in_the_order_of_the_file_and_options_last() -> None:
    root = parse_yaml("".join(f"k{n}: 1\n" for n in range(1, 11)) + TEXT, "x:9")
    assert apply_settings(root, ["seat.yaw_deg=1"]) == []
    findings = Findings(root)
    segment: list[Step] = ["joints", "arm_rpm", 1]
    paths: list[list[Step]] = [
        ["seat", "yaw_deg"], [*segment, "to_s"], ["k9"], [*segment, "from_s"], ["k9"], ["k10"]
    ]  # fmt: skip
    for path in paths:
        findings.add(path, "is wrong")
    findings.add([*segment, "to_s"], "is unknown", of_key=True)
    assert lines_of(findings) == [
        "x:9:9:5: k9: is wrong",
        "x:9:10:6: k10: is wrong",
        "x:9:15:16: joints.arm_rpm[1].from_s: is wrong",
        "x:9:15:19: joints.arm_rpm[1].to_s: is unknown",
        "x:9:15:25: joints.arm_rpm[1].to_s: is wrong",
        "--set seat.yaw_deg=1: seat.yaw_deg: is wrong",
    ]


def test_a_problem_of_the_whole_document_has_no_name() -> None:
    findings = Findings(parse_yaml(TEXT, "x"))
    findings.add([], "is wrong")
    assert lines_of(findings) == ["x:1:1: is wrong"]


class Segment(BaseModel):
    from_s: float = Field(strict=True)
    to_s: Annotated[float, Field(gt=4.5)]
    value: float


def test_what_the_schema_finds_stands_at_its_place_in_the_document() -> None:
    root = parse_yaml(TEXT, "x")
    path: list[Step] = ["joints", "arm_rpm"]
    findings = Findings(root)
    segments = root.plain()["joints"]["arm_rpm"]
    failed = findings.add_validation(error_of(list[Segment], segments), path)
    assert failed == {0, 1}
    assert lines_of(findings) == [
        "x:4:7: joints.arm_rpm[0].value: is missing",
        "x:5:7: joints.arm_rpm[1].value: is missing",
        "x:5:25: joints.arm_rpm[1].to_s: must be greater than 4.5, is 4",
    ]


def test_a_key_that_the_schema_refuses_is_pointed_at_itself() -> None:
    findings = Findings(parse_yaml("budget: {a: 3}\n", "x"))
    failed = findings.add_validation(error_of(dict[Literal["b", "c"], int], {"a": 3}), ["budget"])
    assert failed == {"a"}
    assert lines_of(findings) == ["x:1:10: budget.a: must be b or c, is 'a'"]


@pytest.mark.parametrize(
    ("kind", "value", "words"),
    [
        (Annotated[float, Field(strict=True)], "2", "must be a number, is '2'"),
        (float, "x", "must be a number, is 'x'"),
        (float, [], "must be a number"),
        (int, 1.5, "must be a whole number, is 1.5"),
        (str, 5, "must be text, is 5"),
        (list[int], 3, "must be a list, is 3"),
        (list[int], {}, "must be a list"),
        (dict[str, int], None, "must be a mapping, is None"),
        (Annotated[float, Field(allow_inf_nan=False)], float("nan"),
         "must be a finite number, is nan"),
        (Literal["arm", "fork", "cab"], "frok",
         "must be arm, fork or cab, is 'frok' (did you mean fork?)"),
        (Literal["arm"], 3, "must be arm, is 3"),
        (Annotated[float, Field(gt=0)], -1.0, "must be greater than 0, is -1"),
        (Annotated[float, Field(ge=0.5)], 0.25, "must be at least 0.5, is 0.25"),
        (Annotated[float, Field(le=1e12)], 1e13, "must be at most 1e+12, is 1e+13"),
        (Annotated[list[int], Field(min_length=3)], [1, 2], "must have at least 3 items, has 2"),
        (Annotated[list[int], Field(max_length=1)], [1, 2], "must have at most 1 items, has 2"),
        (Annotated[str, Field(min_length=1)], "", "must not be empty"),
        (Annotated[str, Field(max_length=3)], "long", "must have at most 3 characters"),
    ],
)  # fmt: skip
def test_what_the_schema_finds_is_said_in_a_person_s_words(
    kind: Any, value: Any, words: str
) -> None:
    findings = Findings(parse_yaml("a: 1\n", "x"))
    assert findings.add_validation(error_of(kind, value), ["a"]) == {""}
    assert lines_of(findings) == [f"x:1:4: a: {words}"]


def test_more_than_a_person_would_read_is_counted_and_repetitions_are_not() -> None:
    complaints = [Complaint("x", f"is wrong {k}") for k in range(MAX_COMPLAINTS + 3)]
    assert bounded(complaints[:MAX_COMPLAINTS] * 2) == complaints[:MAX_COMPLAINTS]
    assert bounded(complaints) == [
        *complaints[:MAX_COMPLAINTS], Complaint("", "… and 3 more problems")
    ]  # fmt: skip
