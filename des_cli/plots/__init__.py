"""The figures of a run, as PNG.

Importing this package imports matplotlib, which costs half a second: do it
where a figure is drawn, not at the top of a module.
"""

from des_cli.plots.figures import CAPTIONS, draw_plots

__all__ = ["CAPTIONS", "draw_plots"]
