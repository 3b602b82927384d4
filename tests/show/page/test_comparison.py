"""Runs beside each other."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.page import render_report
from tests.support.page import Page, set_at


@pytest.mark.usefixtures("undrawn")
def test_runs_of_one_name_are_told_apart_by_their_folders(
    stored: Callable[..., StoredRun],
) -> None:
    runs = [replace(stored(), folder=Path("runs") / folder) for folder in ("first", "second")]
    text = Page(render_report([*runs, stored("other")])).text
    assert "cobra (first)" in text
    assert "cobra (second)" in text
    assert "other (" not in text


@pytest.mark.usefixtures("undrawn")
def test_the_best_of_a_row_is_marked(stored: Callable[..., StoredRun]) -> None:
    runs = [stored(name) for name in ("a", "b", "c")]
    for run, reduction, deviation in zip(runs, (0.5, 0.9, None), (0.2, 0.1, 0.1), strict=True):
        set_at(run.metrics, "coriolis.bb3.reduction", reduction)
        set_at(run.metrics, "fidelity.joint_deviation_relative", deviation)
    text = render_report(runs).replace("\u00a0", " ")
    assert '<th scope="row">BB3</th><td>−50.0 %</td><td class="good">−90.0 %</td><td>–</td>' in text
    best = '<td class="good">10.0 %</td>'
    assert f'<th scope="row">joint deviation</th><td>20.0 %</td>{best}{best}' in text
