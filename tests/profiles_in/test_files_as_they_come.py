"""Whole files of recorders and spreadsheets: read, or named with what to type."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from des_cli.errors import ProfileError, UsageError
from des_cli.model.profile import BodyRates, Profile
from des_cli.profiles_in.load import load_profile

HEADER = "t_s,p_rad_s,q_rad_s,r_rad_s\n"
ROWS = "0,0.5,2,3\n0.25,0.5,2,3\n1,0.5,2,3\n"
NAMED = {name: name for name in ("t_s", "p_rad_s", "q_rad_s", "r_rad_s")}
COMMAS = (HEADER + ROWS).replace(",", ";").replace(".", ",")


def load(text: str | bytes, **how: Any) -> Profile:
    return load_profile("-", stdin=text.encode() if isinstance(text, str) else text, **how)


def problems_of(text: str | bytes, **how: Any) -> list[str]:
    with pytest.raises(ProfileError) as caught:
        load(text, **how)
    return [str(problem) for problem in caught.value.complaints]


def rates(profile: Profile) -> np.ndarray:
    assert isinstance(profile.command, BodyRates)
    return profile.command.start


# Each holds the same three samples.
AS_THEY_COME: dict[str, tuple[str | bytes, dict[str, Any]]] = {
    "plain": (HEADER + ROWS, {}),
    "tabs": ((HEADER + ROWS).replace(",", "\t"), {"separator": "\t"}),
    "bars": ((HEADER + ROWS).replace(",", "|"), {"separator": "|"}),
    "semicolons, points": ((HEADER + ROWS).replace(",", ";"), {"separator": ";"}),
    "semicolons, commas": (COMMAS, {"separator": ";", "decimal": ","}),
    "the same, no option but the decimal": ("sep=;\n" + COMMAS, {"decimal": ","}),
    "one comment": ("# recorder 3\n" + COMMAS, {"separator": ";", "decimal": ","}),
    "two comments, 1;5": ("# a;b\n\n% 1;5\n" + COMMAS, {"separator": ";", "decimal": ","}),
    "byte-order mark": ("\ufeff" + COMMAS, {"separator": ";", "decimal": ","}),
    "CR LF": (COMMAS.replace("\n", "\r\n"), {"separator": ";", "decimal": ","}),
    "CR": (COMMAS.replace("\n", "\r"), {"separator": ";", "decimal": ","}),
    "blanks": ((HEADER + ROWS).replace(",", "   "), {"separator": " "}),
    "blanks around": (
        "  " + (HEADER + ROWS).replace(",", " \t ").replace("\n", "  \n  "),
        {"separator": " "},
    ),
    "quoted commas": (
        HEADER + '"0","0,5","2","3"\n"0,25","0,5","2","3"\n1,"0,5",2,3\n',
        {"decimal": ","},
    ),
    "quoted header": ('"t_s","p_rad_s","q_rad_s","r_rad_s"\n' + ROWS, {}),
    "blanks in quotes": ('"t (s)" "p (rad/s)" q_rad_s r_rad_s\n' + ROWS.replace(",", " "),
                         {"separator": " "}),
    "separators at the ends": ((HEADER + ROWS).replace("\n", ",\n"), {}),
    "separators at the ends of rows": (HEADER + ROWS.replace("\n", ",,\n"), {}),
    "separators at the end of the header": (HEADER.replace("\n", ",,\n") + ROWS, {}),
    "empty last lines": (HEADER + ROWS + "\n\n  \n", {}),
    "blanks in the header": ("t_s , p_rad_s, q_rad_s ,r_rad_s\n" + ROWS, {}),
    "capitals": (HEADER.upper() + ROWS, {}),
    "row of units": ("t,p,q,r\ns,rad/s,rad/s,rad/s\n" + ROWS, {}),
    "row of units in brackets, one unknown": (
        "t,p,q,r,T\n[s],[rad/s],[rad/s],[rad/s],[°C]\n" + ROWS.replace("\n", ",20\n"),
        {},
    ),
    "row of units that agrees": (HEADER + "s,rad/s,,rad/s\n" + ROWS, {}),
    "comments everywhere": (
        "% a\n" + HEADER + "// b\n" + ROWS.replace("\n", "\n# c\n"),
        {},
    ),
    "header in a comment": ("# run 7\n# " + HEADER + ROWS, {}),
    "header in a comment, blanks": (
        "# " + (HEADER + ROWS).replace(",", " "),
        {"separator": " "},
    ),
    "milliseconds": ("Time [ms],p_rad_s,q_rad_s,r_rad_s\n0,.5,2,3\n250,.5,2,3\n1e3,.5,2,3\n", {}),
    "nanoseconds": (
        HEADER.replace("t_s", "t_ns")
        + "1403636579758555392,.5,2,3\n1403636580008555392,.5,2,3\n1403636580758555392,.5,2,3\n",
        {},
    ),
    "dates": (
        HEADER.replace("t_s", "Time (UTC)")
        + "2024-05-01T23:59:59.5Z,.5,2,3\n2024-05-01T23:59:59.75Z,.5,2,3\n"
        "2024-05-02T00:00:00.5Z,.5,2,3\n",
        {},
    ),
    "clock": (
        HEADER.replace("t_s", "clock")
        + "12:00:00.5,.5,2,3\n12:00:00.75,.5,2,3\n12:00:01.5,.5,2,3\n",
        {"columns": {"t": "clock"}},
    ),
    "Latin-1": (
        ("Zeit,p,q,r,T (°C)\n" + ROWS.replace("\n", ",20\n")).encode("latin-1"),
        {"columns": {"t_s": "Zeit", "p_rad_s": "p", "q_rad_s": "q", "r_rad_s": "r"}},
    ),
    "Latin-1 in a cell": (
        HEADER.replace("\n", ",note\n").encode() + ROWS.replace("\n", ",\xfc\n").encode("latin-1"),
        {},
    ),
    "names that are numbers": (
        "0,1,2,3\n" + ROWS,
        {"columns": {"t_s": "0", "p_rad_s": "1", "q_rad_s": "2", "r_rad_s": "3"}},
    ),
}  # fmt: skip


@pytest.mark.parametrize(("text", "how"), AS_THEY_COME.values(), ids=AS_THEY_COME)
def test_every_way_of_writing_gives_the_same_samples(
    text: str | bytes, how: dict[str, Any]
) -> None:
    profile = load(text, **how)
    np.testing.assert_array_equal(profile.t, [0, 0.25, 1])
    np.testing.assert_array_equal(rates(profile), [[0.5, 2, 3]] * 2)


@pytest.mark.parametrize(
    ("text", "how", "line", "words"),
    [
        (COMMAS, {}, 1, "separated by semicolons and the numbers have a decimal comma: give "
         "--separator ';' --decimal , (in YAML: separator: ';', decimal: ',')"),
        (COMMAS, {"separator": ";"}, 1, "the numbers have a decimal comma: give --decimal ,"),
        ("# a\n# b\n" + COMMAS, {}, 3, "separated by semicolons and the numbers have"),
        ((HEADER + ROWS).replace(",", ";"), {}, 1, "semicolons: give --separator ';' (in"),
        ((HEADER + ROWS).replace(",", "\t"), {}, 1, "tabs: give --separator tab"),
        ((HEADER + ROWS).replace(",", "  "), {}, 1, "blanks: give --separator space"),
        (HEADER + ROWS, {"separator": ";"}, 1, "separated by commas: give --separator ,"),
        (HEADER + ROWS, {"decimal": ","}, 1, "have a decimal point: give --decimal ."),
        (COMMAS.replace("0,25", "0.25"), {"separator": ";", "decimal": ","}, 3,
         "t_s: must be a number, is '0.25', with a decimal point where the file has the other"),
        (HEADER + "0,0,0,5,2,0,3,0\n0,1,0,5,2,0,3,0\n", {}, 2,
         "has 8 cells, the header has 4; a decimal comma cannot be told from one between "
         "columns: save with semicolons (2 rows like this)"),
        (ROWS, {}, 1, "the first line is numbers: a header is missing; put one above"),
        ("# only words\n" + ROWS, {}, 2, "the first line is numbers: a header is missing"),
        (HEADER + HEADER + ROWS, {}, 2, "is the header again; take it out"),
        (HEADER + "s,deg/s,rad/s,rad/s\n" + ROWS, {}, 1,
         "the column p_rad_s is in rad_s, but the row of units says deg_s; correct one of them"),
        (HEADER + ROWS.replace("\n", "\n\n"), {}, 3,
         "is a blank line between rows; take it out (2 rows like this)"),
        (HEADER + "1e9,1,2,3\n1000000000.000001,1,2,3\n1000000000.000001,1,2,3\n", {}, 4,
         "t_s: 1000000000.000001 does not increase (previous 1000000000.000001)"),
    ],
)  # fmt: skip
def test_what_is_not_read_is_one_sentence_that_says_what_to_do(
    text: str, how: dict[str, Any], line: int, words: str
) -> None:
    (found,) = problems_of(text, **how)
    assert found.startswith(f"<stdin>:{line}: ")
    assert words in found


def test_a_header_may_be_missing_in_any_dialect() -> None:
    lines = problems_of(COMMAS.partition("\n")[2])
    assert len(lines) == 2
    assert "give --separator ';' --decimal ," in lines[0]
    assert "a header is missing" in lines[1]


def test_small_files_of_recorders() -> None:
    samples = "0,0,0,0{0}\n0.1,0.1,0,0.1{0}\n0.2,0.1,0.1,0.1{0}\n"
    twice = HEADER.replace("\n", ",temp,temp\n") + samples.format(",1,2")
    assert rates(load(twice, columns=NAMED))[1, 2] == 0.1
    assert load(twice).remarks == ("2 columns are not read: temp, temp",)
    degrees = HEADER.replace("t_s,p_rad_s,q_rad_s,r_rad_s", "t_s,p_dps,q_dps,r_dps")
    np.testing.assert_array_equal(
        rates(load(degrees + samples.format(""))),
        np.array([[0, 0, 0], [0.1, 0, 0.1]]) * np.pi / 180,
    )
    latin = (HEADER.replace("\n", ",Temp (°C)\n") + samples.format(",20")).encode("latin-1")
    remarks = load(latin, columns=NAMED).remarks
    assert remarks == ("the file is not UTF-8 (byte 0xb0 in line 1): it is read as Latin-1",)


def test_what_was_done_is_told_once() -> None:
    more = "".join(f",c{k}" for k in range(52))
    text = f"# a\n{HEADER[:-1]}{more}\n" + ROWS.replace("\n", ",x" * 52 + "\n# b\n")
    assert load(text).remarks == (
        "a comment line is skipped",
        "52 columns are not read: c0, c1, c2, c3, c4, …",
        "3 comment lines are skipped between the rows",
    )
    assert load(HEADER + ROWS).remarks == ()


def test_yaml_names_the_dialect_of_its_samples(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text("\ufeff# from a spreadsheet\n" + COMMAS)
    path = tmp_path / "log.yaml"
    head = "format: des-coriolis/1\nsamples: {file: log.csv"
    path.write_text(head + ", separator: semicolon, decimal: ','}\n")
    profile = load_profile(path)
    np.testing.assert_array_equal(profile.t, [0, 0.25, 1])
    assert profile.remarks == ("a comment line is skipped",)
    with pytest.raises(UsageError, match=r"this is YAML: give samples\.separator"):
        load_profile(path, separator=";")
    path.write_text(head + ", separator: '#', decimal: 1}\n")
    with pytest.raises(ProfileError) as caught:
        load_profile(path)
    lines = [str(problem) for problem in caught.value.complaints]
    assert "samples.separator: must be ',', ';', '|', tab or space, is '#'" in lines[0]
    assert "samples.decimal: must be text, is 1" in lines[1]


def test_how_a_file_is_read_belongs_to_its_digest() -> None:
    digests = {load(HEADER + ROWS, separator=sign).sha256 for sign in (None, ",")}
    assert len(digests) == 2


@pytest.mark.parametrize("seed", range(5))
def test_mutated_files_are_read_or_refused(seed: int, tmp_path: Path) -> None:
    path = tmp_path / "mutated.csv"
    random_ = random.Random(seed)
    pieces = [*"\n\r\t ,;|\"'#%/:.-+e0159[]()°\ufeff\x1f", "nan", "T12:00", "s,rad/s\n", "\xa0"]
    files = list(AS_THEY_COME.values())
    outcomes = set()
    for _ in range(100):
        text, how = random_.choice(files)
        data = bytearray(text if isinstance(text, bytes) else text.encode())
        for _ in range(random_.randint(1, 2)):
            at = random_.randrange(len(data) + 1)
            data[at : at + random_.randint(0, 2)] = random_.choice(pieces).encode(
                random_.choice(["utf-8"] * 19 + ["utf-16-le"])
            )
        try:
            path.write_bytes(data)
            profile = load_profile(path, **how)
        except ProfileError as error:
            outcomes.add("refused")
            lines = [str(problem) for problem in error.complaints]
            assert lines
            assert all(line.isprintable() for line in lines)
        else:
            outcomes.add("read")
            assert np.all(np.diff(profile.t) > 0)
            assert all(remark.isprintable() for remark in profile.remarks)
    assert outcomes == {"read", "refused"}


def test_settings_name_the_dialect_too_and_options_go_before_them() -> None:
    settings = ["samples.separator=semicolon", "samples.decimal=comma"]
    np.testing.assert_array_equal(load(COMMAS, settings=settings).t, [0, 0.25, 1])
    options = {"separator": ",", "decimal": "."}
    np.testing.assert_array_equal(load(HEADER + ROWS, settings=settings, **options).t, [0, 0.25, 1])


def test_a_dialect_and_its_comments_go_with_conditioning_gaps_and_wrapped_angles() -> None:
    rows = ["0;1;350;3", "0,1;1;10;3", "# a pause", "0,4;1;20;3", "0,5;1;30;3", "0,6;1;40;3"]
    text = "# log\nt_s;arm_rpm;fork_deg;cab_deg\n" + "\n".join(rows) + "\n"
    how: dict[str, Any] = {"separator": ";", "decimal": ","}
    remarks = load(text, **how).remarks
    assert remarks[:2] == (
        "a comment line is skipped",
        "a comment line is skipped between the rows",
    )
    assert remarks[2].startswith("line 4: fork_deg jumps from 350 to 10 deg")
    fast = text.replace("0,4;", "2;").replace("0,5;", "2,1;").replace("0,6;", "2,2;")
    (line,) = problems_of(fast, **how)
    assert line.startswith("<stdin>:6: a gap of 1.9 s")
    bridged = load(fast, settings=["gap=split"], part=2, **how)
    np.testing.assert_array_equal(bridged.t, [2, 2.1, 2.2])
    trimmed = load(fast, settings=["trim.from_s=1"], **how)
    np.testing.assert_array_equal(trimmed.t, [2, 2.1, 2.2])


def test_an_attitude_in_a_recorder_s_spelling_is_flown_and_its_lines_are_named() -> None:
    text = "# imu\nTime (s);QW;qx;qy;qz\n0;1;0;0;0\n# x\n1;0,5;0;0;0\n2;1;0;0;0\n"
    how: dict[str, Any] = {"separator": ";", "decimal": ","}
    (line,) = problems_of(text, **how)
    assert line == "<stdin>:5: q0..q3: the attitude's norm is 0.5, not 1 (1 such row)"
    assert len(load(text.replace("0,5", "1"), **how).t) == 3
