"""The summary of a run on the page: the price, what got worse, what it was allowed."""

from collections.abc import Callable

import pytest

from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.page import render_report
from tests.support.page import Page, set_at


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
        '<span class="bad">g; Gy 1.4 → 1.9; off by 0.131 rms</span>',
        '<span class="label">Start off by</span><span class="value bad">cab −17.2 deg/s</span>',
        '<td class="bad">2.2000</td>',
    ):
        assert cell in html, cell
    assert '<td class="bad">0.5390</td>' not in html


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
