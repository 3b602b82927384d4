"""The page: everything on it, nothing from elsewhere, nobody's markup."""

import copy
import json
from collections.abc import Callable
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from des_cli.model.run import Run
from des_cli.runs_out.run_folder import StoredRun
from des_cli.runs_out.tables import trajectory_columns
from des_cli.show.page import section
from des_cli.show.page.page import NOMENCLATURE, render_report
from des_cli.show.plots import CAPTIONS

MakeRun = Callable[..., Run]

VOID = {"meta", "link", "img", "br", "hr", "input"}
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


class Page(HTMLParser):
    """Reads a page strictly: every tag closed, in order."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.words: list[str] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if not {"style", "title"} & set(self.open):
            self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.tags if name == tag]


@pytest.fixture
def stored(synthetic_run: MakeRun) -> Callable[..., StoredRun]:
    def make(name: str = "cobra", **options: Any) -> StoredRun:
        run = synthetic_run(11, name=name, **options)
        manifest = {"tool": {"name": "des-coriolis", "version": "1.2.3"}}
        metrics = json.loads(json.dumps(run.metrics))
        return StoredRun(name, Path("runs/x"), metrics, trajectory_columns(run), manifest)

    return make


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """No figures, for tests that look at the words only."""
    monkeypatch.setattr(section, "draw_plots", lambda trajectory, metrics: {})


def set_at(metrics: dict[str, Any], path: str, value: object) -> None:
    *parents, last = path.split(".")
    for key in parents:
        metrics = metrics[key]
    metrics[last] = value


def test_the_page_has_every_run_figure_and_word_of_the_contract(
    stored: Callable[..., StoredRun],
) -> None:
    page = Page(render_report([stored(), stored("per joint", control="per-joint")]))
    images = page.all("img")
    assert len(images) == 2 * len(CAPTIONS)
    assert all((image["src"] or "").startswith("data:image/png;base64,iVBOR") for image in images)
    assert all(image["alt"] for image in images)
    for words in (
        *("cobra", "per joint", "converged", "minimum", "scalar", "per-joint", "kept"),
        *("BB3", "whole vector", "seat x", "seat y", "seat z"),
        *("12.8 %", "1.6 %", "21.4 %", "0.131", "6.4"),
        *(
            "study's single sweep",
            "−63.9 %",
            "24.0 %",
            "constant p",
            "0.747",
            "25.3 %",
        ),
        *("0.2590558", "0.538436", "3.1e-12", "The first-order conditions hold to rounding."),
        *("arm rate [rad/s]", "5.86", "cab acceleration [rad/s²]"),
        *("des-coriolis 1.2.3", "5c" * 32, "Nomenclature"),
        *(meaning for _, meaning in NOMENCLATURE),
        *CAPTIONS.values(),
    ):
        assert words in page.text, words
    targets = {tag.get("id") for _, tag in page.tags}
    assert all((link["href"] or "")[1:] in targets for link in page.all("a"))


def test_the_page_asks_for_nothing_from_elsewhere(stored: Callable[..., StoredRun]) -> None:
    text = render_report([stored()])
    page = Page(text)
    assert "http://" not in text
    assert "https://" not in text
    assert "@import" not in text
    assert "url(" not in text
    assert not [tag for tag, _ in page.tags if tag in ("script", "link", "iframe", "base")]
    (policy,) = [meta for meta in page.all("meta") if "http-equiv" in meta]
    assert (policy["content"] or "").startswith("default-src 'none'")
    assert "prefers-color-scheme: dark" in text
    assert "@media print" in text
    assert 'name="viewport"' in text


@pytest.mark.slow
def test_the_same_runs_give_the_same_page(stored: Callable[..., StoredRun]) -> None:
    assert render_report([stored()]) == render_report([stored()])


@pytest.mark.usefixtures("undrawn")
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


@pytest.mark.usefixtures("undrawn")
def test_the_summary_names_the_price_and_what_got_worse(
    stored: Callable[..., StoredRun],
) -> None:
    run = stored()
    for path, value in (
        ("coriolis.bb3.reduction", 0.689),
        ("coriolis.vector.reduction", 0.458),
        ("coriolis.ab3.reduction", -0.28),
        ("coriolis.cb3.reduction", -7.0),
        ("limits.modified.arm.acceleration_peak_rad_s2", 0.91),
        ("limits.modified.arm.ok", False),
        ("solver.converged", False),
        ("solver.status", "iteration-limit"),
    ):
        set_at(run.metrics, path, value)
    page = Page(render_report([run]))
    assert (
        "Took 68.9 % off BB3 and 45.8 % off the whole vector. What the pilot feels of it: the "
        "seat's angular rate is off by 21.4 %, its G-vector by 0.131 g rms and the total angular "
        "acceleration is" in page.text
    )
    assert "By the study's measure: 12.8 % joint deviation (1.6 % squared)." in page.text
    assert (
        "It was partly moved, not removed: the squared integral grew for AB3 by 28.0 % "
        "and CB3 by 700 %." in page.text
    )
    assert "The solver did not converge (iteration-limit)." in page.text
    assert "breaks limits of the machine; broken: arm." in page.text
    assert "0.9100 exceeds" in page.text
    assert "+28.0 %" in page.text


@pytest.mark.usefixtures("undrawn")
def test_a_run_in_seat_axes_is_summed_up_by_the_vector(stored: Callable[..., StoredRun]) -> None:
    run = stored()
    for path, value in (
        ("solver.axes", "seat"),
        ("solver.r1", [[2, 0, 0], [0, 2, 0], [0, 0, 2]]),
        ("coriolis.vector.reduction", 0.795),
        ("coriolis.seat_x.reduction", 0.66),
        ("coriolis.seat_y.reduction", 0.87),
        ("coriolis.seat_z.reduction", 0.89),
    ):
        set_at(run.metrics, path, value)
    text = Page(render_report([run])).text
    assert (
        "Took 79.5 % off the whole vector, 66.0 % off seat x, 87.0 % off seat y and "
        "89.0 % off seat z." in text
    )
    assert "moved, not removed" not in text


@pytest.mark.usefixtures("undrawn")
def test_a_desired_motion_over_a_limit_is_marked(stored: Callable[..., StoredRun]) -> None:
    run = stored()
    set_at(run.metrics, "limits.desired.fork.rate_peak_rad_s", 3.5)
    set_at(run.metrics, "limits.desired.cab.rate_step_rad_s", 0.087)
    set_at(run.metrics, "limits.desired.cab.ok", False)
    text = Page(render_report([run])).text
    assert "3.5000 exceeds" in text
    assert "cab step of the rate [rad/s] – 0.0870 0.0000" in text
    assert "cab, all limits broken kept" in text


@pytest.mark.usefixtures("undrawn")
def test_the_budget_and_what_the_limits_changed_are_told(
    stored: Callable[..., StoredRun],
) -> None:
    run = stored()
    assert "Spent of its budget" not in Page(render_report([run])).text
    set_at(run.metrics, "solver.budget", {"seat_g_rms_error_g": 0.1312})
    set_at(run.metrics, "solver.limits", "enforce")
    set_at(run.metrics, "executable.replaced", True)
    text = Page(render_report([run])).text
    assert "Spent of its budget: G error 0.131 of 0.1312 g." in text
    assert "budget G error ≤ 0.1312 g" in text
    assert "beyond the machine's limits is rounded by less than anybody could notice" in text
    set_at(run.metrics, "executable.joint_change_max_rad.cab", 0.0123)
    set_at(run.metrics, "executable.joint_change_relative", 0.0042)
    text = Page(render_report([run])).text
    assert "(cab by up to 0.0123 rad; 0.42 % of the joint angles)" in text
    assert "could notice" not in text
    assert "desired motion changed for the limits 0.42 %" in text


@pytest.mark.usefixtures("undrawn")
def test_what_the_pilot_feels_is_on_tiles_and_in_tables(stored: Callable[..., StoredRun]) -> None:
    run = stored()
    total = "felt.seat_angular_acceleration.magnitude"
    for path, value in (
        (f"{total}.rms_before_rad_s2", 0.462),
        (f"{total}.rms_after_rad_s2", 0.447),
        (f"{total}.peak_before_rad_s2", 0.539),
        (f"{total}.peak_after_rad_s2", 0.521),
        ("felt.seat_g.gz.onset_after_g_s", 0.79),
        ("limits.modified.cab.jerk_limit_rad_s3", 10.0),
    ):
        set_at(run.metrics, path, value)
    html = render_report([run])
    text = Page(html).text
    for words in (
        "Total angular acceleration 0.462 → 0.447 rad/s² rms; peak 0.539 → 0.521",
        "Seat rate off by 21.4 %",
        "Seat G off by 0.131 g rms; tilt 6.4° at most",
        "Peak Gy 1.4 → 1.2 g",
        "Gz onset 0.8 → 0.79 g/s",
        "Start as in the profile",
        "End off by arm −68.8 deg and arm +1.15 deg/s",
        "|α| [rad/s²] 0.4620 0.4470 0.5390 0.5210",
        "Gy −1.400 → −1.200 0.900 → 0.800 0.800 → 0.700 0.000 → 0.010 0.080",
        "cab jerk [rad/s³] 10 1.1000 1.1000",
        "arm, sign changes of its acceleration 3 3",
        "total angular acceleration, rms [rad/s²] 0.462 → 0.447",
    ):
        assert words in text, words
    assert "Worse to sit in" not in text
    assert 'class="value bad"' not in html


@pytest.mark.usefixtures("undrawn")
def test_a_ride_that_got_worse_is_said_first_and_marked(stored: Callable[..., StoredRun]) -> None:
    run = stored()
    total = "felt.seat_angular_acceleration.magnitude"
    for path, value in (
        (f"{total}.rms_before_rad_s2", 0.462),
        (f"{total}.rms_after_rad_s2", 2.2),
        (f"{total}.peak_before_rad_s2", 0.539),
        (f"{total}.peak_after_rad_s2", 0.539),
        ("felt.seat_g.gy.peak_after_g", 1.9),
        ("fidelity.start_error.cab_rad_s", -0.3),
    ):
        set_at(run.metrics, path, value)
    html = render_report([run])
    first = html.partition('<div class="summary">')[2].partition("</p>")[0].strip()
    assert first == (
        "<p>Worse to sit in: total angular acceleration 0.462 → 2.2 rad/s² rms, "
        "peak Gy 1.4 → 1.9 g, start off by cab −0.3 rad/s."
    )
    for cell in (
        '<span class="value bad">0.462 → 2.2</span>',
        '<span class="value bad">1.4 → 1.9</span>',
        '<span class="value bad">cab −17.2 deg/s</span>',
        '<td class="bad">0.462 → 2.2</td>',
        '<td class="bad">2.2000</td>',
    ):
        assert cell in html, cell
    assert '<td class="bad">0.5390</td>' not in html


@pytest.mark.usefixtures("undrawn")
def test_violations_and_notices_are_listed(stored: Callable[..., StoredRun]) -> None:
    run = stored()
    run.metrics["violations"] = ["desired cab rate step 0.087", "modified arm <rate> too fast"]
    run.metrics["notices"] = ["one component was bought"]
    page = Page(render_report([run]))
    assert len(page.all("li")) == 2
    for words in run.metrics["violations"] + run.metrics["notices"]:
        assert words in page.text


@pytest.mark.usefixtures("undrawn")
def test_acceptable_is_not_called_converged(stored: Callable[..., StoredRun]) -> None:
    run = stored()
    set_at(run.metrics, "solver.status", "acceptable")
    set_at(run.metrics, "solver.converged", False)
    text = render_report([run])
    assert '<td class="bad">acceptable, not converged</td>' in text
    assert "stopped short of its tolerance (acceptable)" in text
    assert "did not converge" not in text


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
@pytest.mark.parametrize(
    ("reduction", "words"), [(0.639, "takes 63.9 % off"), (-0.0793, "adds 7.9 % to")]
)
def test_the_studys_sweep_is_told_as_it_is(
    stored: Callable[..., StoredRun], reduction: float, words: str
) -> None:
    run = stored()
    set_at(run.metrics, "baseline.report_sweep.reduction", reduction)
    text = Page(render_report([run])).text
    assert f"The study's single sweep {words} what is weighed, at 24.0 % joint deviation." in text


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


def paths(metrics: dict[str, Any], prefix: str = "") -> list[str]:
    found = []
    for key, value in metrics.items():
        found.append(prefix + key)
        if isinstance(value, dict):
            found += paths(value, f"{prefix}{key}.")
    return found


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
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
        Page(render_report([run]))


def test_a_report_of_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one run"):
        render_report([])
