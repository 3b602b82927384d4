"""What became of each part of the Coriolis vector: the section ``coriolis``."""

from __future__ import annotations

from des_cli.model.arrays import Floats, length
from des_cli.model.coriolis import COMPONENTS, Component
from des_cli.model.felt import TurningSizes
from des_cli.model.metrics import CrossCoupling, Objective, Part
from des_cli.model.motion import integrate_sides
from des_cli.model.response import Response
from des_cli.reduction.baseline import relative_reduction
from des_cli.results.felt import peak, rms


def coriolis_metrics(
    step: Floats, before: Response, after: Response, objective: float | None
) -> CrossCoupling:
    """Return reduction, RMS and peak of each part of the Coriolis vector.

    Parameters
    ----------
    step : (n - 1,) array
        [s]
    before, after : Response
    objective : float or None
        Reduction of what is weighed.
    """
    parts = {}
    for component in COMPONENTS:
        old, new = _part(before, component), _part(after, component)
        energies = (float(integrate_sides(step, side**2)) for side in (old, new))
        sizes = TurningSizes(rms(step, old), rms(step, new), peak(old), peak(new))
        parts[component.key] = Part(relative_reduction(*energies), sizes)
    return CrossCoupling(parts, Objective(objective))


def _part(response: Response, component: Component) -> Floats:
    """Return one part of the Coriolis vector, (n - 1, 2) [rad/s^2]."""
    if component.axes is None:
        return length(response.coriolis_seat)
    report = component.axes == "report"
    return (response.coriolis_report if report else response.coriolis_seat)[..., component.index]
