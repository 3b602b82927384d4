"""Every budget stands beside what is spent of it, in the unit that it was set in."""

from des_cli.model.metric import METRICS
from des_cli.model.metrics import Fidelity, Metrics, SolverFacts
from des_cli.results.budgets import spent_budgets
from des_cli.results.reading import read_metrics


def test_every_metric_may_have_a_budget() -> None:
    metrics = Metrics(
        solver=SolverFacts(budget=dict.fromkeys(METRICS, 0.2)),
        fidelity=Fidelity(dict.fromkeys(METRICS, 0.1234)),
    )
    found = {str(each) for each in spent_budgets(metrics)}
    assert len(found) == len(METRICS)
    assert {
        "joints 12.34 of 20 %",
        "G error 0.1234 of 0.2 g",
        "angular acceleration error 0.1234 of 0.2 rad/s²",
        "attitude 0.1234 of 0.2 deg",
    } <= found
    assert spent_budgets(metrics)[0].allowed == "joints ≤ 20 %"


def test_a_strangers_budget_is_no_error() -> None:
    budget = {"a\nb": 1.0, "joint_deviation_relative": "much", "seat_g_rms_error_g": 0.1}
    metrics = read_metrics({"solver": {"budget": budget}, "fidelity": {"a\nb": 0.5}})
    assert [str(each) for each in spent_budgets(metrics)] == ["ab 0.5 of 1"]
    assert spent_budgets(read_metrics({"solver": {"budget": None}})) == []
