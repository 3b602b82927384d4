"""Where the bytes of a profile come from, and whether they are YAML or a table."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from des_cli.errors import FileAccessError
from des_cli.profiles_in.builtin import builtin_profiles
from des_cli.profiles_in.profile_file import ProfileFile


def test_standard_input_has_no_path() -> None:
    assert ProfileFile.read("-", b"a: 1\n") == ProfileFile(None, "<stdin>", b"a: 1\n")


def test_a_file_is_called_by_its_path(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_bytes(b"t_s\r\n")
    for source in (path, str(path)):
        assert ProfileFile.read(source, b"unread") == ProfileFile(path, str(path), b"t_s\r\n")


def test_a_built_in_maneuver_goes_before_what_has_its_name_here(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (cobra,) = [profile for profile in builtin_profiles() if profile.name == "cobra"]
    built_in = ProfileFile(cobra.path, "cobra.yaml", cobra.path.read_bytes())
    assert ProfileFile.read("cobra", None) == built_in
    Path("cobra").mkdir()
    assert ProfileFile.read("cobra", None) == built_in
    Path("cobra").rmdir()
    Path("cobra").write_bytes(b"own")
    what = "cobra is the built-in profile; the file of this name here is ./cobra"
    assert ProfileFile.read("cobra", None) == replace(built_in, remarks=(what,))
    for own in ("./cobra", Path("cobra")):
        assert ProfileFile.read(own, None).data == b"own"


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("none.yaml", "none.yaml: there is no such file, and no built-in profile of that name"),
        ("cobar", "of that name (did you mean cobra?)"),
        (".", ".: is a folder"),
        ("a\0b", "is not a file name"),
        ("x" * 5000, "cannot be read"),
        ("/dev/null", "/dev/null: is a device"),
        ("-", "<stdin>: nothing was given on standard input"),
    ],
)
def test_what_is_no_readable_file_is_said_to_be_none(
    source: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(FileAccessError) as caught:
        ProfileFile.read(source, None)
    assert words in str(caught.value)
    assert str(caught.value).isprintable()


TABLE, YAML = "t_s,arm_rpm\n0,1\n", "format: des-coriolis/1\n"


@pytest.mark.parametrize(
    ("name", "text", "is_yaml"),
    [
        ("a.yaml", TABLE, True),
        ("a.YML", TABLE, True),
        ("a.csv", YAML, False),
        ("a.CSV", YAML, False),
        ("a.txt", TABLE, False),
        ("a.txt", YAML, True),
        (None, TABLE, False),
        (None, YAML, True),
    ],
)
def test_the_ending_decides_and_without_one_the_content(
    name: str | None, text: str, is_yaml: bool
) -> None:
    path = None if name is None else Path(name)
    assert ProfileFile(path, "x", text.encode()).is_yaml is is_yaml


@pytest.mark.parametrize(
    ("first", "is_yaml"),
    [
        ("\ufeff\n  # a: b\nname: x", True),
        ("---", True),
        ("%YAML 1.2", True),
        ("{format: des-coriolis/1}", True),
        ("'a key' : 3", True),
        ("time:", True),
        ("- 1", True),
        ("# name: x\nt_s,arm_rpm", False),
        ("% note: x", False),
        ("Time (UTC),p", False),
        ("12:00:00,1,2", False),
        ("-1,2", False),
        ("sep=;", False),
        ('"t (s)";"p (deg/s)"', False),
        ("", False),
        ("# only a comment", False),
    ],
)
def test_the_first_line_that_says_anything_tells_yaml_from_a_table(
    first: str, is_yaml: bool
) -> None:
    assert ProfileFile(None, "x", f"{first}\n".encode()).is_yaml is is_yaml


def test_a_table_in_latin_1_is_told_from_yaml_too() -> None:
    file = ProfileFile(None, "x", "T (°C),t_s\n".encode("latin-1"))
    assert file.is_yaml is False
    assert file.table[0] == "T (°C),t_s\n"
    assert "Latin-1" in file.table[1][0]
