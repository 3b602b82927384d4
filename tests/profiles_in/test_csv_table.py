"""The numbers of a CSV file: the same from both readers, and each bad row by its line."""

from __future__ import annotations

import csv
import io
import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from des_cli.errors import ProfileError
from des_cli.profiles_in import csv_table
from des_cli.profiles_in.csv_header import split_header
from des_cli.profiles_in.csv_table import _LEFT_OUT as LEFT_OUT
from des_cli.profiles_in.csv_table import Rows, column_text, read_columns
from tests.support.hostile import NO_CELLS

JOINTS = "t_s,arm_rpm,fork_deg,cab_deg\n"


def read(text: str, *places: int) -> Rows:
    return read_columns(split_header(text, "x.csv"), places or range(4))


def problems_of(text: str, *places: int) -> list[str]:
    with pytest.raises(ProfileError) as caught:
        read(text, *places)
    return [str(problem) for problem in caught.value.complaints]


@settings(max_examples=60)
@given(
    st.lists(
        st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=3, max_size=3),
        min_size=1,
        max_size=8,
    )
)
def test_the_fast_and_the_careful_reader_read_the_same_doubles(rows: list[list[float]]) -> None:
    text = [["a", "b", "c"], *[[*map(repr, row)] for row in rows]]
    plain = "".join(",".join(row) + "\n" for row in text)
    spreadsheet = plain.replace(",", ";").replace(".", ",")
    stream = io.StringIO()
    csv.writer(stream, quoting=csv.QUOTE_ALL).writerows(text)
    expected = np.array(rows)[:, [2, 0]]
    for each, separator, decimal in (
        (plain, ",", "."),
        (plain.replace(",", " "), " ", "."),
        (spreadsheet, ";", ","),
        (stream.getvalue(), ",", "."),
        (spreadsheet.replace("\n", ";\n"), ";", ","),
    ):
        header = split_header(each, "x", separator, decimal)
        np.testing.assert_array_equal(read_columns(header, [2, 0]).values, expected)


def outcome(text: str) -> object:
    try:
        rows = read(text, 0, 1)
    except ProfileError as error:
        return [str(problem) for problem in error.complaints]
    return rows.values.tolist(), [*rows.lines]


@settings(max_examples=150)
@given(st.text(alphabet="01.e+- ,,\r\n\n", max_size=24))
def test_what_the_fast_reader_takes_the_careful_one_takes_too(body: str) -> None:
    text = f"a,b\n1,2\n{body}\n"
    # A comment is none of the fast reader's business.
    assert outcome(text) == outcome(f"{text}# end\n")


@pytest.mark.parametrize(
    ("body", "line", "words"),
    [
        ("0,1,2,3\n1,1,2\n", 3, "has 3 cells, the header has 4"),
        ("0,1,2,3\n1,1,2,3,4\n", 3, "has 5 cells, the header has 4"),
        ("0,1,2,3\n1,,2,3\n", 3, "arm_rpm: is missing; take out the rows"),
        (
            "0,1,2,3\n1,1,nan,3\n",
            3,
            "fork_deg: is nan; take out the rows without a number: a gap of",
        ),
        ("0,1,2,3\n1,1,inf,3\n", 3, "fork_deg: must be a number, is 'inf'"),
        ("0,1,2,3\n1,1,1e400,3\n", 3, "fork_deg: '1e400' is too large for a number"),
        ("0,1,2,3\n1,1,1_0,3\n", 3, "fork_deg: must be a number, is '1_0'"),
        ("0,1,2,3\n1,1,0x1p3,3\n", 3, "must be a number"),
        ("0,1,2,3\n1,1,2e,3\n", 3, "fork_deg: must be a number, is '2e'"),
        ("0,1,2,3\n1,1,1\u0662,3\n", 3, "must be a number"),
        ("0,1,2,3\n1,1,,\n", 3, "cab_deg: is missing"),
        ("0,1,2,3\n\n1,1,2,3\n", 3, "is a blank line between rows"),
        ('0,1,2,3\n1,1,"2,3\n', 3, "is not a CSV row"),
        ("0,1,2,3\n12:00:00,1,2,3\n", 3, "t_s: must be a number, is '12:00:00'"),
    ],
)
def test_a_bad_row_is_named_by_its_line(body: str, line: int, words: str) -> None:
    lines = problems_of(JOINTS + body)
    assert any(found.startswith(f"x.csv:{line}: ") and words in found for found in lines), lines


def test_a_quoted_line_break_keeps_the_count_of_lines() -> None:
    text = 't_s,arm_rpm,fork_deg,cab_deg,quality\n0,1,2,3,"a\nb"\n1,1,2,x,c\n'
    assert problems_of(text) == ["x.csv:4: cab_deg: must be a number, is 'x'"]


def test_rows_know_their_lines_past_comments_and_line_breaks_in_cells() -> None:
    text = '# top\na,b\n1,"x\n# no comment"\n# comment\n2,y\n% comment\n\n'
    header = split_header(text, "x")
    rows = read_columns(header, [0])
    assert [*rows.lines] == [3, 6]
    assert rows.values.tolist() == [[1], [2]]
    assert rows.comments == 2
    assert column_text(header, 1) == ["x\n# no comment", "y"]


def test_all_bad_cells_are_named_at_once_and_a_flood_is_counted() -> None:
    assert len(problems_of(JOINTS + "0,a,2,3\n1,1,b,3\n0.5,1,2,c\n")) == 3
    flood = problems_of(JOINTS + "".join(f"{k},x{k},y{k},z{k}\n" for k in range(200)))
    assert len(flood) < 40
    assert "570 more" in flood[-1]  # 600 cells are wrong, 30 are named


def test_what_is_wrong_alike_on_many_rows_is_one_line() -> None:
    assert problems_of(JOINTS + "".join(f"{k},1,-,3\n{k},1,2\n" for k in range(1000))) == [
        "x.csv:2: fork_deg: must be a number, is '-' (1000 rows like this)",
        "x.csv:3: has 3 cells, the header has 4 (1000 rows like this)",
    ]


def test_only_what_may_lack_becomes_not_a_number() -> None:
    header = split_header("a,b,c\n1,,NaN\n2, ,3\n", "x.csv")
    np.testing.assert_array_equal(
        read_columns(header, [2, 0, 1], may_lack=[1, 2]).values,
        [[np.nan, 1, np.nan], [3, 2, np.nan]],
    )
    with pytest.raises(ProfileError, match=r"^x\.csv:2: c: is nan; [^\n]*$"):
        read_columns(header, [2, 0, 1], may_lack=[1])


def test_only_the_clock_may_hold_times_of_day_and_its_text_is_kept() -> None:
    header = split_header("a,t\n1,12:00:00\n2,12:00:01.5\n", "x.csv")
    np.testing.assert_array_equal(
        read_columns(header, [1, 0], clock=1).values, [[np.nan, 1], [np.nan, 2]]
    )
    assert column_text(header, 1) == ["12:00:00", "12:00:01.5"]
    with pytest.raises(ProfileError, match="t: must be a number, is '12:00:00'"):
        read_columns(header, [1, 0], clock=0)


def test_what_is_in_a_column_that_nobody_reads_is_no_fault() -> None:
    values = read("a,note,b\n1,inf,2\n3,,4\n5,x,6\n", 0, 2).values
    assert values.tolist() == [[1, 2], [3, 4], [5, 6]]


def test_a_last_number_that_may_be_cut_is_refused_where_it_is_read() -> None:
    body = "0,1,2,3\n1,1,2,0.0125"
    whole = read(JOINTS + body + "\n")
    np.testing.assert_array_equal(whole.values[-1], [1, 1, 2, 0.0125])
    for cut in range(1, 5):
        (line,) = problems_of(JOINTS + body[:-cut])
        assert line.startswith("x.csv:3: cab_deg: the last line does not end")
        assert "end the line, or take it out" in line
    assert problems_of(JOINTS + body[:-6]) == ["x.csv:3: cab_deg: is missing; " + LEFT_OUT]
    (line,) = problems_of(JOINTS + body[:-7])
    assert line.startswith("x.csv:3: fork_deg: the last line does not end")
    np.testing.assert_array_equal(read(JOINTS + body, 0, 1, 2).values[-1], [1, 1, 2])
    assert len(read(JOINTS + body + "\n# end").values) == 2


def test_too_many_rows_are_refused_by_both_readers_before_they_are_read() -> None:
    text = "0,1,2,3\n1,1,2,3\n2,1,2,3\n"
    for body in (text, text + "x\n"):
        header = split_header(JOINTS + body, "x.csv")
        with pytest.raises(ProfileError, match=r"x\.csv: has more than 2 rows; --max-rows"):
            read_columns(header, [0, 1], most_rows=2)


@pytest.mark.parametrize("seed", range(4))
def test_arrow_reads_what_the_careful_reader_reads_or_nothing(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Cells of every spelling, quotes, blank and commented lines, in columns read and unread."""
    draw = random.Random(seed)
    good = ("1", "-2.5", "1e3", "1E-3", ".5", "5.", "007", "0.1234567890123456789", '"3.25"', " 4 ")
    odd = (
        *NO_CELLS,
        "+1",
        "#1",
        "2026-01-01",
        '"a,b"',
        '"1',
        '1"',
        '""',
        "\t1",
        "1\t",
        "\v1",
        "-0",
    )
    monkeypatch.setattr(csv_table, "LONG", 0)
    agreed = 0
    for _ in range(2000):
        rows = [[draw.choice(good) for _ in range(4)] for _ in range(draw.randint(1, 5))]
        for _ in range(draw.choice((0, 0, 1, 2))):
            draw.choice(rows)[draw.randrange(4)] = draw.choice(odd)
        lines = [",".join(row) for row in rows]
        if draw.random() < 0.1:
            added = draw.choice(("", " ", "#", "#1,2,3,4", ",,,"))
            lines.insert(draw.randrange(len(lines) + 1), added)
        if draw.random() < 0.1:
            lines[-1] += draw.choice((",", ",1", "\r", "\n\n"))
        header = split_header("t_s,a,b,c\n" + "\n".join(lines) + "\n", "log.csv")
        places = draw.sample(range(4), draw.randint(1, 4))
        fast = csv_table._read_fast(header, places)
        if fast is None:
            continue
        slow = csv_table._read_slowly(header, places, [False] * len(places), None, 100)
        np.testing.assert_array_equal(fast.values, slow.values)
        assert list(fast.lines) == list(slow.lines)
        assert slow.comments == 0
        agreed += 1
    assert agreed > 500
