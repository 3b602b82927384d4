"""How far a run can be relied on, in words, whatever the file holds."""

from __future__ import annotations

import pytest

from des_cli.model.metrics import Change, Fidelity, Metrics, SolverFacts
from des_cli.show.standing import budget_words, change_words, status_words


@pytest.mark.parametrize(
    ("status", "converged", "words"),
    [
        ("converged", True, ""),
        ("converged", None, ""),
        ("acceptable", False, "acceptable, not converged"),
        ("iteration-limit", False, "iteration-limit, not converged"),
        (None, False, "unknown, not converged"),
        ("\x1b[31m\n", False, "[31m, not converged"),
        ("x" * 500, False, f"{'x' * 60}, not converged"),
    ],
)
def test_only_what_is_known_to_have_converged_has_no_word(
    status: str | None, converged: bool | None, words: str
) -> None:
    assert status_words(Metrics(solver=SolverFacts(status=status, converged=converged))) == words


def test_changes_are_told_from_a_thousandth_of_a_radian() -> None:
    change = Change(joint_change_max_rad={"arm": 1.0e-3, "fork": 1.1e-3, "cab": None})
    assert change_words(change) == "fork by up to 0.0011 rad"
    assert change_words(Change()) == ""


def test_every_budget_stands_with_what_is_spent() -> None:
    solver = SolverFacts(budget={"seat_g_rms_error_g": 0.05, "seat_rate_deviation_relative": 0.1})
    spent = {"seat_g_rms_error_g": 0.049, "seat_rate_deviation_relative": 0.1}
    words = budget_words(Metrics(solver=solver, fidelity=Fidelity(spent)))
    assert words == "G error 0.049 of 0.05 g, seat rate 10 of 10 %"
    assert budget_words(Metrics()) == ""
