"""Machines in YAML: changed, rescaled, described row by row, shown and read back."""

from __future__ import annotations

import io
import math

import pytest
from ruamel.yaml import YAML

from des_cli.errors import ProfileError
from des_cli.model.machine import DHRow, JointLimits, Machine, OccupantBounds
from des_cli.model.machines import DES, gimballed_centrifuge_rows
from des_cli.profiles_in.machine_yaml import machine_mapping, parse_machine
from des_cli.units import FOOT_M

LIMITS = """\
limits:
  arm: {angle: endless, rate_rpm: 30, acceleration_deg_s2: 90}
  fork: {angle_deg: 180, rate_rad_s: 3, acceleration_rad_s2: 2}
  cab: {angle_rad: 4, rate_deg_s: 180, acceleration_rad_s2: 1}
"""
ROWS = """\
rows:
  - {theta: -arm}
  - {a_ft: 10, theta_deg: 90}
  - {alpha_deg: 90, theta: "fork + pi/2"}
  - {alpha_rad: -1.5, a: -Lx, theta: cab}
  - {d: Ly, theta: "-seat_yaw - pi/4"}
  - {d_m: -0.5, theta: "pi/3"}
lengths_m: {Lx: 2, Ly: 0.25}
"""


def problems_of(text: str) -> list[str]:
    with pytest.raises(ProfileError) as caught:
        parse_machine(text, "m.yaml")
    return [str(problem) for problem in caught.value.complaints]


def test_a_base_is_changed_where_something_is_said() -> None:
    text = "{base: des, limits: {fork: {rate_deg_s: 90}}, gravity_m_s2: 9.81, name: mine}"
    machine = parse_machine(text, "m.yaml")
    assert machine.name == "mine"
    assert machine.rows == DES.rows
    assert machine.gravity == 9.81
    assert machine.limits == (DES.limits[0], JointLimits(2 * math.pi, math.pi / 2, 2.5, 5.0),
                              DES.limits[2])  # fmt: skip


def test_lengths_rescale_the_chain_and_the_fork_axis_turns_it() -> None:
    machine = parse_machine("{base: des, lengths_ft: {L2: 25}}", "m.yaml")
    lengths = dict(DES.lengths) | {"L2": 25 * FOOT_M}
    assert machine.rows == gimballed_centrifuge_rows(lengths)
    assert machine.lengths == lengths
    turned = parse_machine("{base: des, fork_axis: tangential}", "m.yaml")
    assert turned.rows == gimballed_centrifuge_rows(DES.lengths, fork_axis="tangential")


def test_a_machine_of_its_own_lengths_and_limits() -> None:
    text = LIMITS + "lengths_m: {L2: 6, Lx: 1, Ly: 0, Lz: 0, Lt: 0.8}\n"
    machine = parse_machine(text, "m.yaml")
    assert machine.rows == gimballed_centrifuge_rows(machine.lengths)
    arm, fork, cab = machine.limits
    # nothing is said of the jerk: 2 1/s times the acceleration
    assert arm == JointLimits(math.inf, math.pi, math.pi / 2, math.pi)
    assert fork == JointLimits(math.pi, 3, 2, 4)
    assert cab == JointLimits(4, math.pi, 1, 2)
    assert machine.gravity == DES.gravity


def test_rows_are_read_as_written() -> None:
    machine = parse_machine(LIMITS + ROWS, "m.yaml")
    quarter = math.pi / 2
    assert machine.rows == (
        DHRow(variable="arm", sign=-1),
        DHRow(a=10 * FOOT_M, offset=quarter),
        DHRow(alpha=quarter, variable="fork", offset=quarter),
        DHRow(alpha=-1.5, a=-2.0, variable="cab"),
        DHRow(d=0.25, variable="seat_yaw", sign=-1, offset=-math.pi / 4),
        DHRow(d=-0.5, offset=math.pi / 3),
    )


def test_jerk_is_given_in_either_unit_or_switched_off() -> None:
    text = (
        LIMITS.replace("rpm: 30,", "rpm: 30, jerk_rad_s3: 3,")
        .replace("rate_rad_s: 3,", "rate_rad_s: 3, jerk_deg_s3: 90,")
        .replace("rate_deg_s: 180,", "rate_deg_s: 180, jerk: unlimited,")
    )
    limits = parse_machine(text + ROWS, "m.yaml").limits
    assert [each.jerk for each in limits] == [3.0, pytest.approx(math.pi / 2), math.inf]
    based = parse_machine("{base: des, limits: {cab: {jerk: unlimited}}}", "m.yaml")
    assert [each.jerk for each in based.limits] == [*(e.jerk for e in DES.limits[:2]), math.inf]


def test_occupant_bounds_are_read_one_by_one() -> None:
    assert parse_machine("{base: des}", "m.yaml").occupant == OccupantBounds()
    text = """\
base: des
occupant: {gx_g: [-4, 8], gy_g: [-1.5, 1.5], gz_g: [null, 9], g_onset_g_s: 6,
  seat_angular_acceleration_deg_s2: 180}
"""
    found = parse_machine(text, "m.yaml").occupant
    assert found == OccupantBounds((-4, 8), (-1.5, 1.5), (-math.inf, 9), 6, math.pi)


OCCUPANT = """\
occupant: {gx_g: [-4.1, null], gy_g: [-1.3, 1.7], g_onset_g_s: 5.9,
  seat_angular_acceleration_rad_s2: 0.7}
"""
NO_JERK = LIMITS.replace("angle_rad: 4", "angle_rad: 4, jerk: unlimited")


@pytest.mark.parametrize("text", ["{base: des}", LIMITS + ROWS, NO_JERK + ROWS + OCCUPANT])
def test_a_machine_that_is_shown_reads_back_bit_for_bit(text: str) -> None:
    machine: Machine = DES if "base" in text else parse_machine(text, "m.yaml")
    stream = io.StringIO()
    YAML().dump(machine_mapping(machine), stream)
    assert parse_machine(stream.getvalue(), "m.yaml") == machine


@pytest.mark.parametrize(
    ("text", "where", "words"),
    [
        (LIMITS, "m.yaml:1:1", "the lengths L2, Lx, Ly, Lz, Lt must be given"),
        (LIMITS + "lengths_m: {L2: 6, Lx: 1, Ly: 0, Lz: 0}\n", "lengths_m", "the length Lt must"),
        (ROWS, "m.yaml:1:1: limits.arm", "the arm's angle limit is missing"),
        (ROWS, "m.yaml:1:1: limits.cab", "the cab's acceleration limit is missing"),
        (LIMITS.replace(", rate_rpm: 30", "") + ROWS, "2:8: limits.arm", "give rate_rad_s"),
        ("{base: dse}", "m.yaml:1:8: base", "did you mean des?"),
        ("{base: des, lengths_ft: {L22: 1}}", "lengths_ft.L22", "did you mean L2?"),
        (LIMITS + ROWS.replace(", theta: cab", ""), "rows", "the cab turns in no row"),
        (LIMITS + ROWS.replace("theta: cab", "theta: arm"), "rows", "the arm turns in 2 rows"),
        (LIMITS + ROWS.replace("a: -Lx", "a: -Lq"), "rows[3].a", "Lq is not among the lengths"),
        (LIMITS + ROWS + "fork_axis: radial\n", "fork_axis", "says nothing beside rows"),
        ("- 1\n", "m.yaml:1:1", "must be a mapping"),
    ],
)  # fmt: skip
def test_a_mistake_is_named(text: str, where: str, words: str) -> None:
    lines = problems_of(text)
    assert any(where in line and words in line for line in lines), lines


def test_joints_in_another_order_and_a_seat_before_the_cab_are_refused() -> None:
    swapped = LIMITS + ROWS.replace("-arm", "x").replace('"fork +', '"-arm +').replace(
        "x}", "fork}"
    )
    (line,) = problems_of(swapped)
    assert "the joints stand in the order fork, arm, cab" in line
    early = LIMITS + ROWS.replace("theta_deg: 90", "theta: seat_pitch")
    (line,) = problems_of(early)
    assert "rows[1]: seat_pitch turns before the cab" in line


def test_all_mistakes_come_at_once() -> None:
    lines = problems_of("limits: {arm: {angle: endless}}\nlengths_m: {L2: 1}\n")
    assert len(lines) == 9  # two limits of the arm, three each of fork and cab, the lengths
