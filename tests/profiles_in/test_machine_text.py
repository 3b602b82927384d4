"""A machine as the text of a file: it reads back to the last bit, and says what it holds."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from des_cli.model.machine import DHRow, JointLimits, Machine, OccupantBounds
from des_cli.model.machines import (
    CHAIN_LENGTHS,
    DES,
    FORK_AXES,
    JOHNSVILLE,
    MACHINES,
    ForkAxis,
    gimballed_centrifuge_rows,
)
from des_cli.profiles_in.machine_text import machine_text
from des_cli.profiles_in.machine_yaml import parse_machine

SIZE = st.floats(1e-6, 1e4)
ENDLESS = SIZE | st.just(math.inf)
BOUND = st.tuples(st.floats(-50.0, -0.1) | st.just(-math.inf), st.floats(0.1, 50.0))


@st.composite
def gimballed(draw: st.DrawFn) -> Machine:
    """A machine of named lengths with any numbers."""
    lengths = {name: draw(st.floats(0.0, 30.0)) for name in CHAIN_LENGTHS}
    axis: ForkAxis = draw(st.sampled_from(FORK_AXES))
    limits = [JointLimits(draw(ENDLESS), draw(SIZE), draw(SIZE), draw(ENDLESS)) for _ in range(3)]
    return Machine(
        name=draw(st.text("ab9\x7f\x85 -\"'#:{é😀\n\t", min_size=1, max_size=9)),
        rows=gimballed_centrifuge_rows(lengths, fork_axis=axis),
        limits=(limits[0], limits[1], limits[2]),
        gravity=draw(st.floats(0.1, 30.0)),
        lengths=lengths,
        source=draw(st.text("ab. :#", max_size=9)),
        occupant=draw(
            st.builds(OccupantBounds, gx=BOUND, gz=BOUND, g_onset=ENDLESS)
            | st.just(OccupantBounds())
        ),
    )


@settings(max_examples=20)
@given(machine=gimballed(), full=st.booleans())
def test_any_machine_reads_back_to_the_last_bit(machine: Machine, full: bool) -> None:
    assert parse_machine(machine_text(machine, full=full), "m.yaml") == machine


OWN = Machine(
    "own",
    (
        DHRow(variable="arm", sign=-1),
        DHRow(a=7.3, variable="fork", offset=-math.pi / 3),
        DHRow(alpha=math.pi / 2, d=-0.1, variable="cab"),
    ),
    DES.limits,
    lengths={"R": 7.3},
)


def test_rows_are_written_where_no_lengths_make_the_chain() -> None:
    text = machine_text(OWN)
    assert text == machine_text(OWN, full=True)
    assert parse_machine(text, "m.yaml") == OWN
    bent = replace(DES, name="bent", rows=(*DES.rows[:-1], DHRow(alpha=0.1)), lengths={})
    for machine in (bent, replace(DES, name="unnamed", lengths={})):
        text = machine_text(machine)
        assert "rows:" in text
        assert parse_machine(text, "m.yaml") == machine


@pytest.mark.parametrize("length", ["Lx", "a, b", "R: 1", "#R", " R", "{R", "é", "R\x7f"])
def test_the_name_of_a_length_reads_back_whatever_it_is(length: str) -> None:
    machine = replace(OWN, lengths={length: 7.3})
    assert parse_machine(machine_text(machine), "m.yaml") == machine


def test_without_rows_another_length_makes_another_machine() -> None:
    machine = replace(JOHNSVILLE, name="mine")
    text = machine_text(machine).replace("L2: 50", "L2: 25")
    lengths = {**machine.lengths, "L2": 25 * 0.3048}
    rows = gimballed_centrifuge_rows(lengths, fork_axis="tangential")
    assert parse_machine(text, "m.yaml") == replace(machine, lengths=lengths, rows=rows)


@pytest.mark.parametrize("name", MACHINES)
def test_a_built_in_machine_is_told_as_its_base(name: str) -> None:
    machine = MACHINES[name]
    text = machine_text(machine)
    assert f"base: {name}\n" in text
    assert not re.search("^(name|source|rows):", text, re.M)
    assert parse_machine(text, "m.yaml") == machine
    changed = machine_text(replace(machine, gravity=9.0))
    assert f'name: "{name}"\n' in changed
    assert not re.search("^(base|rows):", changed, re.M)


def test_numbers_stand_in_the_unit_in_which_they_are_short() -> None:
    turn = JointLimits(math.radians(200.0), 2.5, math.radians(37.0), math.inf)
    text = machine_text(replace(JOHNSVILLE, limits=(turn, turn, turn)))
    line = "{angle_deg: 200, rate_rad_s: 2.5, acceleration_deg_s2: 37, jerk: unlimited}"
    assert f"  arm: {line}\n  fork: {line}\n  cab: {line}\n" in text
    assert "\nlengths_ft: {L2: 50, Lx: 0, Ly: 0, Lz: 0, Lt: 0}\n" in text
    assert "\ngravity_ft_s2: 32.2\n" in machine_text(DES)


def test_bounds_are_written_as_they_are_and_as_an_example_where_there_are_none() -> None:
    bounded = replace(DES, occupant=OccupantBounds(gz=(-math.inf, 9.0), g_onset=6.0))
    text = machine_text(bounded)
    assert "\noccupant:\n  gz_g: [null, 9.0]\n  g_onset_g_s: 6.0\n" in text
    assert "# occupant:" not in text
    assert "\n# occupant:\n#   gx_g: [-4, 8]\n" in machine_text(DES)
