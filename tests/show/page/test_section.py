"""The section of one run: its standing, limits and notices."""

from collections.abc import Callable

from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.page import render_report
from tests.support.page import Page, set_at


def test_a_desired_motion_over_a_limit_is_marked(stored: Callable[..., StoredRun]) -> None:
    run = stored()
    set_at(run.metrics, "limits.desired.fork.rate_peak_rad_s", 3.5)
    set_at(run.metrics, "limits.desired.cab.rate_step_rad_s", 0.087)
    set_at(run.metrics, "limits.desired.cab.ok", False)
    text = Page(render_report([run])).text
    assert "3.5000 exceeds" in text
    assert "cab step of the rate [rad/s] – 0.0870 0.0000" in text
    assert "cab, all limits broken kept" in text


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
    assert "beyond the machine's limits is rounded by less than anybody could notice" in text
    set_at(run.metrics, "executable.joint_change_max_rad.cab", 0.0123)
    set_at(run.metrics, "executable.joint_change_relative", 0.0042)
    text = Page(render_report([run])).text
    assert "(cab by up to 0.0123 rad; 0.42 % of the joint angles)" in text
    assert "could notice" not in text


def test_violations_and_notices_are_listed(stored: Callable[..., StoredRun]) -> None:
    run = stored()
    run.metrics["violations"] = ["desired cab rate step 0.087", "modified arm <rate> too fast"]
    run.metrics["notices"] = ["one component was bought"]
    page = Page(render_report([run]))
    for words in run.metrics["violations"] + run.metrics["notices"]:
        assert words in page.text


def test_acceptable_is_not_called_converged(stored: Callable[..., StoredRun]) -> None:
    run = stored()
    set_at(run.metrics, "solver.status", "acceptable")
    set_at(run.metrics, "solver.converged", False)
    text = render_report([run])
    assert '<span class="word">look</span>' in text
    assert "the solver stopped short of its tolerance" in text
    assert "stopped short of its tolerance (acceptable)" in text
    assert "did not converge" not in text
