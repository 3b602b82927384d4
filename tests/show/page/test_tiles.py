"""What the pilot feels, on tiles."""

from collections.abc import Callable

from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.page import render_report
from tests.support.page import Page, set_at


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
        "Cross-coupling",
        "Total angular acceleration 0.462 → 0.447 rad/s² rms; peak 0.539 → 0.521",
        "Seat rate off by 21.4 %",
        "Gy 1.4 → 1.2; off by 0.131 rms",
        "Smallest limit margin",
        "Start as in the profile end off by arm −68.8 deg and arm +1.15 deg/s",
        "|α| [rad/s²] 0.4620 0.4470 0.5390 0.5210",
        "Gy −1.400 → −1.200 0.900 → 0.800 0.800 → 0.700 0.000 → 0.010 0.080",
        "cab jerk [rad/s³] 10 1.1000 1.1000",
        "arm, sign changes of its acceleration 3 3",
    ):
        assert words in text, words
    assert "Worse to sit in" not in text
    assert 'class="value bad"' not in html
