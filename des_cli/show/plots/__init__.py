"""The figures of a run, and of many on one curve, as PNG.

Importing this package imports matplotlib, which costs half a second: do it
where a figure is drawn, not at the top of a module.
"""

from des_cli.show.plots.figures import CAPTIONS, draw_plots
from des_cli.show.plots.tradeoff import draw_tradeoff

__all__ = ["CAPTIONS", "draw_plots", "draw_tradeoff"]
