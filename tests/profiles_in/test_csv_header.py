"""What stands above the numbers of a file, and on which line these start."""

import pytest

from des_cli.errors import ProfileError
from des_cli.profiles_in.csv_header import Header, is_comment, split_header
from des_cli.profiles_in.dialect import Dialect


def test_a_plain_header() -> None:
    assert split_header("a, b\n1,2\n3,4\n", "x") == Header(
        "x", ["a", "b"], "1,2\n3,4\n", 1, first=("1", "2")
    )


def test_all_that_may_stand_above_the_numbers() -> None:
    text = "sep=;\n# one\n\n// two\na;b;c\n% three\n[s];rad/s;\n# four\n0,5;1;2\n"
    header = split_header(text, "x", decimal=",")
    assert header.names == ["a", "b", "c"]
    assert (header.line, header.lines, header.text) == (5, 8, "0,5;1;2\n")
    assert header.dialect == Dialect(";", ",")
    assert header.units == ("[s]", "rad/s", "")
    assert header.first == ("0,5", "1", "2")
    assert header.remarks == ("line 7 is read as a row of units", "4 comment lines are skipped")


def test_a_name_over_two_lines_counts_both() -> None:
    header = split_header('a,"b\n#b",c\n1,2,3\n', "x")
    assert header.names == ["a", "b\n#b", "c"]
    assert header.lines == 2


@pytest.mark.parametrize(
    ("text", "names", "lines"),
    [
        ("# a,b\n1,2\n", ["a", "b"], 1),
        ("# a,b\n#\n", None, 0),  # comments alone are an empty file
        ("# one\n%a,b\n1,2\n", ["a", "b"], 2),
        ("# a,b,c\n1,2\n", None, 0),
        ("# 1,2\n1,2\n", None, 0),
        ("# a,b\n1,text\n", ["a", "b"], 1),
        ("# a,b\nc,d\n1,2\n", ["c", "d"], 2),
    ],
)
def test_a_comment_is_a_header_where_there_is_no_other(
    text: str, names: list[str] | None, lines: int
) -> None:
    if names is None:
        with pytest.raises(ProfileError, match="header"):
            split_header(text, "x")
        return
    header = split_header(text, "x")
    assert (header.names, header.lines) == (names, lines)


@pytest.mark.parametrize(
    ("second", "units"),
    [
        ("s,rad/s", ("s", "rad/s")),
        ("s,", ("s", "")),
        ("(ms),[furlong]", ("(ms)", "[furlong]")),
        ("1,rad/s", ()),
        ("furlong,mile", ()),
        ("12:00:00,s", ()),
    ],
)
def test_a_row_of_units_has_units_and_no_number(second: str, units: tuple[str, ...]) -> None:
    header = split_header(f"a,b\n{second}\n1,2\n", "x")
    assert header.units == units
    assert header.lines == (2 if units else 1)


def test_what_is_a_comment() -> None:
    assert all(map(is_comment, ("# a", "  % b", "// c", "#")))
    assert not any(map(is_comment, ("1,# a", "/ a", "", '"# a"')))
