"""The bytes of a profile: what is no readable file, and what kind a file is."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from des_cli.errors import FileAccessError, ProfileError
from des_cli.profiles_in.load import load_profile
from tests.support.profiles import SMALL


def test_what_is_no_readable_file_is_said_to_be_none(tmp_path: Path) -> None:
    cases = [
        (tmp_path / "none.yaml", "no such file, and no built-in profile"),
        ("cobar", "did you mean cobra?"),
        (tmp_path, "is a folder"),
        ("a\0b", "no such file"),
        ("x" * 5000, "cannot be read"),
        ("/dev/null", "is a device"),
        ("-", "nothing was given on standard input"),
    ]
    for source, words in cases:
        with pytest.raises(FileAccessError) as caught:
            load_profile(source)
        assert words in str(caught.value)
        assert str(caught.value).isprintable()


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="here every file is readable")
def test_a_file_without_permission_is_named(tmp_path: Path) -> None:
    path = tmp_path / "closed.yaml"
    path.write_text(SMALL)
    path.chmod(0)
    with pytest.raises(FileAccessError, match="Permission denied"):
        load_profile(path)


def test_text_that_is_not_utf_8_is_named_by_its_line(tmp_path: Path) -> None:
    path = tmp_path / "latin.yaml"
    path.write_bytes(SMALL.encode() + b"# \xe9t\xe9\n")
    with pytest.raises(ProfileError, match=r"latin\.yaml:8: is not UTF-8 text \(byte 0xe9\)"):
        load_profile(path)


def test_files_of_other_endings_are_what_they_hold(tmp_path: Path) -> None:
    path = tmp_path / "profile.txt"
    path.write_text("\n# a maneuver\n" + SMALL)
    assert load_profile(path).name == "small"
    path.write_text("t_s,arm_rpm,fork_deg,cab_deg\n0,1,2,3\n1,2,3,4\n")
    assert load_profile(path).name == "profile"
