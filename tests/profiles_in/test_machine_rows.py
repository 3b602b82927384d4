"""Chains of a machine's section: rows that follow the lengths, and rows that do not."""

from __future__ import annotations

import pytest

from des_cli.errors import ProfileError
from des_cli.model.machines import DES, gimballed_centrifuge_rows
from des_cli.profiles_in.machine_text import machine_text
from des_cli.profiles_in.machine_yaml import parse_machine

WITH_ROWS = machine_text(DES, full=True)
LIMITS = "base: des\n"
OWN = LIMITS + "rows: [{theta: -arm}, {a_m: 7.3, theta: fork}, {alpha_deg: 90, theta: cab}]\n"


def problems_of(text: str) -> list[str]:
    with pytest.raises(ProfileError) as caught:
        parse_machine(text, "m.yaml")
    return [str(problem) for problem in caught.value.complaints]


def edited(name: str, text: str = WITH_ROWS, length: float = 6.0) -> str:
    """Change a length beside rows of numbers."""
    before = f"{name}: {DES.lengths[name]!r}"
    assert before in text
    return text.replace(before, f"{name}: {length!r}")


@pytest.mark.parametrize("name", ["L2", "Lx", "Ly", "Lz", "Lt"])
@pytest.mark.parametrize("length", [0.0, 6.0, DES.lengths["Lx"] + 1e-6])
def test_a_length_that_rows_of_numbers_do_not_follow_is_named(name: str, length: float) -> None:
    (line,) = problems_of(edited(name, length=length))
    assert "m.yaml:3:12: lengths_m: " in line
    assert f"{name} {DES.lengths[name]:.6g} m instead of {length:.6g} m: take the rows out" in line


def test_several_are_named_in_one_line() -> None:
    (line,) = problems_of(edited("Lx", edited("L2")))
    assert "L2 5.7912 m instead of 6 m, Lx 1.18872 m instead of 6 m" in line


def test_a_length_that_is_not_part_of_the_chain_is_free() -> None:
    machine = parse_machine(edited("L1"), "m.yaml")
    assert machine.rows == DES.rows
    assert machine.lengths["L1"] == 6.0


def test_rows_that_name_their_lengths_follow_them() -> None:
    text = WITH_ROWS
    for key, name in (("a_m: 5.7912", "a: L2"), (f"d_m: {-DES.lengths['Lt']!r}", "d: -Lt")):
        assert key in text
        text = text.replace(key, name)
    assert parse_machine(text, "m.yaml").rows == DES.rows
    longer = parse_machine(edited("Lt", edited("L2", text)), "m.yaml")
    assert longer.rows == gimballed_centrifuge_rows(longer.lengths)
    assert (longer.lengths["L2"], longer.lengths["Lt"]) == (6.0, 6.0)


def test_a_length_of_own_rows_is_in_a_row_by_name_or_by_number() -> None:
    assert parse_machine(OWN + "lengths_m: {R: 7.3}\n", "m.yaml").rows[1].a == 7.3
    by_name = OWN.replace("a_m: 7.3", "a: R") + "lengths_ft: {R: 10}\n"
    assert parse_machine(by_name, "m.yaml").rows[1].a == 10 * 0.3048
    (line,) = problems_of(OWN + "lengths_m: {R: 7.4}\n")
    assert "lengths_m: the rows have no R of 7.4 m: name the length in a row, as in a: Lx" in line


def test_lengths_of_the_base_that_no_row_names_are_not_those_of_the_machine() -> None:
    assert parse_machine(OWN, "m.yaml").lengths == {}
    named = parse_machine(OWN.replace("a_m: 7.3", "a: L2"), "m.yaml")
    assert named.lengths == {"L2": DES.lengths["L2"]}
