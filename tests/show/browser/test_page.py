"""What a person does with the page: look, move through time, zoom, compare, take away."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from tests.show.browser.conftest import Opened

pytestmark = pytest.mark.browser

Show = Callable[..., Opened]


def draw_all(page: Any) -> int:
    """Scroll through the page until every plot of the opened runs is drawn."""
    wanted = "details.all[open] > .part > .panels figure, details.all[open] .joint figure"
    figures = page.locator(wanted)
    for i in range(figures.count()):
        figures.nth(i).scroll_into_view_if_needed()
        figures.nth(i).and_(page.locator("[data-drawn]")).wait_for()
    return int(figures.count())


def figure(page: Any, panel: str) -> Any:
    """Return a plot of the first run, drawn and in view."""
    found = page.locator(f"#run-1 figure[data-panel={panel}]")
    found.scroll_into_view_if_needed()
    page.locator(f"#run-1 figure[data-panel={panel}][data-drawn]").wait_for()
    return found


def until(page: Any, holds: Callable[[], bool]) -> None:
    """Wait until something holds; the page's policy lets no one wait inside it."""
    for _ in range(200):
        if holds():
            return
        page.wait_for_timeout(50)
    pytest.fail("it never came about")


def read(found: Any) -> list[float]:
    """Return the read-out under a plot's title."""
    return [float(text.replace("−", "-")) for text in found.locator("output").all_inner_texts()]


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_every_plot_is_drawn_without_a_complaint_or_a_request(show: Show, theme: str) -> None:
    opened = show("one", theme=theme)
    assert draw_all(opened.page) == 4 + 3 + 5 + 12
    assert opened.complaints == []
    assert len(opened.requests) == 1  # the page itself
    took = "performance.getEntriesByType('navigation')[0].domContentLoadedEventEnd"
    assert opened.page.evaluate(took) < 5000  # [ms]; a fifth of it where nothing else runs


@pytest.mark.parametrize("width", [390, 1280, 1920])
def test_nothing_is_wider_than_the_window(show: Show, width: int) -> None:
    page = show("three", width).page
    page.locator("#run-1 details.all > summary").click()
    draw_all(page)
    assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_the_slider_moves_cursors_values_and_the_machine(show: Show) -> None:
    page = show().page
    rate = figure(page, "rate-p")
    machine = page.locator("#run-1 svg.machine .real .box").first
    before = (read(rate), rate.locator(".cursor").bounding_box()["x"], machine.get_attribute("d"))
    slider = page.locator("#run-1 input[type=range]")
    slider.focus()
    page.keyboard.press("End")
    after = (read(rate), rate.locator(".cursor").bounding_box()["x"], machine.get_attribute("d"))
    assert after[1] > before[1] + 100
    assert after[2] != before[2]
    assert page.locator("#run-1 .now").inner_text() == slider.get_attribute("aria-valuetext")
    page.keyboard.press("ArrowLeft")
    assert float(slider.input_value()) < float(slider.get_attribute("max"))


def test_play_and_pause_by_the_keyboard(show: Show) -> None:
    page = show().page
    slider, play = page.locator("#run-1 input[type=range]"), page.locator("#run-1 .play")
    page.locator("#run-1 .timebar select").select_option("0.25")
    play.focus()
    page.keyboard.press("Space")
    assert play.get_attribute("aria-pressed") == "true"
    until(page, lambda: float(slider.input_value()) > 0.05)
    page.keyboard.press("Space")
    stopped = slider.input_value()
    page.wait_for_timeout(200)
    assert slider.input_value() == stopped
    assert float(stopped) < 2.0


def test_a_drag_zooms_every_plot_and_the_pointer_reads_all(show: Show) -> None:
    page = show().page
    rate, force = figure(page, "rate-p"), figure(page, "g-gx")
    box = force.locator(".plot").bounding_box()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 60)
    pointed = read(rate)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.8 * box["width"], box["y"] + 80, steps=6)
    page.mouse.up()
    whole = page.locator("#run-1 [data-zoom=all]")
    until(page, whole.is_enabled)
    page.mouse.move(5, 5)
    assert read(rate) != pointed
    with page.expect_download() as download:
        rate.locator("[data-save=csv]").click()
    lines = download.value.path().read_text().splitlines()
    times = [float(line.split(",")[0]) for line in lines[1:]]
    assert lines[0] == "t_s,p_before_deg_s,p_after_deg_s"
    assert 3.0 < times[0] < times[-1] < 9.0
    whole.click()
    assert whole.is_disabled()


@pytest.mark.parametrize(("kind", "begins"), [("svg", b"<svg"), ("png", b"\x89PNG")])
def test_a_plot_can_be_taken_away(show: Show, kind: str, begins: bytes) -> None:
    page = show().page
    found = figure(page, "g-gz")
    with page.expect_download() as download:
        found.locator(f"[data-save={kind}]").click()
    assert download.value.suggested_filename == f"cobra-g-gz.{kind}"
    assert download.value.path().read_bytes().startswith(begins)


def test_runs_are_sorted_opened_and_drawn_over_each_other(show: Show) -> None:
    opened = show("three")
    page = opened.page
    names = page.locator("#runs tbody th")
    assert names.all_inner_texts() == ["cobra (a)", "cobra (b)", "a <b>bold</b> name"]
    head = page.locator("#runs thead th").nth(1)
    head.locator("button").click()
    assert head.get_attribute("aria-sort") == "ascending"
    assert names.first.inner_text() == "a <b>bold</b> name"
    for i in range(2):
        page.locator("input[name=overlay]").nth(i).check()
    page.locator(".overlay .plot canvas").nth(2).wait_for()
    assert page.locator(".overlay .legend li").count() == 2
    assert page.locator("#run-2 figure[data-drawn]").count() == 0
    page.locator("#runs a", has_text="cobra (b)").click()
    page.locator("#run-2 details.all[open]").wait_for()
    assert opened.complaints == []


def test_the_plots_take_the_colours_of_another_theme(show: Show) -> None:
    page = show().page
    figure(page, "rate-p")
    colour = "getComputedStyle(document.querySelector('.pen-after')).stroke"
    light, drawn = page.evaluate(colour), pixels(page)
    page.emulate_media(color_scheme="dark")
    page.wait_for_timeout(300)
    assert page.evaluate(colour) != light
    assert pixels(page) != drawn


def pixels(page: Any) -> bytes:
    return bytes(page.locator("#run-1 figure[data-panel=rate-p] .plot").screenshot())


def test_paper_has_every_plot_as_lines(show: Show) -> None:
    page = show().page
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.locator("svg.paper").count() == page.locator("figure[data-panel]").count()
    assert page.locator("svg.paper polyline").first.get_attribute("points").count(",") > 50
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert page.locator("svg.paper").count() == 0
    assert page.pdf(format="A4").startswith(b"%PDF")


def test_who_has_no_script_still_reads_the_run(show: Show) -> None:
    page = show("one", java_script_enabled=False).page
    assert page.locator("#run-1 .verdict").is_visible()
    assert page.locator("#run-1 .stills svg").first.is_visible()
    assert page.locator("#run-1 .bars").is_visible()
    assert not page.locator("#run-1 .timebar").is_visible()
