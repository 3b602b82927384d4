"""What columns may give: each kind's own example is read as it, and the contract's names."""

from __future__ import annotations

import pytest

from des_cli.errors import Complaint
from des_cli.profiles_in.column_kinds import (
    ALIASES,
    ASKED_G,
    BODY_RATES,
    JOINT_COMMANDS,
    KINDS,
    QUANTITIES,
    Column,
    Kind,
    Said,
    first_said,
    spelled,
)
from des_cli.profiles_in.columns import choose_columns
from des_cli.profiles_in.csv_header import split_header
from des_cli.profiles_in.unit_spelling import read_name
from des_cli.units import unit_named


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.words)
def test_the_example_of_a_kind_is_read_as_that_kind(kind: Kind) -> None:
    count = kind.example.count(",") + 1
    header = split_header(f"{kind.example}\n{','.join('0' * count)}\n", "x")
    complaints: list[Complaint] = []
    chosen = [column.stem for column in choose_columns(header, {}, complaints, [])]
    assert complaints == []
    assert len(chosen) == count
    assert kind.complete(chosen)
    assert [other.words for other in KINDS if other.complete(chosen)] == [kind.words]


def test_a_kind_is_complete_with_all_of_its_quantities_or_with_any_where_one_is_enough() -> None:
    assert JOINT_COMMANDS.complete({"t", "cab", "fork", "arm", "p"})
    assert not JOINT_COMMANDS.complete({"cab", "fork"})
    assert not BODY_RATES.complete(["p", "q", "q"])
    assert ASKED_G.complete({"gy"})
    assert not ASKED_G.complete({"p", "q"})
    assert not ASKED_G.complete([])


@pytest.mark.parametrize("stem", QUANTITIES)
def test_every_name_of_the_contract_is_read_as_its_quantity(stem: str) -> None:
    for name in spelled(stem):
        own = read_name(name)
        assert own.stem == stem
        assert Column(stem, name, name, 0, own.unit, own.unit_text).usable


def test_the_names_of_a_quantity_start_with_si() -> None:
    assert spelled("t") == ["t_s", "t_ms", "t_us", "t_ns", "t_min"]
    assert spelled("arm") == ["arm_rad_s", "arm_deg_s", "arm_rpm", "arm_rad", "arm_deg"]
    assert spelled("gz") == ["gz_m_s2", "gz_ft_s2", "gz_g"]
    assert [spelled(ALIASES[name]) for name in ("qw", "qz")] == [["q0"], ["q3"]]


@pytest.mark.parametrize(
    ("stem", "suffix", "text", "clock", "usable"),
    [
        ("p", "rpm", "rpm", False, True),
        ("p", "deg", "deg", False, False),
        ("p", None, "mdps", False, False),
        ("p", None, "", True, False),
        ("arm", "deg", "deg", False, True),
        ("fork", "rpm", "rpm", False, False),
        ("t", None, "", True, True),
        ("t", "ns", "ns", True, True),
        ("t", "rad", "rad", False, False),
        ("q0", None, "", False, True),
        ("q0", "rad", "rad", False, False),
        ("gx", "g", "g", False, True),
        ("gx", "m", "m", False, False),
    ],
)
def test_a_column_is_usable_with_a_unit_of_its_quantity(
    stem: str, suffix: str | None, text: str, clock: bool, usable: bool
) -> None:
    unit = unit_named(suffix) if suffix else None
    assert Column(stem, "x", "x", 0, unit, text, is_clock=clock).usable is usable


def test_the_user_goes_before_the_contract_and_that_before_a_spelling() -> None:
    rpm = unit_named("rpm")
    spelling, contract, user, twin = (
        Column("p", name, name, place, rpm, "rpm", said)
        for place, (name, said) in enumerate(
            [
                ("P [rpm]", Said.BY_SPELLING),
                ("p_rpm", Said.BY_CONTRACT),
                ("roll", Said.BY_USER),
                ("p_rpm", Said.BY_CONTRACT),
            ]
        )
    )
    useless = Column("p", "p_m", "p_m", 4, unit_named("m"), "m", Said.BY_USER)
    other = Column("q", "q_rpm", "q_rpm", 5, rpm, "rpm", Said.BY_USER)
    assert first_said([spelling, contract, user, twin], "p") == [user]
    assert first_said([useless, spelling, contract, other, twin], "p") == [contract, twin]
    assert first_said([spelling, useless], "p") == [spelling]
    assert first_said([useless, other], "p") == []
