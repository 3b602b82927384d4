"""Whatever bytes are read: a value, or an error that a user can mend, and nothing else."""

from __future__ import annotations

import os
import random
from collections.abc import Callable

import numpy as np
import pytest

from des_cli.errors import Complaint, DesError, ProfileError
from des_cli.profiles_in.expression import ExpressionError, parse_expression
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.machine_yaml import parse_machine
from des_cli.profiles_in.source import decode
from des_cli.runs_out.table_reading import parse_command_table
from tests.support.hostile import HEADER, ROWS, YAML, csv_of

INPUTS = int(os.environ.get("DES_CORIOLIS_FUZZ", "10000"))
"""How many inputs are tried in all; CONTRIBUTING.md tells of more."""

SEED = int(os.environ.get("DES_CORIOLIS_FUZZ_SEED", "1"))

MACHINE = """\
base: des
name: mine
lengths_m: {L2: 5.8}
limits:
  arm: {rate_rad_s: 5, acceleration_rad_s2: 0.6, jerk_rad_s3: 1.2}
  fork: {angle: endless}
occupant: {gy_g: [-1, 1], g_onset_g_s: 3}
"""

TABLE = csv_of([f"{0.1 * k!r},{1.0 + k!r},{2.0 * k!r},{0.5 * k!r}" for k in range(5)])

EXPRESSION = "30 - 2.5*t + sin(pi*t/5)**2 - exp(-t)*max(0, t - 1)"

TOKENS = (
    *("1e400", "-", "--", "0x10", "1_0", ".nan", ".inf", "null", "~", "{", "}", "[", "]", ":", ","),
    *(
        "&a ",
        "*a",
        "<<: ",
        "!!x ",
        "%YAML 1.1\n",
        "---\n",
        "...\n",
        "? ",
        "| ",
        "> ",
        "'",
        '"',
        "#",
    ),
    *("\n", "\r", "\t", "\0", "\x1b", "\ufeff", "\u2028", "é", "😀", "１", "t", "pi", "sin(", ")"),
    *("**", "9**9", "/0", "(" * 60, "]" * 60, " " * 300, "a" * 2000, "1" * 400, ";", "|", "e", "."),
    *(
        "t_s",
        "arm_rpm",
        "fork_deg",
        "g:",
        "gx_g",
        "time:",
        "samples:",
        "name:",
        "2026-01-01T00:00:00",
    ),
)
"""What is put into a good text: what means something to one of the readers."""


def _yaml(data: bytes) -> None:
    load_profile("-", stdin=data)


def _csv(data: bytes) -> None:
    load_profile("-", stdin=data)


def _expression(data: bytes) -> None:
    try:
        expression = parse_expression(data.decode(errors="replace"))
    except ExpressionError as error:
        raise ProfileError([Complaint("", str(error))]) from error
    with np.errstate(all="ignore"):
        expression.at(np.linspace(0.0, 1.0, 5))


def _machine(data: bytes) -> None:
    parse_machine(decode(data, "m.yaml"), "m.yaml")


def _table(data: bytes) -> None:
    parse_command_table(data, "t.csv")


READERS: tuple[tuple[Callable[[bytes], None], str, float], ...] = (
    (_yaml, YAML, 0.25),
    (_csv, csv_of(ROWS, HEADER), 0.3),
    (_expression, EXPRESSION, 0.25),
    (_machine, MACHINE, 0.1),
    (_table, TABLE, 0.1),
)
"""Each with a text that it reads, and its share of the inputs: reading YAML takes longest."""


def changed(rng: random.Random, text: str) -> bytes:
    """Change a text at a few random places: bytes, tokens, lines twice, cut or swapped."""
    data = bytearray(text.encode())
    for _ in range(rng.choice((1, 1, 1, 2, 3, 8))):
        place = rng.randrange(len(data) + 1)
        end = min(len(data), place + rng.choice((1, 2, 5, 30)))
        match rng.randrange(7):
            case 0:
                data[place:place] = rng.choice(TOKENS).encode()
            case 1:
                data[place:end] = rng.choice(TOKENS).encode()
            case 2:
                del data[place:end]
            case 3:
                data[place:end] = rng.randbytes(end - place)
            case 4:
                data[place:place] = data[place:end] * rng.choice((1, 3, 100))
            case 5:
                lines = data.splitlines(keepends=True)
                rng.shuffle(lines)
                data = bytearray(b"".join(lines))
            case 6:
                del data[place:]
    return bytes(data)


def problems(read: Callable[[bytes], None], data: bytes) -> list[str]:
    """Return what a reader complains of; an error of any other kind fails the test."""
    try:
        read(data)
    except DesError as error:
        return [str(each) for each in error.complaints] or ["refused without a word"]
    except Exception as error:
        raise AssertionError(f"{type(error).__name__} of {data!r}") from error
    return []


@pytest.mark.parametrize(
    ("read", "text", "share"), READERS, ids=["YAML", "CSV", "expression", "machine", "table"]
)
def test_nothing_but_an_error_of_the_tool_comes_out(
    read: Callable[[bytes], None], text: str, share: float
) -> None:
    rng = random.Random(f"{SEED} {read.__name__}")
    read(text.encode())
    refused = 0
    count = round(INPUTS * share)
    for _ in range(count):
        data = changed(rng, text)
        lines = problems(read, data)
        assert all("\n" not in line for line in lines), data
        refused += bool(lines)
    assert refused > 0.2 * count
