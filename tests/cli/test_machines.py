"""``machines``: the list, and a machine that reads back."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from textwrap import indent

import numpy as np
import pytest

from des_cli.kinematics.chain import chain_of, seat_position
from des_cli.model.machine import Seat
from des_cli.model.machines import (
    CHAIN_LENGTHS,
    MACHINES,
    gimballed_centrifuge_rows,
    read_chain,
)
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.machine_yaml import machine_mapping, parse_machine
from des_cli.units import FOOT_M


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


@pytest.mark.parametrize("full", [(), ("--full",)])
@pytest.mark.parametrize("name", MACHINES)
def test_a_printed_machine_reads_back_exactly(invoke, name: str, full: tuple[str]) -> None:
    text = invoke("machines", name, *full).stdout
    assert parse_machine(text, "printed.yaml") == MACHINES[name]
    assert ("rows:" in text) is bool(full)


def test_the_bounds_that_are_printed_as_an_example_are_read_without_their_marks(invoke) -> None:
    text = invoke("machines", "des").stdout
    example = re.findall(r"^# (occupant:|  .+)$", text, re.M)
    assert len(example) == 6
    assert not parse_machine(text, "printed.yaml").occupant.bounded
    bounded = parse_machine(text + "\n".join(example), "printed.yaml")
    assert bounded.occupant.gz == (-math.inf, 9.0)


@pytest.mark.parametrize("name", MACHINES)
def test_a_printed_machine_fits_into_a_profile(invoke, small: str, name: str) -> None:
    text = invoke("machines", name).stdout
    path = Path(small)
    described = path.read_text().replace("machine: des\n", f"machine:\n{indent(text, '  ')}")
    path.write_text(described)
    assert load_profile(path).machine == MACHINES[name]


def test_what_is_changed_in_a_printed_machine_changes_the_machine(invoke) -> None:
    text = invoke("machines", "des").stdout
    for name, before, feet in [
        ("L2", "19", 25.0), ("Lx", "3.9", 2.0), ("Ly", "0.012", 0.0), ("Lz", "0.012", 1.0),
        ("Lt", "2.76", 0.5),
    ]:  # fmt: skip
        assert f"{name}: {before}" in text
        changed = parse_machine(text.replace(f"{name}: {before}", f"{name}: {feet}"), "my.yaml")
        lengths = MACHINES["des"].lengths | {name: feet * FOOT_M}
        assert changed.rows == gimballed_centrifuge_rows(lengths)
        assert changed.name == "des (changed)"
    turned = parse_machine(text.replace("fork_axis: radial", "fork_axis: tangential"), "my.yaml")
    assert turned.rows == gimballed_centrifuge_rows(turned.lengths, fork_axis="tangential")
    slower = parse_machine(text.replace("rate_rad_s: 5.86", "rate_rad_s: 4"), "my.yaml")
    assert slower.limits[0].rate == 4.0
    assert slower.rows == MACHINES["des"].rows
    named = parse_machine(text.replace("# name: my machine", "name: mine"), "my.yaml")
    assert named == replace(MACHINES["des"], name="mine")


@pytest.mark.parametrize("name", ["des", "johnsville"])
def test_the_sketch_of_the_lengths_is_where_the_seat_is(invoke, name: str) -> None:
    text = invoke("machines", name).stdout
    sketch = re.sub(r"\s*#\s*", " ", text)
    outward, ahead = (
        np.array([1.0, 0.0, 0.0]),
        np.array([0.0, -1.0, 0.0]),
    )  # the arm turns about -k0
    words = {"down": [0, 0, -1], "up": [0, 0, 1], "outward": outward, "inward": -outward,
             "ahead": ahead}  # fmt: skip
    found = dict(re.findall(r"(L[xyzt]):? (down|up|outward|inward|ahead)", sketch))
    assert set(found) == {"Lx", "Ly", "Lz", "Lt"}
    for length, word in found.items():
        lengths = dict.fromkeys(CHAIN_LENGTHS, 0.0) | {length: 1.0}
        rows = gimballed_centrifuge_rows(lengths, fork_axis=read_chain(MACHINES[name].rows)[1])
        chain = chain_of(replace(MACHINES[name], rows=rows), Seat())
        np.testing.assert_allclose(seat_position(chain, np.zeros(3)), words[word], atol=1e-12)


ROWS = """\
name: gimbals
limits:
  arm: {angle: endless, rate_rad_s: 1, acceleration_rad_s2: 1}
  fork: {angle_deg: 180, rate_rad_s: 3, acceleration_rad_s2: 2}
  cab: {angle_rad: 4, rate_deg_s: 180, acceleration_rad_s2: 1}
lengths_m: {R: 7.3}
rows: [{theta: -arm}, {a: R, theta: fork}, {alpha_deg: 90, theta: cab}]
"""


@pytest.mark.parametrize(
    ("text", "rows"),
    [
        ("base: des\nlengths_m: {L2: 6.1}\noccupant: {gy_g: [-1, 1]}\nname: mine\n", False),
        ("base: covisart\nfork_axis: radial\nlimits: {arm: {jerk: unlimited}}\n", False),
        (ROWS, True),
        ("base: des\n" + ROWS, True),
    ],
)
def test_a_machine_of_a_file_is_printed_as_it_was_made(
    invoke, tmp_path: Path, text: str, rows: bool
) -> None:
    (tmp_path / "own.yaml").write_text(text)
    printed = invoke("machines", "own.yaml").stdout
    assert ("rows:" in printed) is rows
    machine = parse_machine(text, "own.yaml")
    assert parse_machine(printed, "printed") == machine
    assert parse_machine(json.dumps(machine_mapping(machine)), "stored") == machine


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
