"""One point of the trade-off between Coriolis reduction and deviation: plain data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

if TYPE_CHECKING:
    from des_cli.model.metric import MetricKey
    from des_cli.model.profile import Control

Means: TypeAlias = Literal["optimum", "report-sweep", "constant-p"]

SOLVED = ("converged", "acceptable")
"""Statuses of an optimum whose numbers may be used."""

BASELINE = "baseline"
"""Status of a point that was computed and not searched for."""


@dataclass(frozen=True, slots=True)
class TradePoint:
    """How much Coriolis one setting takes off, and at what deviation.

    Parameters
    ----------
    algorithm : {"optimum", "report-sweep", "constant-p"}
        The last two are baselines: the study's single sweep, and one constant
        factor on all rates.
    control : {"free", "scalar", "per-joint"}
    swept : str
        What was varied: the metric of a budget, ``r2`` or ``p``.
    value : float
        Its value.
    status : str
        Of the solution; ``unverified`` where a check failed, ``failed`` where
        there is no solution to speak of, ``baseline`` for a baseline.
    objective_reduction, ... : float or None
        1 - int after^2 / int before^2 of what ``r1`` weighs and of the parts of
        the Coriolis vector.
    joint_deviation_relative, ... : float or None
        As in the ``fidelity`` of the metrics.
    seat_angular_acceleration_rms_rad_s2, ..._peak_rad_s2 : float or None
        Size of the total angular acceleration of the modified motion, as in ``felt``
        of the metrics.
    seat_angular_acceleration_rms_before_rad_s2, ..._peak_before_rad_s2 : float or None
        The same of what the profile asks for.
    cost : float or None
        J. Of a budget without the price of its measure.
    iterations : int
    limits_ok : bool or None
        Whether the modified motion keeps every limit of the machine.
    message : str
        One sentence for a person.

    Notes
    -----
    Without a usable solution there are no numbers: they are None.
    """

    algorithm: Means
    control: Control
    swept: str
    value: float
    status: str
    objective_reduction: float | None = None
    bb3_reduction: float | None = None
    vector_reduction: float | None = None
    seat_x_reduction: float | None = None
    seat_y_reduction: float | None = None
    seat_z_reduction: float | None = None
    joint_deviation_relative: float | None = None
    seat_rate_deviation_relative: float | None = None
    seat_g_rms_error_g: float | None = None
    seat_angular_acceleration_rms_error_rad_s2: float | None = None
    seat_angular_acceleration_rms_before_rad_s2: float | None = None
    seat_angular_acceleration_rms_rad_s2: float | None = None
    seat_angular_acceleration_peak_before_rad_s2: float | None = None
    seat_angular_acceleration_peak_rad_s2: float | None = None
    attitude_error_max_deg: float | None = None
    cost: float | None = None
    iterations: int = 0
    limits_ok: bool | None = None
    message: str = ""

    def fidelity(self, metric: MetricKey) -> float | None:
        """Return a fidelity metric, None where it is not known or not among the columns."""
        found: Any = getattr(self, metric, None)
        return None if found is None else float(found)

    @property
    def solved(self) -> bool:
        """Whether there is an optimum that may be used."""
        return self.algorithm == "optimum" and self.status in SOLVED

    @property
    def answered(self) -> bool:
        """Whether the question has an answer: a solution, or that there is none."""
        return self.solved or self.status == "infeasible"
