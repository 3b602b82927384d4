"""Which columns are read, what is said about the others, and that no hint costs a factor."""

import re

import pytest

from des_cli.errors import Complaint
from des_cli.profiles_in.column_kinds import JOINTS, RATES
from des_cli.profiles_in.columns import choose_columns
from des_cli.profiles_in.csv_header import split_header

RADIANS = "p_rad_s,q_rad_s,r_rad_s"


def choose(
    names: str, below: str = "", **named: str
) -> tuple[dict[str, tuple[str, str]], list[str], list[str]]:
    """Return header and unit by stem, the problems, and the remarks."""
    count = names.count(",") + 1
    header = split_header(f"{names}\n{below}" + ",".join("0" * count) + "\n", "x")
    problems: list[Complaint] = []
    remarks: list[str] = []
    found = choose_columns(header, named, problems, remarks)
    chosen = {c.stem: (c.in_file, c.unit.suffix if c.unit else "") for c in found}
    assert all(problem.where.startswith("x:") for problem in problems)
    return chosen, [problem.what for problem in problems], remarks


@pytest.mark.parametrize(
    ("names", "read", "remark"),
    [
        (f"t_s,{RADIANS},x", ("t", *RATES), "1 column is not read: x"),
        (f"t_s,{RADIANS},x,x,,", ("t", *RATES), "2 columns are not read: x, x"),
        (f"t_s,{RADIANS},quality,", ("t", *RATES), None),
        # the part of the joints that is there is not what is asked for, and the other way round
        (f"t_s,{RADIANS},fork_deg,arm_deg", ("t", *RATES), "not read: fork_deg, arm_deg"),
        ("t_s,arm_rpm,fork_deg,cab_deg,p_rad_s", ("t", *JOINTS), "not read: p_rad_s"),
        (f"q0,q1,q2,q3,t_s,{RADIANS}", ("q0", "q1", "q2", "q3", "t", *RATES), None),
        (f"q0,q1,q2,q3,q3,t_s,{RADIANS}", ("t", *RATES), "5 columns are not read"),
        # a contract's name goes before another spelling, and what has a unit before what has none
        (f"Time [ms],t_s,{RADIANS}", ("t", *RATES), "1 column is not read: Time [ms]"),
        (f"t,t_ns,{RADIANS},p", ("t", *RATES), "2 columns are not read: t, p"),
    ],
)
def test_other_columns_are_left_alone_once_all_is_there(
    names: str, read: tuple[str, ...], remark: str | None
) -> None:
    chosen, problems, remarks = choose(names)
    assert problems == []
    assert tuple(chosen) == read
    assert [remark is not None and remark in each for each in remarks] == [True] * bool(remark)


def test_who_names_all_columns_need_not_be_told_about_the_others() -> None:
    assert choose("t_s,a,b,c,d", p_rad_s="a", q_dps="b", r_rpm="c") == (
        {"t": ("t_s", "s"), "p": ("a", "rad_s"), "q": ("b", "deg_s"), "r": ("c", "rpm")},
        [],
        [],
    )


def test_a_name_without_a_unit_takes_that_of_the_header_or_of_the_row_of_units() -> None:
    names = "time (us),gyro x (°/s),gy_rad/s,gz,p_rad_s"
    chosen, problems, remarks = choose(
        names, "us,deg/s,,rpm,rad/s\n", p="gyro x (°/s)", q="gy_rad/s", r="gz"
    )
    assert (problems, remarks) == ([], [])
    assert [unit for _, unit in chosen.values()] == ["us", "deg_s", "rad_s", "rpm"]
    assert "needs its unit" in choose("t_s,gx,gy,gz", p="gx", q="gy", r="gz")[1][0]


def test_a_name_with_a_unit_has_the_word_and_the_difference_is_told() -> None:
    chosen, problems, remarks = choose(f"t_s,{RADIANS}", p_deg_s="p_rad_s")
    assert chosen["p"] == ("p_rad_s", "deg_s")
    assert problems == []
    assert remarks == ["p_rad_s is read in deg_s, as p_deg_s says, and not in rad_s"]
    _, _, remarks = choose("t_s,x,q_rad_s,r_rad_s", "s,rad/s,rad/s,rad/s\n", p_deg_s="x")
    assert remarks == ["x is read in deg_s, as p_deg_s says, and the row of units says rad_s"]


@pytest.mark.parametrize(
    ("names", "named", "words"),
    [
        ("t_s,arm_rpm,frok_deg,cab_deg", {}, ["frok_deg is not known (did you mean fork_deg?)"]),
        ("t_s,arm_rpm,fork_deg,CABB [rad]", {}, ["(did you mean cab_rad?)"]),
        ("t_s,arm_rpm,fork_deg,x", {}, ["is missing: cab_rad", "1 column is not known: x; name"]),
        ("t_s,p_rad_s,p_rad_s,q_rad_s,r_rad_s", {}, ["the column p_rad_s stands 2 times"]),
        ("t_s,p_rad_s,p_rpm,q_rad_s,r_rad_s", {}, ["p is given twice: p_rad_s and p_rpm; choose"]),
        ("t_s,x,x,q_rad_s,r_rad_s", {"p_rad_s": "x"}, ["the column x stands 2 times"]),
        (f"{RADIANS},t", {}, ["t is a time and needs its unit in the name: t_s, t_ms, t_us, t_ns"]),
        (f"{RADIANS},t_h", {}, ["the unit h is not known; t is a time and needs"]),
        ("t_s,p_mrad_s,q_rad_s,r_rad_s", {}, ["the unit mrad_s is not known; p is a rate"]),
        ("t_s,p_rad,q_rad_s,r_rad_s", {}, ["p_rad_s, p_deg_s or p_rpm, and rad is none of them"]),
        (f"t_s,arm_rpm,fork_deg,cab_deg,{RADIANS}", {}, ["both joint commands (arm, fork, cab)"]),
        ("t_s,fork_deg,p_rad_s", {}, ["both joint commands (fork) and body rates (p); choose"]),
        ("t_s,a", {}, ["has neither joint commands"]),
        (
            f"t_s,{RADIANS}",
            {"frok_deg": "t_s"},
            ["name frok_deg is not known (did you mean fork_d"],
        ),
        (f"t_s,{RADIANS}", {"p_rad_s": "p_red_s"}, ["no column p_red_s (did you mean p_rad_s?)"]),
    ],
)
def test_what_is_missing_is_named(names: str, named: dict[str, str], words: list[str]) -> None:
    _, problems, _ = choose(names, **named)
    assert len(problems) == len(words)
    for problem, expected in zip(problems, words, strict=True):
        assert expected in problem


def test_joints_and_rates_in_one_file_are_chosen_by_a_name() -> None:
    both = f"t_s,arm_rpm,fork_deg,cab_deg,{RADIANS}"
    assert [*choose(both, p_rad_s="p_rad_s")[0]] == ["t", *RATES]
    assert [*choose(both, cab_deg="cab_deg")[0]] == ["t", *JOINTS]


def test_many_unknown_columns_are_one_complaint() -> None:
    _, problems, _ = choose("t_s,p_rad_s," + ",".join(f"c{k}" for k in range(52)))
    assert len(problems) == 3
    assert problems[2].startswith("52 columns are not known: c0, c1,")
    assert len(problems[2]) < 150


@pytest.mark.parametrize(
    ("names", "named"),
    [
        ("t_s,p_mdps,q_mrad_s,r_krpm", {}),
        ("t_hs,p_rad_s,q_rad_s,r_rad_s", {}),
        ("tt_ns,p_rad_s,q_rad_s,r_rad_s", {}),
        ("t_s,frok_deg,arn_deg,cab_rpm", {}),
        ("t_s,p_deg_s,q_deg_s,r_deg_s", {"p_rad_s": "p_rad_s"}),
        ("t_ns,p_rad_s,q_rad_s,r_rad_s", {"t_s": "t_s"}),
    ],
)
def test_no_hint_changes_a_unit(names: str, named: dict[str, str]) -> None:
    _, problems, _ = choose(names, **named)
    assert problems
    for problem in problems:
        hint = re.search(
            r"the column \w+?_(\w+) is not known \(did you mean \w+?_(\w+)\?\)", problem
        )
        assert "did you mean" not in problem or (hint and hint[1] == hint[2])


@pytest.mark.parametrize(
    ("names", "named", "read"),
    [
        ("t_s,q0,q1,q2,q3", {}, ("t", "q0", "q1", "q2", "q3")),
        ("t_s,qw,qx,qy,qz,roll_deg,pitch_deg,yaw_deg", {}, ("t", "q0", "q1", "q2", "q3")),
        ("t_s,Roll [deg],Pitch [deg],Yaw [deg]", {}, ("t", "roll", "pitch", "yaw")),
        (f"t_s,{RADIANS},roll_deg,pitch_deg,yaw_deg", {}, ("t", *RATES)),
        (f"t_s,{RADIANS},q0,q1,q2,q3", {"q0": "q0"}, ("t", "q0", "q1", "q2", "q3")),
        (f"t_s,{RADIANS},a", {"p_rad_s": "p_rad_s", "q0": "a"}, ("t", *RATES)),
        ("t_s,gx (deg/s),gy (deg/s),gz (deg/s),q0,q1,q2,q3", {}, ("t", "q0", "q1", "q2", "q3")),
        ("t_s,gz_g,q_rad_s,q0,q1,q2,q3", {}, ("t", "gz", "q")),
        ("t_s,Gz (g),Gx [g]", {}, ("t", "gz", "gx")),
        (f"t_s,gz_g,{RADIANS}", {"gz_g": "gz_g"}, ("t", "gz", "p", "q")),
        (f"t_s,gz_g,{RADIANS}", {"r_rad_s": "r_rad_s"}, ("t", *RATES)),
        ("t_s,gz_g,a", {"p_rad_s": "a"}, ("t", "gz", "p")),
        (
            "t_s,roll_rate_dps,pitch_rate_dps,yaw_rate_dps",
            {"p": "roll_rate_dps", "q": "pitch_rate_dps", "r": "yaw_rate_dps"},
            ("t", *RATES),
        ),
    ],
)
def test_attitudes_and_g_are_chosen_after_what_turns_by_itself(
    names: str, named: dict[str, str], read: tuple[str, ...]
) -> None:
    chosen, problems, _ = choose(names, **named)
    assert problems == []
    assert tuple(chosen) == read


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (
            f"t_s,gz_g,{RADIANS}",
            "both body rates (p, q, r) and G (gz); choose with --column: p and",
        ),
        ("t_s,gz_g,fork_deg", "both joint commands (fork) and G (gz)"),
        ("t_s,gzz_g", "gzz_g is not known (did you mean gz_g?)"),
        ("t_s,p_rad_s,q0,q1,q2,q3", "a column is missing: q_rad_s"),
        ("t_s,p,q_rad_s,r_rad_s,q0,q1,q2,q3", "p is a rate and needs its unit"),
        ("t_s,gx_dps,gy_dps,gz_dps", "has neither joint commands"),
    ],
)
def test_what_stands_in_the_way_of_attitudes_and_g_is_named(names: str, words: str) -> None:
    _, problems, _ = choose(names)
    assert problems
    assert words in problems[0]
