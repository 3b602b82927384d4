"""``kinematics``: the reference states, every format, and what is refused."""

from __future__ import annotations

import csv
import io
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from des_cli.cli import kinematics as module
from des_cli.kinematics.commanded_motion import make_desired
from des_cli.model.machine import JOINTS
from des_cli.profiles_in.load import load_profile
from des_cli.runs_out.state_tables import state_columns
from des_cli.study.state import report_motion
from des_cli.units import FOOT_M
from tests.support.state_commands import SPIN, of

REFERENCE = json.loads(
    (Path(__file__).parents[1] / "data" / "kinematics_reference.json").read_text()
)["states"]


# The reference's name of a quantity, ours, and how many feet ours is a metre of.
SAME = (
    ("J1", "j1_m", FOOT_M),
    ("det_J1", "j1_determinant_m3", FOOT_M**3),
    ("J2_eq32", "j2", 1),
    ("J_inertial", "ground_jacobian", 1),
    ("J_body_frame17", "body_jacobian", 1),
    ("det_J2", "orientation_determinant", 1),
    ("W_inertial", "w_ground_rad_s", 1),
    ("W_body", "w_seat_rad_s", 1),
    ("W_dot_16_18", "angular_acceleration_rad_s2", 1),
    ("Wc_dot_22_24", "coriolis_rad_s2", 1),
    ("W_dot_body", "angular_acceleration_seat_rad_s2", 1),
    ("Wc_dot_body", "coriolis_seat_rad_s2", 1),
    ("seat_velocity_inertial", "seat_velocity_m_s", FOOT_M),
    ("a_inertial_ftps2", "seat_acceleration_m_s2", FOOT_M),
    ("a_body_g_no_gravity", "seat_acceleration_g", 1),
    ("specific_force_body_g_with_gravity", "specific_force_g", 1),
)


def options_of(state: dict[str, Any]) -> list[str]:
    vectors = (("rad", "q"), ("rad-s", "qd"), ("rad-s2", "qdd"))
    numbers = [
        (f"--{joint}-{unit}", value)
        for unit, name in vectors
        for joint, value in zip(JOINTS, state[name], strict=True)
    ]
    numbers += [("--seat-yaw-rad", state["theta_sy"]), ("--seat-pitch-rad", state["theta_st"])]
    return [word for option, value in numbers for word in (option, repr(value))]


@pytest.mark.parametrize("state", REFERENCE, ids=lambda state: state["name"])
def test_reference_states_come_out(invoke, state: dict[str, Any]) -> None:
    found = of(invoke, *options_of(state))
    close = {"rtol": 1e-9, "atol": 5.1e-11}  # the reference has ten decimals
    for theirs, ours, metre in SAME:
        if isinstance(state[theirs], dict):
            assert set(found[ours]) == set(state[theirs])
            for part, value in state[theirs].items():
                np.testing.assert_allclose(np.array(found[ours][part]) / metre, value, **close)
        else:
            np.testing.assert_allclose(np.array(found[ours]) / metre, state[theirs], **close)
    transform = np.array(found["t_0_17"])
    np.testing.assert_array_equal(transform[:3, 3], found["seat_position_m"])
    transform[:3, 3] /= FOOT_M
    np.testing.assert_allclose(transform, state["T_0_17"], **close)
    np.testing.assert_allclose(
        found["w_eq32_rad_s"], np.array(state["M_seat"]) @ state["W_inertial"], **close
    )
    np.testing.assert_allclose(
        found["singular_value"], np.linalg.svd(state["J_body_frame17"])[1], **close
    )
    x, y, z = state["specific_force_body_g_with_gravity"]
    np.testing.assert_allclose(found["seat_g"], [x, y, -z], **close)


def test_machine_by_name_and_from_a_file(invoke, tmp_path: Path) -> None:
    named = of(invoke, "--machine", "johnsville", "--arm-rad-s", "2")
    (tmp_path / "own.yaml").write_text(invoke("machines", "johnsville").stdout)
    assert of(invoke, "--machine", "own.yaml", "--arm-rad-s", "2") == named
    # (2 rad/s)^2 at 50 ft
    assert np.linalg.norm(named["seat_acceleration_g"]["total"]) == pytest.approx(200 / 32.2)


def test_table_formats_say_the_same_and_read_back(invoke) -> None:
    csv_text = invoke("kinematics", *SPIN, "--format", "csv").stdout
    [row] = csv.DictReader(io.StringIO(csv_text))
    parquet = invoke("kinematics", *SPIN, "--format", "parquet")
    table = pq.read_table(io.BytesIO(parquet.stdout_bytes)).to_pydict()
    assert {name: [float(value)] for name, value in row.items()} == table
    found = of(invoke, *SPIN)
    [line] = invoke("kinematics", *SPIN, "--format", "ndjson").stdout.splitlines()
    assert json.loads(line).items() <= found.items()
    assert [float(row[f"coriolis_{name}_rad_s2"]) for name in ("ab3", "bb3", "cb3")] == (
        found["coriolis_rad_s2"]
    )
    assert (
        float(row["seat_acceleration_coriolis_j0_m_s2"])
        == (found["seat_acceleration_m_s2"]["coriolis"][1])
    )
    assert float(row["j1_k0_cab_m"]) == found["j1_m"][2][2]


@pytest.mark.parametrize("form", ["json", "ndjson"])
def test_a_profile_gives_an_object_a_sample(invoke, small: str, form: str) -> None:
    text = invoke("kinematics", small, "--format", form).stdout
    rows = json.loads(text) if form == "json" else [json.loads(x) for x in text.splitlines()]
    motion = make_desired(load_profile(small)).motion
    assert [row["t_s"] for row in rows] == motion.t.tolist()
    assert [row["angle_rad"] for row in rows] == motion.angle.tolist()
    alone = of(invoke, *_options_of_row(rows[7]))
    for name in ("t_0_17", "coriolis_rad_s2", "seat_g", "w_eq32_rad_s"):
        np.testing.assert_allclose(rows[7][name], alone[name], rtol=0, atol=1e-14)


def _options_of_row(row: dict[str, Any]) -> list[str]:
    vectors = (("rad", "angle_rad"), ("rad-s", "rate_rad_s"), ("rad-s2", "acceleration_rad_s2"))
    pairs = [
        (f"--{joint}-{unit}", value)
        for unit, name in vectors
        for joint, value in zip(JOINTS, row[name], strict=True)
    ]
    return [word for option, value in pairs for word in (option, repr(value))]


def test_a_profile_gives_a_row_a_sample(invoke, small: str) -> None:
    profile = load_profile(small)
    motion = make_desired(profile).motion
    expected = state_columns(report_motion(profile.machine, profile.seat, motion), motion.t)
    rows = list(csv.reader(io.StringIO(invoke("kinematics", small, "--format", "csv").stdout)))
    assert rows[0] == list(expected)
    np.testing.assert_array_equal(
        np.array(rows[1:], float), np.column_stack(list(expected.values()))
    )


def test_a_profile_from_stdin_and_by_name_with_settings(invoke, small: str) -> None:
    from_file = invoke("kinematics", small, "--format", "csv").stdout
    piped = invoke("kinematics", "-", "--format", "csv", input=Path(small).read_bytes())
    assert piped.stdout == from_file
    coarse = invoke("kinematics", "cobra", "--set", "time.step_s=2.5", "--format", "csv")
    assert len(coarse.stdout.splitlines()) == 1 + 5
    csv_profile = "t,arm_rpm,fork_deg,cab_deg\n0,10,0,0\n0.5,10,2,0\n1,10,3,0\n"
    renamed = invoke(
        "kinematics", "-", "--column", "t_s=t", "--format", "ndjson", input=csv_profile
    )
    assert len(renamed.stdout.splitlines()) == 3
    tabs = csv_profile.replace(",", "\t").replace("t\t", "t_s\t", 1)
    args = ("--separator", "tab", "--format", "ndjson")
    assert invoke("kinematics", "-", *args, input=tabs).stdout == renamed.stdout


def test_a_pipe_gets_json(invoke, small: str) -> None:
    assert json.loads(invoke("kinematics", *SPIN).stdout)["rate_rad_s"] == [2, -0.5, 1]
    assert len(json.loads(invoke("kinematics", small).stdout)) == 21


def test_a_terminal_gets_text(python_environment: dict[str, str], tmp_path: Path) -> None:
    pty = pytest.importorskip("pty")
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "des_cli", "kinematics", *SPIN]
    done = subprocess.run(command, stdout=theirs, env=python_environment, cwd=tmp_path, check=False)
    os.close(theirs)
    shown = os.read(ours, 1 << 16).decode()
    os.close(ours)
    assert done.returncode == 0
    assert shown.startswith("Machine des, seat yaw 90 deg, pitch 0 deg")


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["--arm-rpm", "1", "--arm-rad-s", "2"], "--arm-rpm and --arm-rad-s"),
        (["--seat-yaw-deg", "1", "--seat-yaw-rad", "2"], "--seat-yaw-deg and --seat-yaw-rad"),
        (["--fork-deg", "nan"], "--fork-deg"),
        (["--cab-rad-s", "1e300"], "--cab-rad-s"),
        (["--arm", "3"], "--arm"),
        (["cobra", "--arm-deg", "3", "--cab-rpm", "1"], "--arm-deg, --cab-rpm"),
        (["--set", "time.step_s=1"], "--set"),
    ],
    ids=lambda value: "_".join(value) if isinstance(value, list) else "",
)
def test_wrong_use(invoke, args: list[str], said: str) -> None:
    result = invoke("kinematics", *args)
    assert (result.exit_code, result.stdout) == (2, "")
    assert said in result.stderr


def test_parquet_is_refused_on_a_terminal(invoke, monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal:
        def isatty(self) -> bool:
            return True

    class System:
        stdout = Terminal()

    monkeypatch.setattr(module, "sys", System)
    result = invoke("kinematics", "--format", "parquet")
    assert (result.exit_code, result.stdout) == (2, "")
    assert "redirect" in result.stderr


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("base: des\nlimts: {}\n", "did you mean limits"),
        ("name: own\n", "limit is missing"),
        ("base: des\ngravity_m_s2: -3\n", "gravity_m_s2"),
        ("base: des\nlengths_m: {L2: .nan}\n", "L2"),
    ],
)
def test_a_bad_machine_is_named_with_its_place(
    invoke, tmp_path: Path, text: str, said: str
) -> None:
    (tmp_path / "own.yaml").write_text(text)
    result = invoke("kinematics", "--machine", "own.yaml")
    assert (result.exit_code, result.stdout) == (3, "")
    assert said in result.stderr
    assert all(line.startswith("own.yaml") for line in result.stderr.splitlines())


def test_the_motion_of_a_profile_on_another_machine(invoke) -> None:
    arguments = ("kinematics", "cobra", "--set", "time.step_s=1", "--format", "csv")
    (set_so,) = {invoke(*arguments, "--set", "machine=johnsville").stdout}
    assert invoke(*arguments, "--machine", "johnsville").stdout == set_so
    assert invoke(*arguments).stdout != set_so


def test_a_machine_that_is_not_there(invoke) -> None:
    unknown = invoke("kinematics", "--machine", "covisat")
    assert (unknown.exit_code, unknown.stdout) == (3, "")
    assert "--machine: there is no built-in machine covisat (did you mean covisart?)" in (
        unknown.stderr
    )
    missing = invoke("kinematics", "--machine", "none.yaml")
    assert (missing.exit_code, missing.stdout) == (1, "")
    assert missing.stderr.startswith("none.yaml: ")


def test_a_rejected_profile_is_3(invoke) -> None:
    result = invoke("kinematics", "-", input="format: des-coriolis/1\n")
    assert (result.exit_code, result.stdout) == (3, "")
