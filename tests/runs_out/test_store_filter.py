"""Conditions are read by a grammar, and nothing in them is run."""

from __future__ import annotations

import pyarrow as pa
import pyarrow.dataset as ds
import pytest
from hypothesis import given
from hypothesis import strategies as st

from des_cli.errors import UsageError
from des_cli.runs_out.store_filter import parse_condition

TABLE = pa.table(
    {
        "folder": ["a", "b", "c and d"],
        "solver.status": ["converged", "acceptable", None],
        "solver.converged": [True, False, None],
        "fidelity.seat_g_rms_error_g": [0.05, 0.1, None],
        "executable.seat_g_rms_error_g": [0.0, 0.0, 0.0],
        "coriolis.vector.reduction": [0.3, -0.1, 0.2],
        "coriolis.ab3.reduction": [0.0, 0.0, 0.0],
    }
)
KINDS = {
    "folder": "text",
    "solver.status": "text",
    "solver.converged": "truth",
    **dict.fromkeys(TABLE.column_names[3:], "number"),
}


def folders(text: str) -> list[str]:
    found = ds.dataset(TABLE).to_table(filter=parse_condition(text, KINDS))
    return "".join(name[0] for name in found["folder"].to_pylist())


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("seat_g_rms_error_g<=0.05", "a"),
        ("seat_g_rms_error_g <= 5e-2", "a"),
        ("fidelity.seat_g_rms_error_g>0.05", "b"),
        ("executable.seat_g_rms_error_g = 0", "abc"),
        ("vector.reduction >= -0.1", "abc"),
        ("vector.reduction == 0.2", "c"),
        ("vector.reduction != 0.2", "ab"),
        ("status = converged", "a"),
        ("status = 'converged' or vector.reduction < 0", "ab"),
        ('folder = "c and d"', "c"),
        ("not status = converged", "b"),
        ("converged = false", "b"),
        # and binds before or
        ("folder = a or folder = b and vector.reduction > 0", "a"),
        ("(folder = a or folder = b) and vector.reduction > 0", "a"),
        ("(folder = a or folder = b) and not (vector.reduction > 0)", "b"),
    ],
)
def test_what_a_condition_finds(text: str, expected: str) -> None:
    assert folders(text) == expected


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "a column is missing"),
        ("status", "is missing"),
        ("status =", "a value is missing"),
        ("status ~ x", "is to follow solver.status"),
        ("status = a b", "mean after a whole condition"),
        ("(status = a", r"a \) is missing"),
        ("status = a and", "a column is missing"),
        ("status = 'a", "cannot be read from"),
        ("statsu = a", r"there is no column 'statsu' \(did you mean status\?\)"),
        ("reduction > 0", "'reduction' may be coriolis.vector.reduction or coriolis.ab3.reduction"),
        ("vector.reduction > high", "coriolis.vector.reduction is a number"),
        ("converged = yes", "solver.converged is true or false"),
        ("(" * 60 + "status = a" + ")" * 60, "conditions deep"),
        ("not " * 60 + "status = a", "conditions deep"),
        ("__import__('os').system('x') = 1", "there is no column|is to follow|cannot be read"),
    ],
)
def test_what_is_no_condition_is_a_sentence(text: str, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        parse_condition(text, KINDS)


@given(st.text(alphabet="()<>=! '\"anotr.01_x\n", max_size=40))
def test_any_text_is_a_condition_or_refused(text: str) -> None:
    refused = ""
    try:
        parse_condition(text, KINDS)
    except UsageError as error:
        refused = str(error)
    assert "\n" not in refused
