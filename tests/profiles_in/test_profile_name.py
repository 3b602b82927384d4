"""The name of a profile, whatever else is wrong with it."""

import json
from pathlib import Path

import pytest

from des_cli import load_profile
from des_cli.batch.job import Output
from des_cli.errors import ProfileError
from des_cli.profiles_in.profile_name import find_name, name_of_file
from des_cli.runs_out import atomic
from tests.support.hostile import NAMES, YAML

BROKEN = "format: des-coriolis/1\nname: mine\njoints: {arm_rpm: sin(}\nno: 1\n"


@pytest.mark.parametrize(
    ("file", "text", "settings", "name"),
    [
        ("p.yaml", BROKEN, (), "mine"),
        ("p.yaml", BROKEN, ("name=other",), "other"),
        ("p.yaml", BROKEN.replace("name: mine\n", ""), (), "p"),
        ("p?.yaml", "{}", (), "p_"),
        ("p.yaml", BROKEN.replace("mine", "../x"), (), ""),
        ("p.yaml", BROKEN.replace("mine", "[1]"), (), ""),
        ("p.yaml", "name: [", (), ""),
        ("log.csv", "t_s,arm_rpm\n0,x\n", (), "log"),
        ("log.csv", "t_s,arm_rpm\n0,x\n", ("name=other",), "other"),
    ],
)
def test_it_is_what_a_run_of_it_would_be_called(
    tmp_path: Path, file: str, text: str, settings: tuple[str, ...], name: str
) -> None:
    (tmp_path / file).write_text(text)
    assert find_name(tmp_path / file, settings=settings) == name


def test_standard_input_and_what_is_absent() -> None:
    assert find_name("-", stdin=BROKEN.encode()) == "mine"
    assert find_name("-", stdin=b"t_s,arm_rpm\n") == "stdin"
    assert find_name("cobra", settings=("time.step_s=-1",)) == "cobra"
    assert find_name("absent.yaml") == ""


@pytest.mark.parametrize("name", NAMES)
def test_no_name_leads_out_of_the_folder_of_runs_or_is_a_formula(tmp_path: Path, name: str) -> None:
    """As a profile gives it to itself, where it is refused or safe, and as its file has it."""
    names = [name_of_file(Path(f"{name}.csv")) if "\0" not in name else "x"]
    try:
        text = YAML.replace("name: small", f"name: {json.dumps(name)}")
        names.append(load_profile("-", stdin=text.encode()).name)
    except ProfileError:
        pass
    for safe in names:
        target = Output(str(tmp_path), out_is_parent=True).destination(safe)
        assert target.resolve().parent == tmp_path.resolve()
        assert target.name == safe
        assert safe.isprintable()
        assert not safe.startswith(("=", "+", "-", "@", ".", " ", "\t", "\r"))
        assert not atomic.is_temporary(safe)
        target.mkdir()
        assert [path.name for path in tmp_path.iterdir()] == [safe]
        target.rmdir()


def test_the_list_of_names_is_long() -> None:
    assert len(set(NAMES)) >= 60
