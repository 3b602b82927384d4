"""The page: everything on it, nothing from elsewhere, nobody's markup."""

import base64
import copy
import hashlib
import re
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest

from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.assets import page_script, plot_library
from des_cli.show.page.page import NOMENCLATURE, render_report
from tests.support.page import Page, set_at

HOSTILE = [
    "</title><script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "{{ 7 * 7 }}{% for x in y %}",
    "' onmouseover='alert(1)",
    "javascript:alert(1)",
    "&lt;b&gt;<b>",
    "a\0b\x1bc\ud800d\x9fe",
    "\u202ecod.exe",
    "π ☃ 日本語",
    "x" * 5000,
]


def test_the_page_has_every_plot_and_word_of_the_contract(
    stored: Callable[..., StoredRun],
) -> None:
    page = Page(render_report([stored(), stored("per joint", control="per-joint")]))
    figures = [figure for figure in page.all("figure") if "data-panel" in figure]
    assert len(figures) == 2 * (4 + 3 + 5 + 12 + 2)
    plots = [tag for tag in page.all("div") if tag.get("role") == "img"]
    assert all(len(plot["aria-label"] or "") > 20 for plot in plots)
    for words in (
        *("cobra", "per joint", "converged", "minimum", "scalar", "per-joint"),
        *("BB3", "whole vector", "seat x", "seat y", "seat z"),
        *("12.8 %", "1.6 %", "21.4 %", "0.131", "6.4"),
        *("the study's law", "63.9 %", "24.0 %", "constant p", "0.747", "25.3 %"),
        *("0.2590558", "0.538436", "3.1e-12", "The first-order conditions hold to rounding."),
        *("arm rate [rad/s]", "5.86", "cab acceleration [rad/s²]"),
        *("des-coriolis 1.2.3", "5c" * 32, "Nomenclature"),
        *(meaning for _, meaning in NOMENCLATURE),
    ):
        assert words in page.text, words
    identifiers = [tag["id"] for _, tag in page.tags if "id" in tag]
    assert len(identifiers) == len(set(identifiers))
    assert all((link["href"] or "")[1:] in identifiers for link in page.all("a"))
    for attribute in ("aria-labelledby", "data-copy"):
        assert {tag[attribute] for _, tag in page.tags if attribute in tag} <= set(identifiers)


def test_headings_go_down_one_level_at_a_time(stored: Callable[..., StoredRun]) -> None:
    page = Page(render_report([stored(), stored("other")]))
    levels = [int(tag[1]) for tag, _ in page.tags if tag in ("h1", "h2", "h3", "h4")]
    assert levels[0] == 1
    assert levels.count(1) == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))


def test_the_page_asks_for_nothing_from_elsewhere(stored: Callable[..., StoredRun]) -> None:
    text = render_report([stored()])
    page = Page(text)
    own = text.replace(plot_library(), "").replace('"http://www.w3.org/2000/svg"', "")
    for word in ("http://", "https://", "@import", "url(", "fetch(", "XMLHttpRequest"):
        assert word not in own, word
    assert not [tag for tag, _ in page.tags if tag in ("link", "iframe", "base", "img")]
    assert all("src" not in script for script in page.all("script"))
    assert "prefers-color-scheme: dark" in text
    assert "@media print" in text
    assert 'name="viewport"' in text


def test_no_script_runs_but_the_pages_own(stored: Callable[..., StoredRun]) -> None:
    text = render_report([stored()])
    (policy,) = [meta["content"] for meta in Page(text).all("meta") if "http-equiv" in meta]
    assert policy is not None
    assert policy.startswith("default-src 'none'; ")
    assert "script-src 'sha256-" in policy
    scripts = re.findall(r"<script>(.*?)</script>", text, re.S)
    assert scripts == [plot_library(), page_script()]
    for script in scripts:
        digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
        assert f"'sha256-{digest}'" in policy


def test_the_same_runs_give_the_same_page(stored: Callable[..., StoredRun]) -> None:
    assert render_report([stored()]) == render_report([stored()])


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_words_stay_words(stored: Callable[..., StoredRun], name: str) -> None:
    run, plain = stored(name), stored("plain")
    for path in ("solver.message", "solver.status", "solver.method", "profile.sha256"):
        set_at(run.metrics, path, name)
    run.metrics["notices"] = [name]
    run.manifest["tool"] = {"name": name, "version": name}
    text = render_report([run, plain])
    text.encode("utf-8")
    page = Page(text)
    harmless = Page(render_report([stored("plain"), plain]))
    tags = [tag for tag, _ in page.tags]
    notice = page.tags.index(("div", {"class": "attention"}))
    # But for the box with the notice, the page has the very tags of a harmless one.
    assert tags[:notice] + tags[notice + 2 :] == [tag for tag, _ in harmless.tags]
    attributes = {key for _, tag in page.tags for key in tag}
    assert attributes == {key for _, tag in harmless.tags for key in tag}
    if name.isprintable() and " " not in name:
        assert name in page.text


def paths(metrics: dict[str, Any], prefix: str = "") -> list[str]:
    found = []
    for key, value in metrics.items():
        found.append(prefix + key)
        if isinstance(value, dict):
            found += paths(value, f"{prefix}{key}.")
    return found


@pytest.mark.slow
@pytest.mark.parametrize(
    "value", [None, "text", [], {}, True, float("nan"), float("-inf"), 10**400, -1e308]
)
def test_no_value_in_the_metrics_stops_the_page(
    stored: Callable[..., StoredRun], value: object
) -> None:
    run = stored()
    whole = copy.deepcopy(run.metrics)
    Page(render_report([StoredRun("x", run.folder, {}, run.trajectory, {})]))
    for path in paths(whole):
        run.metrics.clear()
        run.metrics.update(copy.deepcopy(whole))
        set_at(run.metrics, path, value)
        Page(render_report([run]).replace(plot_library(), ""))


def test_a_report_of_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one run"):
        render_report([])
