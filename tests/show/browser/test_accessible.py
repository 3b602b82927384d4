"""The page by the rules of axe, in both themes and at both ends of the widths."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.show.browser.conftest import Opened
from tests.show.browser.test_page import draw_all

pytestmark = pytest.mark.browser


def axe() -> str:
    """Return the script of axe, from the package that ships it."""
    spec = importlib.util.find_spec("axe_playwright_python")
    if spec is None or spec.origin is None:
        pytest.skip("axe-playwright-python is not installed")
    return (Path(spec.origin).parent / "axe.min.js").read_text("utf-8")


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize(("name", "width"), [("one", 390), ("one", 1280), ("three", 1280)])
def test_axe_finds_nothing(show: Callable[..., Opened], name: str, width: int, theme: str) -> None:
    script = axe()
    page = show(name, width, theme, bypass_csp=True).page
    page.evaluate("document.querySelectorAll('details').forEach((each) => (each.open = true))")
    if name == "one":
        draw_all(page)
    page.evaluate(script)
    found = page.evaluate("axe.run()")["violations"]
    assert [(each["id"], each["nodes"][0]["html"][:200]) for each in found] == []
