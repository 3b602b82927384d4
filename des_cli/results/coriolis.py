"""What became of each part of the Coriolis vector: the section ``coriolis``."""

from __future__ import annotations

from typing import Any

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.coriolis import COMPONENTS, Component
from des_cli.model.motion import integrate_sides
from des_cli.model.response import Response
from des_cli.results.felt import rms


def coriolis_metrics(step: Floats, before: Response, after: Response) -> dict[str, Any]:
    """Return reduction, RMS and peak of each part of the Coriolis vector.

    Parameters
    ----------
    step : (n - 1,) array
        [s]
    before, after : Response

    Returns
    -------
    dict
        By the keys of ``COMPONENTS``; reduction is 1 - int after^2 / int before^2,
        and None where there was nothing to reduce.
    """
    found: dict[str, Any] = {}
    for component in COMPONENTS:
        old, new = _part(before, component), _part(after, component)
        energies = (float(integrate_sides(step, side**2)) for side in (old, new))
        found[component.key] = {
            "reduction": relative_reduction(*energies),
            "rms_before_rad_s2": rms(step, old),
            "rms_after_rad_s2": rms(step, new),
            "peak_before_rad_s2": float(np.max(np.abs(old))),
            "peak_after_rad_s2": float(np.max(np.abs(new))),
        }
    return found


def _part(response: Response, component: Component) -> Floats:
    """Return one part of the Coriolis vector, (n - 1, 2) [rad/s^2]."""
    if component.axes is None:
        return np.asarray(np.linalg.norm(response.coriolis_seat, axis=-1))
    report = component.axes == "report"
    return (response.coriolis_report if report else response.coriolis_seat)[..., component.index]


def relative_reduction(before: float, after: float) -> float | None:
    """Return 1 - after / before, None where there was nothing before."""
    return 1.0 - after / before if before > 1e-24 else None
