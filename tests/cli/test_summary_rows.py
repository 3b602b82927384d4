"""The rows of a summary: what is felt first, and nothing that is not known."""

from des_cli.batch.job import JobResult
from des_cli.cli import summary_rows as rows_of
from des_cli.results.reading import read_metrics
from tests.support.summaries import METRICS, result, with_change


def summary_rows(shown: JobResult) -> list[tuple[str, str]]:
    metrics = read_metrics(shown.metrics)
    return [*rows_of.felt_rows(metrics, shown.objective), *rows_of.other_rows(metrics)]


def test_rows_lead_with_what_is_felt() -> None:
    assert rows_of.felt_words(read_metrics(METRICS)) == (
        "cross-coupling 45.8 % less, seat rate off by 9.1 %, G off by 0.0834 g rms"
    )
    assert summary_rows(result()) == [
        (
            "cross-coupling",
            "BB3 68.9 % less, seat x 40.1 % less, seat y 34.0 % less, seat z 3.1 % more",
        ),
        ("turning", "total angular acceleration 0.462 -> 0.447 rad/s² rms, peak 0.539 -> 0.561"),
        (
            "seat G",
            "tilt 4.5 deg at most, peak Gy 0.37 -> 0.45 g, Gz onset 0.7 -> 0.79 g/s",
        ),
        ("ends", "start off by cab -0.573 deg/s, end off by arm -28.6 deg"),
        (
            "study",
            "joints off by 12.8 % (squared 1.6 %); its sweep: 63.9 % less at 24.0 %; "
            "a constant factor: as much by p = 0.767 at 23.3 %",
        ),
        (
            "solved",
            "converged in 6 iterations "
            "(minimum cross-coupling by optimum, scalar control, report axes)",
        ),
    ]


def test_what_was_told_to_be_worse_is_not_told_again() -> None:
    metrics = read_metrics(METRICS)
    told = dict(rows_of.felt_rows(metrics, (), {"turning rms", "gy peak", "gz onset"}))
    assert told["turning"] == "peak 0.539 -> 0.561 rad/s²"
    assert told["seat G"] == "tilt 4.5 deg at most"
    assert "turning" not in dict(rows_of.felt_rows(metrics, (), {"turning rms", "turning peak"}))


def test_the_size_of_the_vector_stands_beside_its_change() -> None:
    vector = {"reduction": 0.458, "rms_before_rad_s2": 0.351, "rms_after_rad_s2": 0.258}
    rows = summary_rows(with_change("coriolis.vector", vector))
    assert rows[0][1].startswith("0.351 -> 0.258 rad/s² rms; BB3 68.9 % less, seat x")


def test_a_start_that_is_matched_is_told_so() -> None:
    rows = dict(summary_rows(with_change("fidelity.start_error.cab_rad_s", 0.0001)))
    assert rows["ends"].startswith("start off by arm +0.0573 deg/s")
    matched = with_change("fidelity.start_error", {"arm_rad": 0.0, "arm_rad_s": 1e-9})
    assert dict(summary_rows(matched))["ends"].startswith("start as in the profile, end off")


def test_a_weight_on_several_components_names_the_vector_alone() -> None:
    rows = summary_rows(result(objective=("seat_x", "seat_y", "seat_z")))
    seat = "seat x 40.1 % less, seat y 34.0 % less, seat z 3.1 % more"
    assert rows[0] == ("cross-coupling", seat)


def test_every_budget_stands_beside_what_is_spent_of_it() -> None:
    budget = {"seat_g_rms_error_g": 0.0835, "seat_rate_deviation_relative": 0.1}
    rows = summary_rows(with_change("solver.budget", budget))
    assert ("budgets", "G error 0.0834 of 0.0835 g, seat rate 9.11 of 10 %") in rows


def test_metrics_without_what_is_felt_leave_their_rows_out() -> None:
    bare = {key: METRICS[key] for key in ("solver", "coriolis")} | {"fidelity": {}}
    assert [label for label, _ in summary_rows(result(metrics=bare))] == [
        "cross-coupling",
        "study",
        "solved",
    ]
