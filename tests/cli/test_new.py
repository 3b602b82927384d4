"""``new``: a profile that is valid, and so is every key that stands in it as a comment."""

import re
from pathlib import Path

import pytest

from des_cli.model.profile import Reduction
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.starter import starter_text
from des_cli.units import split_unit

TEXT = starter_text("turn")
KEY = re.compile(r"^( *)#(\w+): ", re.MULTILINE)
COMMENTED = [match[2] for match in KEY.finditer(TEXT)]
STUDYS = {"method", "algorithm", "jacobian", "r2", "tracking", "tolerance", "iterations"}
"""Keys that a profile of the study's own problem has, and nobody's first one."""


def uncommented(key: str) -> str:
    text, count = re.subn(rf"^( *)#({key}: )", r"\1\2", TEXT, flags=re.MULTILINE)
    assert count == 1
    return text


def test_the_file_is_named_after_the_profile_and_valid(invoke, tmp_path: Path) -> None:
    result = invoke("new", "turn")
    assert (result.exit_code, result.stdout) == (0, "")
    assert result.stderr == "turn.yaml: reduce it with des-coriolis reduce turn.yaml\n"
    assert (tmp_path / "turn.yaml").read_text(encoding="utf-8") == TEXT
    checked = invoke("validate", "turn.yaml")
    assert (checked.exit_code, checked.stderr) == (0, "")
    assert checked.stdout.startswith("turn.yaml: ok: turn, ")


@pytest.mark.slow
def test_it_reduces_and_breaks_no_limit(invoke) -> None:
    invoke("new", "turn")
    result = invoke("reduce", "turn.yaml", "--no-plots", "--fail-on", "notice")
    assert result.exit_code == 0
    assert "  limits         all kept; " in result.stderr
    assert "notice" not in result.stderr
    assert result.stderr.startswith("turn: cross-coupling ")


@pytest.mark.parametrize("key", COMMENTED)
def test_every_key_in_a_comment_is_valid(key: str, tmp_path: Path) -> None:
    path = tmp_path / "turn.yaml"
    path.write_text(uncommented(key), encoding="utf-8")
    assert load_profile(path).name == "turn"


def test_no_key_of_a_reduction_is_left_out() -> None:
    active = re.findall(r"^  (\w+):", TEXT, re.MULTILINE)
    named = {split_unit(key)[0] for key in (*active, *COMMENTED)}
    assert {*Reduction.__dataclass_fields__} - named == STUDYS


def test_without_a_name_it_is_called_after_the_file(invoke, tmp_path: Path) -> None:
    assert invoke("new").exit_code == 0
    assert "name: maneuver\n" in (tmp_path / "maneuver.yaml").read_text(encoding="utf-8")
    assert invoke("new", "-o", "my turn.yml").exit_code == 0
    assert 'name: "my turn"\n' in (tmp_path / "my turn.yml").read_text(encoding="utf-8")
    printed = invoke("new", "turn", "-o", "-")
    assert (printed.exit_code, printed.stdout, printed.stderr) == (0, TEXT, "")


@pytest.mark.parametrize("name", ["no", "null", "1e3", "Übung 1", "v1.2 (b)"])
def test_any_name_of_a_profile_is_read_back(name: str, tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_text(starter_text(name), encoding="utf-8")
    assert load_profile(path).name == name


def test_nothing_is_replaced(invoke, tmp_path: Path) -> None:
    (tmp_path / "turn.yaml").write_text("mine")
    result = invoke("new", "turn")
    assert result.exit_code == 1
    assert result.stderr == "turn.yaml: exists, and is left as it is; name another\n"
    assert (tmp_path / "turn.yaml").read_text() == "mine"


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["a/b"], "NAME must be 1 to 100 letters"),
        (["con"], "NAME is a device"),
        (["turn", "-o", "turn.csv"], "ends in .yaml or .yml"),
    ],
)
def test_wrong_use(invoke, tmp_path: Path, args: list[str], said: str) -> None:
    result = invoke("new", *args)
    assert result.exit_code == 2
    assert said in result.stderr
    assert not any(tmp_path.iterdir())
