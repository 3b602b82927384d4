"""A machine by its name or from a file of its own, and its source in one sentence."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from des_cli.errors import FileAccessError, ProfileError
from des_cli.model.machines import DES, MACHINES
from des_cli.profiles_in.machine_file import load_machine, machine_summary


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize("name", MACHINES)
def test_a_name_is_the_built_in_machine_whatever_lies_in_the_folder(name: str) -> None:
    Path(name).write_text("{base: des, name: another}")
    assert load_machine(name, "--machine") is MACHINES[name]


@pytest.mark.parametrize("path", ["own.yaml", "own.yml", "./own", "sub/own"])
def test_an_ending_or_a_slash_makes_it_a_file(path: str) -> None:
    Path("sub").mkdir()
    Path(path).write_bytes(b"\xef\xbb\xbf{base: des, name: own}")  # as some editors begin a file
    assert load_machine(path, "--machine") == replace(DES, name="own")


def test_a_name_that_no_machine_has_is_said_of_the_option() -> None:
    Path("own").write_text("{base: des}")
    for choice, words in (
        ("dse", "there is no built-in machine dse (did you mean des?), or give a file's path"),
        ("own", "there is no built-in machine own; there is covisart, des or johnsville"),
    ):
        with pytest.raises(ProfileError) as caught:
            load_machine(choice, "--machine")
        (complaint,) = caught.value.complaints
        assert (complaint.where, complaint.what[: len(words)]) == ("--machine", words)


@pytest.mark.parametrize(
    ("content", "lines"),
    [
        (b"{base: dse, gravity_g: 0}", ["own.yaml:1:24: gravity_g: must be greater than 0, is 0"]),
        (
            b"{limits: {arm: {rate_rpm: 0}},\ngravity_g: 0}",
            [
                "own.yaml:1:27: limits.arm.rate_rpm: must be greater than 0, is 0",
                "own.yaml:2:12: gravity_g: must be greater than 0, is 0",
            ],
        ),
        (b"base: des\nname: \xff", ["own.yaml:2: is not UTF-8 text (byte 0xff); save it as UTF-8"]),
    ],
)
def test_what_is_wrong_in_a_file_is_said_with_its_lines(content: bytes, lines: list[str]) -> None:
    Path("own.yaml").write_bytes(content)
    with pytest.raises(ProfileError) as caught:
        load_machine("own.yaml", "--machine")
    assert [str(complaint) for complaint in caught.value.complaints] == lines


def test_a_file_that_cannot_be_read_is_named_on_one_line() -> None:
    with pytest.raises(FileAccessError, match=r"^none\.yaml: cannot be read: No such file"):
        load_machine("none.yaml", "--machine")
    with pytest.raises(FileAccessError) as caught:
        load_machine("no\nsuch.yaml", "--machine")
    assert r"'no\nsuch.yaml': cannot be read" in str(caught.value)


@pytest.mark.parametrize(
    ("source", "summary"),
    [
        ("", ""),
        ("A machine", "A machine."),
        ("A machine.", "A machine."),
        ("An arm of 7.5 m. Its limits are assumed.", "An arm of 7.5 m."),
    ],
)
def test_the_summary_is_the_first_sentence_of_the_source(source: str, summary: str) -> None:
    assert machine_summary(replace(DES, source=source)) == summary
