"""The name of a profile, whatever else is wrong with it."""

from pathlib import Path

import pytest

from des_cli.profiles_in.profile_name import find_name

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
