"""What is said of the columns of a file; each hint can be typed and costs no factor."""

from __future__ import annotations

import re
import shlex

import pytest

from des_cli.errors import Complaint
from des_cli.profiles_in.column_complaints import (
    check_missing,
    misspelt,
    nothing_to_fly,
    repeated,
    several_kinds,
    some,
    stands_often,
    unusable,
)
from des_cli.profiles_in.column_kinds import (
    ASKED_G,
    BODY_RATES,
    JOINT_COMMANDS,
    KINDS,
    QUANTITIES,
    Column,
    Kind,
)
from des_cli.profiles_in.csv_header import Header
from des_cli.profiles_in.unit_spelling import read_name


def header_of(*names: str, first: tuple[str, ...] = ()) -> Header:
    return Header("x.csv", [*names], "", 3, line=2, first=first)


def column(name: str, in_file: str = "") -> Column:
    own = read_name(name)
    return Column(own.stem, name, in_file or name, 0, own.unit, own.unit_text)


def missing(kind: Kind, header: Header) -> list[str]:
    """What is said against a file whose known names are its columns."""
    complaints: list[Complaint] = []
    found = [column(name) for name in header.names if read_name(name).stem in QUANTITIES]
    check_missing(header, kind, found, complaints)
    assert {complaint.where for complaint in complaints} <= {"x.csv:2"}
    return [complaint.what for complaint in complaints]


def typed(words: str) -> list[str]:
    """The option that a sentence says to type, as a shell takes it."""
    said = words[words.index("--column") :]
    return shlex.split(re.split(r" where | reads |\)$", said)[0])


def test_a_file_with_nothing_to_fly_is_told_every_kind_and_its_own_columns() -> None:
    words = nothing_to_fly(header_of("a", "", "b\x1b"))
    for kind in KINDS:
        assert f"{kind.words} ({kind.example})" in words
    assert words.endswith(r"there are a, 'b\x1b'; name those to read with --column NAME=HEADER")


def test_the_text_of_what_is_no_table_is_not_repeated() -> None:
    words = nothing_to_fly(header_of("root:x:0:0"))
    assert "root" not in words
    assert "--separator" in words


def test_of_several_kinds_the_quantities_that_are_there_are_told() -> None:
    found = [column(name) for name in ("r_rpm", "p_rpm", "fork_deg", "gz_g")]
    assert several_kinds([JOINT_COMMANDS, BODY_RATES], found) == (
        "holds both joint commands (fork) and body rates (p, r); choose with --column"
    )
    assert several_kinds([JOINT_COMMANDS, ASKED_G], found) == (
        "holds both joint commands (fork) and G (gz); choose with --column"
    )
    assert several_kinds([BODY_RATES, ASKED_G], found) == (
        "holds both body rates (p, r) and G (gz); choose with --column: "
        "p and q can be followed beside G, and no joint is left for r"
    )


@pytest.mark.parametrize(
    ("kind", "names", "words"),
    [
        (BODY_RATES, ["t_s", "p_rpm", "q_rpm", "r_rpm", "x"], []),
        (BODY_RATES, ["t_s", "p_rpm", "q_rpm"],
         ["a column is missing: r_rad_s, r_deg_s or r_rpm"]),
        (BODY_RATES, ["t_s", "p_rpm", "q_rpm", "yaw rate", "quality", ""],
         ["a column is missing: r_rad_s, r_deg_s or r_rpm",
          "1 column is not known: yaw rate; name those to read with --column NAME=HEADER"]),
        (JOINT_COMMANDS, ["t_s", "arm_rpm", "frok_deg", "cabb [rad]", "x"],
         ["the column frok_deg is not known (did you mean fork_deg?)",
          "the column cabb [rad] is not known (did you mean cab_rad?)"]),
        (JOINT_COMMANDS, ["t_s", "arm_rpm", "fork_rpm", "cab_deg"],
         ["the column fork_rpm: fork is an angle and needs its unit in the name: "
          "fork_rad or fork_deg, and rpm is none of them"]),
        # Where one of a kind is enough, only what is meant is asked for.
        (ASKED_G, ["t_s", "gz_g"], []),
        (ASKED_G, ["t_s", "gzz_g"], ["the column gzz_g is not known (did you mean gz_g?)"]),
        (ASKED_G, ["t_s", "gz_g", "gy_m"], []),
        (ASKED_G, ["t_s"], [f"a column is missing: {stem}_m_s2, {stem}_ft_s2 or {stem}_g"
                            for stem in ("gx", "gy", "gz")]),
    ],
)  # fmt: skip
def test_each_quantity_without_a_column_is_told_which_may_be_meant(
    kind: Kind, names: list[str], words: list[str]
) -> None:
    assert missing(kind, header_of(*names)) == words


@pytest.mark.parametrize("name", ["UTC", "UTC time", "it's"])
def test_a_column_of_clock_times_is_named_with_its_option(name: str) -> None:
    names = ("p_rpm", name, "q_rpm", "r_rpm", "unknown")
    (words,) = missing(BODY_RATES, header_of(*names, first=("1", "12:00:00.5", "2", "3", "4")))
    assert words.startswith("a column is missing: t_s, t_ms, t_us, t_ns or t_min; ")
    assert f"; {name} holds clock times: " in words
    assert typed(words) == ["--column", f"t={name}"]


@pytest.mark.parametrize(
    ("name", "stem", "right"),
    [
        ("FROK_DEG", "fork", "fork_deg"),
        ("frok [rad]", "fork", "fork_rad"),
        ("arn_rpm", "arm", "arm_rpm"),
        ("frok_rpm", "fork", None),  # no unit of an angle
        ("frok", "fork", None),  # none at all
        ("cab_deg", "fork", None),  # a name of its own
        ("g_g", "gx", None),  # too short to be near anything
        ("tilt_deg", "fork", None),
    ],
)
def test_a_misspelt_name_is_offered_in_its_own_unit_or_not_at_all(
    name: str, stem: str, right: str | None
) -> None:
    said = [f"the column {name} is not known (did you mean {right}?)"] if right else []
    assert misspelt(header_of("x", name), stem) == said


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("q0_rad", "the column q0_rad: q0 has no unit"),
        ("arm_m", "arm is a rate or an angle and needs its unit in the name: arm_rad_s, arm_deg_s"),
        ("t_h", "the column t_h: the unit h is not known; t is a time and needs its unit in the"),
        ("p_deg", "p_rad_s, p_deg_s or p_rpm, and deg is none of them"),
        ("gz", "(--column gz_m_s2=gz where it is in m_s2)"),
        ("p", "(--column p_rad_s=p where it is in rad/s)"),
        ("fork", "(--column fork_rad=fork where it is in rad)"),
    ],
)
def test_a_column_without_its_unit_is_told_what_it_needs(name: str, words: str) -> None:
    assert words in unusable(column(name))


@pytest.mark.parametrize("in_file", ["gyro x", "a;b", "x'y", "p"])
def test_the_option_for_a_name_without_a_unit_can_be_typed(in_file: str) -> None:
    assert typed(unusable(column("p", in_file))) == ["--column", f"p_rad_s={in_file}"]


def test_columns_of_one_quantity_are_chosen_between_unless_they_have_one_name() -> None:
    both = [column("p_rpm"), column("p_rad_s", "roll\trate")]
    assert repeated("p", both) == (
        r"p is given twice: p_rpm and 'roll\trate'; choose one with --column"
    )
    assert repeated("p", [column("p_rpm")] * 3) == stands_often("p_rpm", 3)
    assert stands_often("p_rpm", 3) == (
        "the column p_rpm stands 3 times; rename all but one in the file's header"
    )


def test_of_many_names_the_first_are_listed() -> None:
    assert some(["a", "b"], 2) == "a, b"
    assert some(["a", "", "b\n", "c"], 3) == r"a, 'b\n', …"
