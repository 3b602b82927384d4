"""Several runs as rows."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from des_cli.results.reading import read_metrics
from des_cli.results.verdict import find_verdict
from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.cells import labels
from des_cli.show.page.page import render_report
from des_cli.show.page.run_table import COLUMNS, run_rows
from tests.support.page import Page, set_at


def test_runs_of_one_name_are_told_apart_by_their_folders(
    stored: Callable[..., StoredRun],
) -> None:
    runs = [replace(stored(), folder=Path("runs") / folder) for folder in ("first", "second")]
    text = Page(render_report([*runs, stored("other")])).text
    assert "cobra (first)" in text
    assert "cobra (second)" in text
    assert "other (" not in text


def test_the_best_of_one_maneuver_is_marked_and_of_others_none(
    stored: Callable[..., StoredRun],
) -> None:
    runs = [stored(name) for name in ("a", "a", "b")]
    for run, reduction, rate in zip(runs, (0.5, 0.9, 0.95), (0.2, 0.1, 0.01), strict=True):
        set_at(run.metrics, "coriolis.vector.reduction", reduction)
        set_at(run.metrics, "fidelity.seat_rate_deviation_relative", rate)
    metrics = [read_metrics(run.metrics) for run in runs]
    rows = run_rows(labels(runs), metrics, [find_verdict(each) for each in metrics])
    column = [each.label for each in COLUMNS].index("seat rate off by")
    assert [row.cells[0].mark for row in rows] == ["", "good", ""]
    assert [row.cells[column].mark for row in rows] == ["", "good", ""]
    assert [row.cells[column].key for row in rows] == [0.2, 0.1, 0.01]


def test_what_is_not_known_has_no_key_and_words_sort_as_words(
    stored: Callable[..., StoredRun],
) -> None:
    run = stored()
    set_at(run.metrics, "coriolis.vector.reduction", None)
    metrics = read_metrics(run.metrics)
    (row,) = run_rows(["a"], [metrics], [find_verdict(metrics)])
    assert (row.cells[0].text, row.cells[0].key) == ("–", "")
    assert row.cells[-2].key == row.cells[-2].text
