"""What is told of a curve: aligned columns, and why there is nothing."""

from dataclasses import replace

from des_cli.cli.tradeoff_text import point_line, points_text
from tests.support.trade_points import GONE, POINT

TURNING = ("α error", "α rms", "α peak")


def test_text_is_aligned_and_says_why_there_is_nothing() -> None:
    lines = points_text(
        [POINT, replace(POINT, value=0.1, objective_reduction=None), GONE], "cobra"
    ).splitlines()
    heads, first, second = lines[4:7]
    ends = [heads.index(word) + len(word) for word in ("objective", "seat x", "joints")]
    assert [first[:end].split()[-2:] for end in ends] == [
        ["50.0", "%"],
        ["-25.0", "%"],
        ["5.0", "%"],
    ]
    assert second[: ends[0]].endswith("not known")
    assert "α at the seat [rad/s²], before 0.462 rms and 0.539 peak" in lines[1]
    assert [first[: heads.index(word) + len(word)].split()[-1] for word in TURNING] == [
        "0.143",
        "0.447",
        "0.561",
    ]
    assert point_line(POINT).endswith(
        "50.0 % less at joints 5.0 %, seat rate 20.0 %, α 0.447 rad/s² rms"
    )
    assert lines[-1].endswith("1  iteration-limit: too few steps")
    assert point_line(GONE) == "scalar, r2 1: iteration-limit: too few steps"


def test_a_table_that_is_wider_than_the_terminal_goes_on_below() -> None:
    whole = points_text([POINT, GONE], "cobra").splitlines()
    narrow = points_text([POINT, GONE], "cobra", 80).splitlines()
    assert all(len(line) <= 80 for line in narrow)
    assert " ".join(narrow).count("limits  status") == 1
    heads = [line.split() for line in narrow if line.split()[:1] == ["budget"]]
    assert [each[1] for each in heads] == ["objective", "joints", "turn"]
    assert [word for each in heads for word in each[1:]] == whole[4].split()[1:]
    values = [line.split()[1:] for line in narrow if line.split()[:1] == [f"{POINT.value:g}"]]
    assert [word for each in values for word in each] == whole[5].split()[1:]
    assert sum("too few steps" in line for line in narrow) == 1
    assert points_text([POINT, GONE], "cobra", 300).splitlines() == whole
