"""Runs on one page of HTML that needs no other file and no network."""

from __future__ import annotations

import functools
import re
from collections.abc import Sequence

import jinja2

from des_cli.results.reading import read_metrics
from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.comparison import comparison_rows, labels
from des_cli.show.page.section import run_section

# HTML has no way to write these characters, not even escaped.
_NOT_HTML = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")

NOMENCLATURE: tuple[tuple[str, str], ...] = (
    ("θ₁, θ₂, θ₃", "angles of arm, fork and cab [rad]; Θ are the desired ones"),
    ("p", "factor on the joint rates, one for all joints or one for each [–]"),
    (
        "AB3, BB3, CB3",
        "components of the Coriolis cross-coupling vector c, the rate-product part of the seat's "
        "angular acceleration, along the inertial axes i₀, j₀, k₀ [rad/s²]",
    ),
    ("seat x, y, z", "the same vector along the seat's axes: forward, right, down [rad/s²]"),
    (
        "α = dW/dt",
        "total angular acceleration of the seat, along its axes, cross-coupling and joint "
        "accelerations together: what the semicircular canals answer to [rad/s²]",
    ),
    ("p, q, r", "roll, pitch and yaw rate of the seat, along its axes [rad/s]"),
    ("Gx, Gy, Gz", "specific force at the seat, gravity included [g = 32.2 ft/s²]"),
    ("change", "∫ after² dt / ∫ before² dt − 1; before is the profile, after the modified motion"),
    ("onset", "largest change of a component of G over a tenth of a second, per second"),
    ("tilt", "angle between the G-vectors before and after"),
    (
        "joint deviation",
        "‖θ − Θ‖ / ‖Θ‖ over all joints and samples; the arm's angle, which the pilot does not "
        "feel, dominates it, so the seat's rate and G deviation stand beside it",
    ),
    ("λ", "adjoint: the derivative of the cost J by the joint angles [s/rad]"),
)


def render_report(runs: Sequence[StoredRun]) -> str:
    """Return a page with the runs, side by side and one by one.

    Parameters
    ----------
    runs : sequence of StoredRun
        At least one; they stay in this order.

    Returns
    -------
    str
        HTML. The same runs give the same text: there is no clock time in it.
        Every name and text of the runs is escaped.

    Raises
    ------
    ValueError
        If there is no run.
    """
    if not runs:
        raise ValueError("a report needs at least one run")
    metrics = [read_metrics(run.metrics) for run in runs]
    comparison = comparison_rows(metrics)
    page = (
        _environment()
        .get_template("page.html.j2")
        .render(
            sections=[
                run_section(run, read, label, position)
                for position, (run, read, label) in enumerate(
                    zip(runs, metrics, labels(runs), strict=True), start=1
                )
            ],
            comparison=comparison,
            attention=any(cell.mark == "bad" for row in comparison for cell in row.cells),
            nomenclature=NOMENCLATURE,
        )
    )
    return _NOT_HTML.sub("\ufffd", page)


@functools.cache
def _environment() -> jinja2.Environment:
    """Return the environment that keeps the compiled templates: compiling takes most of a page."""
    return jinja2.Environment(
        loader=jinja2.PackageLoader("des_cli.show.page", "templates"),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
