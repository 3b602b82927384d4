"""The documentation as a site, by Sphinx: ``nox -s site``.

The pages are those of the repository, read in place: the source folder is the root, README.md
the first page, and every link leads where it leads there. Nothing in the site asks for a network.
"""

from __future__ import annotations

from pathlib import Path

from sphinx.application import Sphinx

project = "des-coriolis"
author = "The des-coriolis authors"
copyright = ""
root_doc = "README"
extensions = ["myst_parser"]
include_patterns = [
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "docs/*.md",
    "docs/howto/*.md",
    "docs/reference/*.md",
]
source_suffix = {".md": "markdown"}
myst_heading_anchors = 4
exclude_patterns = ["build", ".nox", ".venv"]
nitpicky = True
html_theme = "furo"
html_title = "des-coriolis"
html_show_sphinx = False
html_show_copyright = False
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {"top_of_page_buttons": []}

CONTENTS = {
    "": ["docs/tutorial"],
    "How-tos": [
        "docs/howto/machine",
        "docs/howto/flight-log",
        "docs/howto/g-profile",
        "docs/howto/budget",
        "docs/howto/trade-off",
        "docs/howto/console",
        "docs/python",
        "docs/howto/troubleshooting",
    ],
    "Reference": [
        "docs/cli",
        "docs/formats",
        "docs/machines",
        "docs/reference/metrics",
        "docs/reference/columns",
        "docs/reference/exit-codes",
        "docs/reference/python",
        "docs/nomenclature",
    ],
    "Explanation": [
        "docs/theory",
        "docs/study",
        "docs/credibility",
        "docs/architecture",
        "docs/performance",
        "docs/scale",
        "docs/references",
    ],
    "Project": ["CHANGELOG", "CONTRIBUTING", "SECURITY"],
}
"""The navigation, which README.md has only here; a page that it lacks is a warning."""


def add_contents(app: Sphinx, docname: str, source: list[str]) -> None:
    """Give the first page the tables of contents."""
    if docname == root_doc:
        for caption, pages in CONTENTS.items():
            lines = ["```{toctree}", ":hidden:", *([f":caption: {caption}"] if caption else [])]
            source[0] += "\n\n" + "\n".join([*lines, "", *pages, "```"]) + "\n"


def add_index(app: Sphinx, exception: Exception | None) -> None:
    """Lead from the folder of the site to its first page."""
    if exception is None:
        leads = f'<!doctype html><meta http-equiv="refresh" content="0; url={root_doc}.html">'
        (Path(app.outdir) / "index.html").write_text(leads + "\n", encoding="utf-8")


def setup(app: Sphinx) -> None:
    """Register both."""
    app.connect("source-read", add_contents)
    app.connect("build-finished", add_index)
