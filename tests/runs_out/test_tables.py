"""Tables: the contract's columns, and doubles that read back bit for bit."""

import csv
import io
import json
import math
import subprocess
import sys
from collections.abc import Callable

import numpy as np
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st

from des_cli.errors import NotReleasedError
from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.response import acceleration_parts
from des_cli.model.arrays import Floats
from des_cli.model.motion import mean_of_sides
from des_cli.model.run import Run
from des_cli.runs_out.tables import (
    TABLE_FORMATS,
    TableFormat,
    command_columns,
    encode_table,
    trajectory_columns,
    trajectory_names,
)

MakeRun = Callable[..., Run]

JOINT_COLUMNS = [
    f"{joint}_{unit}"
    for joint in ("arm", "fork", "cab")
    for unit in ("rad", "rad_s", "rad_s2", "rad_s3")
]
VECTOR_COLUMNS = [
    "coriolis_ab3_before_rad_s2",
    "coriolis_ab3_after_rad_s2",
    "coriolis_bb3_before_rad_s2",
    "coriolis_bb3_after_rad_s2",
    "coriolis_cb3_before_rad_s2",
    "coriolis_cb3_after_rad_s2",
    "coriolis_seat_x_before_rad_s2",
    "coriolis_seat_x_after_rad_s2",
    "coriolis_seat_y_before_rad_s2",
    "coriolis_seat_y_after_rad_s2",
    "coriolis_seat_z_before_rad_s2",
    "coriolis_seat_z_after_rad_s2",
    "seat_gx_before_g",
    "seat_gx_after_g",
    "seat_gy_before_g",
    "seat_gy_after_g",
    "seat_gz_before_g",
    "seat_gz_after_g",
    "seat_p_before_rad_s",
    "seat_p_after_rad_s",
    "seat_q_before_rad_s",
    "seat_q_after_rad_s",
    "seat_r_before_rad_s",
    "seat_r_after_rad_s",
    "seat_angular_acceleration_x_before_rad_s2",
    "seat_angular_acceleration_x_after_rad_s2",
    "seat_angular_acceleration_y_before_rad_s2",
    "seat_angular_acceleration_y_after_rad_s2",
    "seat_angular_acceleration_z_before_rad_s2",
    "seat_angular_acceleration_z_after_rad_s2",
]
SPLIT_COLUMNS = [
    f"seat_{part}_{axis}_{when}_g"
    for part in ("tangential", "centripetal", "coriolis")
    for axis in "xyz"
    for when in ("before", "after")
]


def read_back(data: bytes, table_format: TableFormat) -> dict[str, list[float]]:
    """Read a table with a reader that shares nothing with the writer."""
    if table_format == "parquet":
        return pq.read_table(io.BytesIO(data)).to_pydict()
    if table_format == "csv":
        rows = list(csv.DictReader(io.StringIO(data.decode())))
    elif table_format == "json":
        rows = json.loads(data)
    else:
        rows = [json.loads(line) for line in data.decode().splitlines()]
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def bits(values: object) -> list[int]:
    return np.asarray(values, dtype=np.float64).view(np.int64).tolist()


@pytest.mark.parametrize("table_format", TABLE_FORMATS)
@given(
    values=st.lists(
        st.tuples(*[st.floats(allow_nan=False, allow_infinity=False)] * 2), min_size=1, max_size=50
    )
)
def test_every_double_reads_back_bit_for_bit(
    table_format: TableFormat, values: list[tuple[float, float]]
) -> None:
    columns = dict(zip(("t_s", "arm %rpm"), np.array(values).T, strict=True))
    found = read_back(encode_table(columns, table_format), table_format)
    assert list(found) == list(columns)
    for name, column in columns.items():
        assert bits(found[name]) == bits(column)


@pytest.mark.parametrize("table_format", TABLE_FORMATS)
def test_a_long_table_is_whole_and_in_order(table_format: TableFormat) -> None:
    t = np.arange(150_000) / 7.0
    found = read_back(encode_table({"t_s": t, "arm_rpm": -t}, table_format), table_format)
    assert bits(found["t_s"]) == bits(t)
    assert bits(found["arm_rpm"]) == bits(-t)


@pytest.mark.parametrize("table_format", TABLE_FORMATS)
def test_the_same_table_gives_the_same_bytes(
    table_format: TableFormat, synthetic_run: MakeRun
) -> None:
    first, second = (
        encode_table(trajectory_columns(synthetic_run()), table_format) for _ in range(2)
    )
    assert first == second


def test_csv_starts_with_its_header_and_ends_with_a_newline(synthetic_run: MakeRun) -> None:
    lines = encode_table(command_columns(synthetic_run(11)), "csv").decode().split("\n")
    assert lines[0] == "t_s,arm_rpm,fork_deg,cab_deg"
    assert len(lines) == 13
    assert lines[-1] == ""


@pytest.mark.parametrize("table_format", TABLE_FORMATS)
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_a_value_that_is_no_number_is_refused_by_column_and_row(
    table_format: TableFormat, bad: float
) -> None:
    good = np.arange(4.0)
    one, two = good.copy(), good.copy()
    one[2], two[[0, 3]] = bad, bad
    with pytest.raises(NotReleasedError) as caught:
        encode_table({"t_s": good, "fork_deg": one, "cab_deg": two}, table_format)
    lines = [str(problem) for problem in caught.value.complaints]
    assert lines[0].startswith("fork_deg: 1 of 4 values")
    assert "in row 3" in lines[0]
    assert lines[1].startswith("cab_deg: 2 of 4 values")
    assert len(lines) == 2


@pytest.mark.parametrize("columns", [{"a": np.ones(3), "b": np.ones(2)}, {"a": np.ones((2, 2))}])
def test_columns_are_vectors_of_one_length(columns: dict[str, Floats]) -> None:
    with pytest.raises(ValueError, match="one length"):
        encode_table(columns, "csv")


def test_commands_give_the_modified_motion_in_their_units(synthetic_run: MakeRun) -> None:
    run = synthetic_run(101, control="per-joint")
    motion = run.solution.modified
    found = read_back(encode_table(command_columns(run), "csv"), "csv")
    expected = {
        "t_s": motion.t,
        "arm_rpm": motion.rate[:, 0] * (30 / math.pi),
        "fork_deg": np.degrees(motion.angle[:, 1]),
        "cab_deg": np.degrees(motion.angle[:, 2]),
    }
    for name, column in expected.items():
        np.testing.assert_allclose(found[name], column, rtol=1e-15, atol=0.0)


def test_trajectory_has_the_columns_of_the_contract(synthetic_run: MakeRun) -> None:
    motions = [f"{which}_{name}" for which in ("desired", "modified") for name in JOINT_COLUMNS]
    adjoint = ["adjoint_arm", "adjoint_fork", "adjoint_cab"]
    asked = [f"asked_{name}" for name in JOINT_COLUMNS]
    rest = [*adjoint, *VECTOR_COLUMNS, *SPLIT_COLUMNS, *asked]
    scalar = trajectory_columns(synthetic_run(11))
    joints = trajectory_columns(synthetic_run(11, control="per-joint"))
    assert list(scalar) == ["t_s", *motions, "p", *rest] == list(trajectory_names(1))
    assert list(joints) == ["t_s", *motions, "p_arm", "p_fork", "p_cab", *rest]
    assert {values.shape for values in joints.values()} == {(11,)}


def test_trajectory_columns_hold_what_their_names_say(synthetic_run: MakeRun) -> None:
    run = synthetic_run(101, control="per-joint")
    columns = trajectory_columns(run)
    modified = run.solution.modified
    for i, joint in enumerate(("arm", "fork", "cab")):
        np.testing.assert_array_equal(columns[f"modified_{joint}_rad"], modified.angle[:, i])
        np.testing.assert_array_equal(columns[f"modified_{joint}_rad_s"], modified.rate[:, i])
        np.testing.assert_array_equal(columns[f"p_{joint}"], run.solution.control[:, i])
        np.testing.assert_array_equal(columns[f"adjoint_{joint}"], run.solution.adjoint[:, i])
        acceleration = columns[f"desired_{joint}_rad_s2"]
        interval = run.desired.acceleration[:, i]
        assert acceleration[0] == interval[0]
        assert acceleration[-1] == interval[-1]
        np.testing.assert_allclose(acceleration[1:-1], (interval[:-1] + interval[1:]) / 2)
        jerk, change = columns[f"modified_{joint}_rad_s3"], np.diff(modified.acceleration[:, i])
        steps = np.abs(modified.rate_step[:, i]) > 1e-9
        np.testing.assert_allclose(jerk[1:-1], np.where(steps, 0.0, change / 0.1), rtol=1e-9)
        assert steps.any() == (joint == "cab")
        assert (jerk[0], jerk[-1]) == (jerk[1], jerk[-2])
    chain = chain_of(run.profile.machine, run.profile.seat)
    for when, response, motion in (
        ("before", run.before, run.asked.motion),
        ("after", run.after, modified),
    ):
        parts = acceleration_parts(chain, motion)
        for i, axis in enumerate("pqr"):
            rate = mean_of_sides(response.seat_rate)[:, i]
            np.testing.assert_array_equal(columns[f"seat_{axis}_{when}_rad_s"], rate)
        for i, axis in enumerate("xyz"):
            name = f"seat_angular_acceleration_{axis}_{when}_rad_s2"
            total = mean_of_sides(response.seat_angular_acceleration)[:, i]
            np.testing.assert_array_equal(columns[name], total)
        for i, name in enumerate(("ab3", "bb3", "cb3")):
            expected = mean_of_sides(response.coriolis_report)[:, i]
            np.testing.assert_array_equal(columns[f"coriolis_{name}_{when}_rad_s2"], expected)
        for i, axis in enumerate("xyz"):
            seat = mean_of_sides(response.coriolis_seat)[:, i]
            np.testing.assert_array_equal(columns[f"coriolis_seat_{axis}_{when}_rad_s2"], seat)
            felt = mean_of_sides(response.seat_g)[:, i]
            np.testing.assert_array_equal(columns[f"seat_g{axis}_{when}_g"], felt)
            for k, part in enumerate(("tangential", "centripetal", "coriolis")):
                share = mean_of_sides(parts)[:, k, i]
                np.testing.assert_array_equal(columns[f"seat_{part}_{axis}_{when}_g"], share)


def test_a_free_motion_has_no_columns_for_factors_and_adjoint(synthetic_run: MakeRun) -> None:
    scalar, free = (trajectory_columns(synthetic_run(11, control=c)) for c in ("scalar", "free"))
    assert set(scalar) - set(free) == {"p", "adjoint_arm", "adjoint_fork", "adjoint_cab"}
    assert list(free) == list(trajectory_names(0, adjoint=False))


def test_the_commands_have_the_leads_and_the_trajectory_has_the_maneuver(
    synthetic_run: MakeRun,
) -> None:
    run = synthetic_run(101, leads=2.0)
    commands = command_columns(run)
    assert (commands["t_s"][0], commands["t_s"][-1], len(commands["t_s"])) == (-2.0, 12.0, 103)
    # at the step from rest a velocity command is the mean of both sides
    rpm = run.solution.modified.rate_start[0, 0] * (30 / math.pi)
    np.testing.assert_allclose(commands["arm_rpm"][:2], [0.0, rpm / 2], rtol=1e-12)
    np.testing.assert_array_equal(trajectory_columns(run)["t_s"], run.solution.modified.t)


def test_a_motion_of_one_interval_has_a_trajectory(synthetic_run: MakeRun) -> None:
    columns = trajectory_columns(synthetic_run(2))
    assert {len(values) for values in columns.values()} == {2}


def test_text_formats_need_neither_pandas_nor_pyarrow(python_environment: dict[str, str]) -> None:
    script = """
import sys
import numpy as np
from des_cli.runs_out.tables import encode_table
for name in ("csv", "ndjson", "json"):
    encode_table({"t_s": np.arange(3.0)}, name)
print(*sorted({"pandas", "pyarrow", "matplotlib"} & set(sys.modules)))
"""
    ended = subprocess.run(
        [sys.executable, "-c", script], env=python_environment, check=True, capture_output=True
    )
    assert ended.stdout.split() == []
