"""How every figure of a run looks: paper, type, colours, and its PNG bytes.

Sizes are in inches from the edges of the paper, so that the axes of all the
figures of a run line up under each other. pyplot, with its global state and
its windows, stays out.
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Literal, TypeAlias

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, ScalarFormatter
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from des_cli.model.arrays import Floats
from des_cli.show.plots.pens import AXIS, FAINT, INK, NOTE, VERMILION, ZERO, Pen
from des_cli.show.plots.thinning import thin

PictureFormat: TypeAlias = Literal["png", "svg", "pdf"]

WIDTH, LEFT, RIGHT, TOP, BOTTOM, GAP = 9.0, 0.85, 0.2, 0.55, 0.52, 0.3
_DPI = 150

# Keys of matplotlib's defaults that choose a backend or a window, not a look.
_NOT_LOOKS = ("backend", "interactive", "toolbar", "webagg", "tk.", "savefig.directory")


@contextmanager
def style() -> Iterator[None]:
    """Draw in the project's style, whatever the user's matplotlibrc says."""
    looks = {
        key: value
        for key, value in matplotlib.rcParamsDefault.items()
        if not key.startswith(_NOT_LOOKS)
    }
    looks |= {
        "font.family": "DejaVu Sans",
        "font.size": 9.0,
        "axes.edgecolor": AXIS,
        "axes.labelcolor": INK,
        "axes.labelsize": 9.0,
        "axes.linewidth": 0.7,
        "axes.axisbelow": True,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.color": FAINT,
        "grid.linewidth": 0.7,
        "text.color": INK,
        "xtick.color": AXIS,
        "ytick.color": AXIS,
        "xtick.labelcolor": INK,
        "ytick.labelcolor": INK,
        "xtick.labelsize": 8.5,
        "ytick.labelsize": 8.5,
        "xtick.major.width": 0.7,
        "ytick.major.width": 0.7,
        "lines.solid_capstyle": "round",
        "lines.dash_capstyle": "butt",
    }
    with matplotlib.rc_context(looks):
        yield


def sheet(
    title: str,
    pens: Sequence[Pen],
    rows: int,
    columns: int = 1,
    *,
    height: float = 1.55,
    same_scale: bool = False,
) -> tuple[Figure, list[list[Axes]]]:
    """Return an empty figure with a grid of axes over one time axis.

    Parameters
    ----------
    title : str
        At the top left.
    pens : sequence of Pen
        The legend, at the top right and off the data.
    rows, columns : int
    height : float
        Of one row of axes [in].
    same_scale : bool
        Whether all axes share the scale of their ordinate.
    """
    total = TOP + rows * height + (rows - 1) * GAP + BOTTOM
    figure = Figure(figsize=(WIDTH, total), dpi=_DPI, facecolor="white")
    axes = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=same_scale)
    figure.subplots_adjust(
        left=LEFT / WIDTH,
        right=1 - RIGHT / WIDTH,
        top=1 - TOP / total,
        bottom=BOTTOM / total,
        hspace=GAP / height,
        # ordinates of their own need room for numbers and a label in each column
        wspace=0.12 if same_scale else 0.12 + 0.1 * columns,
    )
    line = 1 - 0.2 / total
    figure.text(0.12 / WIDTH, line, title, va="center", ha="left", fontsize=11, fontweight="bold")
    handles = [
        Line2D(
            [],
            [],
            color=pen.color,
            linestyle=pen.dashes,
            linewidth=pen.width,
            marker=pen.marker,
            markersize=6.0,
            markeredgewidth=0.0,
            label=pen.label,
        )
        for pen in pens
    ]
    figure.legend(
        handles=handles,
        loc="center right",
        bbox_to_anchor=(1 - 0.08 / WIDTH, line),
        ncols=max(len(pens), 1),
        frameon=False,
        handlelength=2.6,
        columnspacing=1.6,
        borderaxespad=0.0,
        borderpad=0.0,
    )
    for axis in axes[-1]:
        axis.set_xlabel("t [s]")
    return figure, axes.tolist()


def stamp(figure: Figure, words: str) -> None:
    """Write a warning under the title."""
    total = figure.get_figheight()
    look: dict[str, Any] = {"fontsize": 9, "color": VERMILION, "parse_math": False}
    figure.text(0.12 / WIDTH, 1 - 0.41 / total, words, va="center", ha="left", **look)


def draw(
    axes: Axes, t: Floats, curves: Sequence[tuple[Pen, Floats]], label: str, floor: float
) -> None:
    """Draw curves over time.

    Parameters
    ----------
    axes : Axes
    t : (n,) array
        [s]
    curves : sequence of (Pen, (n,) array)
    label : str
        Quantity and unit of the ordinate.
    floor : float
        The smallest height of the ordinate: differences far below it are
        rounding, and are not blown up to fill the paper.
    """
    for pen, values in curves:
        axes.plot(
            *thin(t, values),
            color=pen.color,
            linestyle=pen.dashes,
            linewidth=pen.width,
            zorder=pen.zorder,
        )
    axes.set_ylabel(label)
    axes.set_xlim(t[0], t[-1])
    axes.axhline(0.0, color=ZERO, linewidth=0.8, zorder=1)
    set_span(axes, [values for _, values in curves], floor)
    axes.yaxis.set_major_locator(MaxNLocator(nbins=5, min_n_ticks=3))
    formatter = ScalarFormatter(useOffset=False)
    formatter.set_powerlimits((-3, 5))
    axes.yaxis.set_major_formatter(formatter)


def set_span(axes: Axes, values: Sequence[Floats], floor: float) -> None:
    """Make the ordinate as high as the values need, but no lower than ``floor``."""
    low = min(float(np.min(each)) for each in values)
    high = max(float(np.max(each)) for each in values)
    half = max(0.54 * (high - low), 0.5 * floor)
    middle = 0.5 * (low + high)
    axes.set_ylim(middle - half, middle + half)


def note(panel: Axes, words: str) -> None:
    """Write a few words above the right end of a panel."""
    # no mathematics: a stranger's words may hold dollar signs
    look: dict[str, Any] = {"fontsize": 8, "color": NOTE, "parse_math": False}
    panel.set_title(words, loc="right", pad=3, **look)


def encode(figure: Figure, title: str, format: PictureFormat) -> bytes:
    """Return a figure in the bytes of a format; equal figures give equal bytes.

    Letters are drawn as outlines in SVG, and embedded in PDF: neither needs a font.
    """
    if format == "png":
        return png(figure, title)
    figure.align_ylabels()
    stream = io.BytesIO()
    # no times, and names of clip paths that do not differ from run to run
    facts: dict[str, Any] = {"Title": title, "Creator": "des-coriolis"}
    facts |= {"Date": None} if format == "svg" else {"CreationDate": None, "Producer": None}
    with matplotlib.rc_context({"svg.hashsalt": "des-coriolis", "pdf.fonttype": 42}):
        figure.savefig(stream, format=format, metadata=facts)
    return stream.getvalue()


def png(figure: Figure, title: str) -> bytes:
    """Return the figure as PNG; equal figures give equal bytes.

    The title is written into the file as an international text (it has Greek
    letters), and no version or time is.
    """
    figure.align_ylabels()
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    picture = Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
    # A palette of so few hues loses nothing that the eye can find, and a page of
    # many runs is a third as large.
    picture = picture.quantize(128, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    facts = PngInfo()
    facts.add_itxt("Title", title)
    facts.add_text("Software", "des-coriolis")
    stream = io.BytesIO()
    picture.save(stream, format="png", optimize=True, dpi=(_DPI, _DPI), pnginfo=facts)
    return stream.getvalue()
