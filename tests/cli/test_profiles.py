"""``profiles``: the list, and a file that can be piped into another."""

import json
from pathlib import Path

from des_cli.profiles_in.builtin import builtin_profiles


def test_the_list_has_a_line_for_each(invoke) -> None:
    result = invoke("profiles")
    assert (result.exit_code, result.stderr) == (0, "")
    names = [line.split()[0] for line in result.stdout.splitlines()]
    assert names == [profile.name for profile in builtin_profiles()]
    assert "cobra" in names


def test_the_list_as_json_lines(invoke) -> None:
    result = invoke("profiles", "--format", "json")
    rows = [json.loads(line) for line in result.stdout.splitlines()]
    assert [(row["name"], row["summary"]) for row in rows] == [
        (profile.name, profile.summary) for profile in builtin_profiles()
    ]


def test_a_profile_is_printed_byte_for_byte_and_is_valid(invoke, tmp_path: Path) -> None:
    result = invoke("profiles", "cobra")
    assert (result.exit_code, result.stderr) == (0, "")
    built_in = next(profile for profile in builtin_profiles() if profile.name == "cobra")
    assert result.stdout_bytes == built_in.path.read_bytes()
    (tmp_path / "mine.yaml").write_bytes(result.stdout_bytes)
    assert invoke("validate", "mine.yaml").exit_code == 0


def test_a_wrong_name_is_wrong_use_with_a_guess(invoke) -> None:
    result = invoke("profiles", "cobar")
    assert (result.exit_code, result.stdout) == (2, "")
    assert "Did you mean 'cobra'?" in result.stderr
    assert "cobra" in invoke("profiles", "zzzz").stderr
