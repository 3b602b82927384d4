"""The page in a headless Chromium, where there is one."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from des_cli.runs_out.run_folder import write_run
from des_cli.runs_out.stored_run import read_run
from des_cli.show.page.page import render_report
from tests.support.runs import make_run

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
ARGUMENTS = [
    *("--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
]
WAIT = 20_000  # [ms]; a machine with much else to do is slow


@dataclass
class Opened:
    """A page that is open, and what it complained of and asked for."""

    page: Any
    complaints: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)


@pytest.fixture(scope="session")
def reports(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Pages of one run and of three, two of them of one maneuver."""
    home = tmp_path_factory.mktemp("pages")
    runs = []
    for folder, name, control in (
        ("a", "cobra", "scalar"),
        ("b", "cobra", "per-joint"),
        ("c", "a <b>bold</b> name", "free"),
    ):
        write_run(make_run(301, name=name, control=control), home / folder, plots=False)
        runs.append(read_run(home / folder))
    pages = {"one": runs[:1], "three": runs}
    for name, each in pages.items():
        (home / f"{name}.html").write_text(render_report(each), "utf-8")
    return {name: home / f"{name}.html" for name in pages}


@pytest.fixture(scope="session")
def chromium() -> Iterator[Any]:
    """A browser for all tests, each of which has a profile of its own in it."""
    if CHROMIUM is None:
        pytest.skip("Chromium is not installed")
    sync_api = pytest.importorskip("playwright.sync_api")
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield browser
        browser.close()


@pytest.fixture
def show(chromium: Any, reports: dict[str, Path]) -> Iterator[Callable[..., Opened]]:
    """A function that opens a page, by its name, in a window of some width and theme."""
    contexts = []

    def opened(
        name: str = "one", width: int = 1280, theme: str = "light", **options: Any
    ) -> Opened:
        viewport = {"width": width, "height": 900}
        context = chromium.new_context(viewport=viewport, color_scheme=theme, **options)
        context.set_default_timeout(WAIT)
        contexts.append(context)
        found = Opened(context.new_page())
        found.page.on(
            "console",
            lambda said: said.type in ("error", "warning") and found.complaints.append(said.text),
        )
        found.page.on("pageerror", lambda error: found.complaints.append(str(error)))
        found.page.on("request", lambda request: found.requests.append(request.url))
        found.page.goto(reports[name].as_uri())
        return found

    yield opened
    for context in contexts:
        context.close()
