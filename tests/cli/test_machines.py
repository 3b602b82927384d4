"""``machines``: the list, and a machine that reads back."""

from __future__ import annotations

import json
from pathlib import Path
from textwrap import indent

import pytest

from des_cli.model.machines import MACHINES
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.machine_yaml import machine_mapping, parse_machine


def test_the_list_has_a_line_for_each(invoke) -> None:
    result = invoke("machines")
    assert (result.exit_code, result.stderr) == (0, "")
    lines = result.stdout.splitlines()
    assert [line.split()[0] for line in lines] == list(MACHINES)
    assert "Dynamic Environment Simulator" in lines[0]


def test_the_list_as_json_lines(invoke) -> None:
    rows = [json.loads(line) for line in invoke("machines", "--format", "json").stdout.splitlines()]
    assert [row["name"] for row in rows] == list(MACHINES)
    assert all(MACHINES[row["name"]].source.startswith(row["summary"][:-1]) for row in rows)


@pytest.mark.parametrize("name", MACHINES)
def test_a_printed_machine_reads_back_exactly(invoke, name: str) -> None:
    text = invoke("machines", name).stdout
    assert parse_machine(text, "printed.yaml") == MACHINES[name]


@pytest.mark.parametrize("name", MACHINES)
def test_a_printed_machine_fits_into_a_profile(invoke, small: str, name: str) -> None:
    text = invoke("machines", name).stdout
    path = Path(small)
    described = path.read_text().replace("machine: des\n", f"machine:\n{indent(text, '  ')}")
    path.write_text(described)
    assert load_profile(path).machine == MACHINES[name]


def test_a_machine_of_a_file_is_shown_whole(invoke, tmp_path: Path) -> None:
    (tmp_path / "own.yaml").write_text("base: des\nname: 'longer \"arm\"'\nlengths_ft: {L2: 29}\n")
    shown = parse_machine(invoke("machines", "own.yaml").stdout, "shown")
    assert shown.name == 'longer "arm"'
    assert shown.lengths["L2"] == pytest.approx(29 * 0.3048, rel=1e-15)
    assert shown.limits == MACHINES["des"].limits


def test_one_as_json(invoke) -> None:
    found = json.loads(invoke("machines", "johnsville", "--format", "json").stdout)
    assert found == machine_mapping(MACHINES["johnsville"])
    assert {"limits", "lengths_m", "source", "rows"} <= set(found)


@pytest.mark.parametrize(
    ("name", "code", "said"),
    [
        ("dse", 3, "dse (did you mean des?)"),
        ("zzzz", 3, "covisart, des or johnsville"),
        ("none.yaml", 1, "none.yaml: "),
        ("./", 1, "is a folder"),
    ],
)
def test_what_is_no_machine(invoke, name: str, code: int, said: str) -> None:
    result = invoke("machines", name)
    assert (result.exit_code, result.stdout) == (code, "")
    assert said in result.stderr
    assert "\n" not in result.stderr.strip()


def test_every_problem_of_a_machine_file_at_once(invoke, tmp_path: Path) -> None:
    (tmp_path / "bad.yaml").write_text(
        "lengths_ft: {L2: 19}\nlimits: {arm: {angle: endless, rate_rad_s: 1}}\n"
    )
    result = invoke("machines", "bad.yaml")
    assert (result.exit_code, result.stdout) == (3, "")
    for words in ("arm's acceleration", "fork's angle", "cab's rate", "Lx, Ly, Lz, Lt"):
        assert words in result.stderr
