"""What the page says on making a run again."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from des_cli.results.reading import read_metrics
from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.page import render_report
from des_cli.show.page.reproduce import MOST_TEXT, reproduction_of
from tests.support.page import Page


def test_the_command_is_one_for_a_shell(stored: Callable[..., StoredRun]) -> None:
    run = stored()
    words = ["des-coriolis", "reduce", "source/a b.yaml", "--set", "name='x'; rm", "-o", "again"]
    run.manifest["made"] = {"command": words}
    run.manifest["files"] = [{"name": "commands.csv", "sha256": "ab" * 32}]
    again = reproduction_of(run, read_metrics(run.metrics), None)
    assert again.command == (
        "des-coriolis reduce 'source/a b.yaml' --set 'name='\"'\"'x'\"'\"'; rm' -o again"
    )
    assert ("commands.csv", "ab" * 32) in again.digests


def test_a_long_source_is_cut_and_what_is_no_text_is_shown_somehow(
    stored: Callable[..., StoredRun],
) -> None:
    long = b"0,1\n" * MOST_TEXT
    run = replace(stored(), sources={"a.yaml": b"name: <b>\xff", "b.csv": long})
    short, cut = reproduction_of(run, read_metrics(run.metrics), None).sources
    assert (short.text, short.cut) == ("name: <b>\ufffd", False)
    assert (len(cut.text), cut.cut) == (MOST_TEXT, True)
    assert "name: <b>" in Page(render_report([run])).text


def test_what_a_stranger_wrote_into_a_manifest_is_no_error(
    stored: Callable[..., StoredRun],
) -> None:
    run = stored()
    for value in (None, 3, "text", [], {"command": "text"}, {"command": [1, None]}):
        run.manifest.update(made=value, tool=value, machine=value, files=value)
        Page(render_report([run]))
