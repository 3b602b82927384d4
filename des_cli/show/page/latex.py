"""The tables of a run as LaTeX, to paste into a paper."""

from __future__ import annotations

from typing import TYPE_CHECKING

from des_cli.show.page.cells import Cell

if TYPE_CHECKING:
    from des_cli.show.page.section import Section

# What LaTeX would take for a command, and the few letters that its fonts lack.
_ESCAPES = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    **{letter: f"\\{letter}" for letter in "#$%&_"},
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "→": r"$\to$",
    "−": r"$-$",
    "–": "--",
    "²": r"$^2$",
    "³": r"$^3$",
    "∫": r"$\int$",
    "α": r"$\alpha$",
    "|": r"\textbar{}",
    "\u00a0": "~",
}
_TRANSLATED = str.maketrans(_ESCAPES)


def escape(text: str) -> str:
    r"""Return a text as LaTeX prints it.

    >>> escape("50_% → 3 rad/s²")
    '50\\_\\% $\\to$ 3 rad/s$^2$'
    """
    return text.translate(_TRANSLATED)


def latex_table(section: Section) -> str:
    """Return the cross-coupling and the limits of a run as one table."""
    lines = [
        r"\begin{tabular}{lrrrrr}",
        _row(["component", "change", "rms before", "rms after", "peak before", "peak after"]),
        r"\hline",
        *(_row([cell.text for cell in row]) for row in section.coriolis),
        *_turning(section.turning),
        r"\end{tabular}",
    ]
    return "\n".join(lines)


def _turning(rows: list[list[Cell]]) -> list[str]:
    return [_row([row[0].text, "", *(cell.text for cell in row[1:])]) for row in rows]


def _row(cells: list[str]) -> str:
    return " & ".join(map(escape, cells)) + r" \\"
