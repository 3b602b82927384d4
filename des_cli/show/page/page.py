"""Runs on one page of HTML that needs no other file and no network."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import jinja2

from des_cli.results.reading import read_metrics
from des_cli.results.verdict import Word
from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.assets import page_script, plot_library, policy_source
from des_cli.show.page.cells import labels
from des_cli.show.page.latex import latex_table
from des_cli.show.page.packing import columns_for
from des_cli.show.page.panels import Panel
from des_cli.show.page.run_table import COLUMNS, run_rows
from des_cli.show.page.section import run_section
from des_cli.show.words import PAGE

# HTML has no way to write these characters, not even escaped.
_NOT_HTML = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")

_CLASSES: Mapping[Word, str] = {"fly": "fly", "look": "look", "don't": "dont"}

OVERLAID = (
    "Cross-coupling, size after [rad/s²]",
    "Total angular acceleration, size after [rad/s²]",
    "|G| after [g]",
)
"""The plots in which chosen runs lie over each other; ``table.js`` fills them in this order."""

NOMENCLATURE: tuple[tuple[str, str], ...] = (
    ("θ₁, θ₂, θ₃", "angles of arm, fork and cab [rad]; Θ are the desired ones"),
    ("p", "factor on the joint rates, one for all joints or one for each [–]"),
    (
        "AB3, BB3, CB3",
        "components of the Coriolis cross-coupling vector c, the rate-product part of the seat's "
        "angular acceleration, along the inertial axes i₀, j₀, k₀ [rad/s²]",
    ),
    ("seat x, y, z", "the same vector along the seat's axes: forward, right, down [rad/s²]"),
    ("c", "the cross-coupling vector in plots, along the seat's axes; |c| is its size [rad/s²]"),
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
    names, columns = labels(runs), columns_for(len(runs))
    sections = [
        run_section(run, read, name, position, columns)
        for position, (run, read, name) in enumerate(
            zip(runs, metrics, names, strict=True), start=1
        )
    ]
    page = (
        _environment()
        .get_template("page.html.j2")
        .render(
            sections=sections,
            rows=run_rows(names, metrics, [section.verdict for section in sections]),
            columns=COLUMNS,
            overlaid=OVERLAID,
            nomenclature=NOMENCLATURE,
            words=_CLASSES,
            number=PAGE.number,
            sentence=PAGE.sentence,
            joint_panel=_of_joint,
            latex=latex_table,
            policy=" ".join(map(policy_source, (plot_library(), page_script()))),
        )
    )
    # The scripts are not searched for stray characters: they are long, and their digests
    # stand in the policy.
    scripts = "".join(f"<script>{each}</script>\n" for each in (plot_library(), page_script()))
    return _NOT_HTML.sub("\ufffd", page) + scripts + "</body>\n</html>\n"


def _of_joint(joint: str, panel: Panel) -> Panel:
    """Return a panel whose title also names the joint."""
    return replace(panel, title=f"{joint} {panel.title.lower()}")


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
