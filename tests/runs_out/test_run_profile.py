"""A run as a profile: its table is played with the seat as it was found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from des_cli.model.machine import Seat
from des_cli.model.machines import DES
from des_cli.model.profile import JointCommands
from des_cli.model.run import Run
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.yaml_nodes import parse_yaml
from des_cli.runs_out.run_profile import encode_run_profile
from des_cli.runs_out.tables import command_columns, encode_table


def test_it_reads_back_as_the_motion_of_the_table(
    tmp_path: Path, synthetic_run: Callable[..., Run]
) -> None:
    made = synthetic_run(101, name="a name, of (its) own")
    run = replace(
        made,
        profile=replace(made.profile, machine=DES),
        seat=Seat(yaw=1.234567890123456, pitch=-0.1),
    )
    (tmp_path / "table.csv").write_bytes(encode_table(command_columns(run), "csv"))
    (tmp_path / "profile.yaml").write_bytes(encode_run_profile(run, "table.csv"))
    profile = load_profile(tmp_path / "profile.yaml")
    assert profile.name == run.profile.name
    assert profile.machine == DES
    assert profile.seat == run.seat
    assert isinstance(profile.command, JointCommands)
    np.testing.assert_array_equal(profile.t, run.commands.t)
    np.testing.assert_allclose(profile.command.position, run.commands.angle[:, 1:], rtol=1e-14)
    np.testing.assert_allclose(profile.command.arm_rate, run.commands.rate[:, 0], rtol=1e-14)
    assert profile.initial_angle[0] == run.commands.angle[0, 0]


def test_a_machine_of_its_own_is_written_out(
    tmp_path: Path, synthetic_run: Callable[..., Run]
) -> None:
    fork = replace(DES.limits[1], rate=0.125)
    machine = replace(DES, name="changed", limits=(DES.limits[0], fork, DES.limits[2]))
    made = synthetic_run(11)
    run = replace(made, profile=replace(made.profile, machine=machine))
    (tmp_path / "t.csv").write_bytes(encode_table(command_columns(run), "csv"))
    (tmp_path / "p.yaml").write_bytes(encode_run_profile(run, "t.csv"))
    found = load_profile(tmp_path / "p.yaml").machine
    assert (found.limits, found.rows) == (machine.limits, machine.rows)


@pytest.mark.parametrize("name", ["own", "a: b", "é😀", "a\x85b", "a\x7fb"])
def test_the_name_of_the_machine_reads_back_whatever_it_holds(
    name: str, synthetic_run: Callable[..., Run]
) -> None:
    run = synthetic_run(11)
    machine = replace(run.profile.machine, name=name)
    made = encode_run_profile(replace(run, profile=replace(run.profile, machine=machine)), "c.csv")
    found = parse_yaml(made.decode(), "profile.yaml").plain()
    assert found["machine"]["name"] == name
    assert found["samples"] == {"file": "c.csv"}
