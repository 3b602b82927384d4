"""What the weight of a run looks at, read from its metrics.

The metrics may come from a file: what is missing or of another form is not an
error here.
"""

from __future__ import annotations

from des_cli.model.coriolis import COMPONENTS, ComponentKey
from des_cli.model.metrics import SolverFacts


def weighted_component(solver: SolverFacts) -> ComponentKey | None:
    """Return the one component that R1 weighs, None if it weighs several.

    Metrics that do not name R1 are taken for the study's, which weighs BB3,
    where their axes are the study's.

    >>> weighted_component(SolverFacts(axes="seat", r1=((2, 0), (0, 2))))
    >>> weighted_component(SolverFacts(axes="report"))
    'bb3'
    """
    names = [each.key for each in COMPONENTS if each.axes is not None and each.axes == solver.axes]
    if not names:
        return None
    try:
        weights = [bool((solver.r1 or ())[i][i]) for i in range(3)]
    except LookupError:
        return "bb3" if solver.axes == "report" else None
    return names[weights.index(True)] if sum(weights) == 1 else None
