"""What the page brings along: its style, its scripts, and the library that draws its plots.

The library is Bokeh's script. It is taken from the installed package when a page is made,
never copied into this one, and nothing of Bokeh is imported: only the script is read.
"""

from __future__ import annotations

import base64
import functools
import hashlib
import importlib.resources
import importlib.util
from pathlib import Path

from des_cli.errors import Complaint, FileAccessError

_SCRIPTS = (
    "data.js",
    "plots.js",
    "drawing.js",
    "clock.js",
    "paper.js",
    "exports.js",
    "table.js",
    "start.js",
)
"""In the order in which they stand in the page; they share one scope."""


@functools.cache
def page_script() -> str:
    """Return the page's own script."""
    parts = map(script_part, _SCRIPTS)
    return '"use strict";\n(() => {\n' + "\n".join(parts) + "\n})();\n"


def script_part(name: str) -> str:
    """Return one file of the page's own script."""
    folder = importlib.resources.files("des_cli.show.page") / "scripts"
    return (folder / name).read_text("utf-8")


@functools.cache
def plot_library() -> str:
    """Return Bokeh's script.

    Raises
    ------
    FileAccessError
        If Bokeh is not installed, or its script is not where it should be.
    """
    # find_spec of a top-level package runs none of its code; importing it takes half a second.
    spec = importlib.util.find_spec("bokeh")
    for folder in (spec and spec.submodule_search_locations) or ():
        path = Path(folder) / "server" / "static" / "js" / "bokeh.min.js"
        if path.is_file():
            return path.read_text("utf-8").replace("</script", r"<\/script")
    what = "is not installed, and the page's plots need it: pip install bokeh"
    raise FileAccessError([Complaint("bokeh", what)])


@functools.cache
def policy_source(script: str) -> str:
    """Return what the page's policy calls a script that may run: the digest of its text."""
    digest = hashlib.sha256(script.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode('ascii')}'"
