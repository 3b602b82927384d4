"""What a reduction cannot ask for at the same time, refused with a sentence each."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from des_cli.errors import Complaint, UsageError
from des_cli.model.metric import ATTITUDE_ERROR, FACTOR_DEVIATION
from des_cli.model.profile import Reduction


def require_consistent(reduction: Reduction, name: str = "") -> None:
    """Refuse what a method cannot do.

    Parameters
    ----------
    reduction : Reduction
    name : str, optional
        Of the profile that has it.

    Raises
    ------
    UsageError
        With everything that excludes something else.
    """
    where = f"{name}: reduction" if name else "reduction"
    complaints = [
        Complaint(where, what)
        for contradictions in (_of_the_method, _of_the_control, _of_what_is_weighed)
        for what in contradictions(reduction)
    ]
    if complaints:
        raise UsageError(complaints)


def _of_the_method(reduction: Reduction) -> Iterator[str]:
    """Name what the study's sweep and the zero method cannot do."""
    zero = reduction.method == "zero"
    if reduction.algorithm == "report-sweep":
        if reduction.limits == "enforce":
            yield "report-sweep cannot enforce limits: add --limits warn (or check)"
        if zero:
            yield "report-sweep has no method zero"
        if reduction.budget:
            yield "report-sweep needs the weight r2 and cannot keep a budget: add --r2"
        if reduction.jacobian == "adapted":
            yield "report-sweep takes the Jacobian on the desired motion: add --jacobian desired"
        if reduction.control == "free":
            yield "report-sweep finds factors: add --control scalar (or per-joint)"
    if zero and reduction.budget:
        yield "method zero keeps a tolerance, not a budget: leave one of them out"
    if zero and reduction.control == "free":
        yield "method zero finds factors: add --control per-joint (or scalar)"


def _of_the_control(reduction: Reduction) -> Iterator[str]:
    """Name what only free joints can do, and what they cannot."""
    control = reduction.control
    if control == "free":
        if reduction.method == "minimum" and reduction.algorithm == "optimum":
            yield from _of_free_joints(reduction)
        return
    if reduction.objective != "coriolis":
        yield (
            f"objective: {reduction.objective} needs control: free, "
            f"the factors of {control} minimise the Coriolis alone"
        )
    if reduction.optimise:
        yield f"optimise needs control: free, {control} keeps seat and start as they are"
    if reduction.ends == "match-rates":
        yield f"ends: match-rates needs control: free; {control} has match-start and match-both"
    if reduction.hold and control == "scalar":
        yield "hold needs control: per-joint (or free), a scalar factor moves every joint"


def _of_free_joints(reduction: Reduction) -> Iterator[str]:
    """Name what needs a factor on the desired rates, which free joints have none of."""
    if not reduction.budget:
        yield (
            "r2 and tracking weigh factors, which control: free has none of: "
            "add --budget, or --control per-joint (or scalar)"
        )
    if any(budget.metric == FACTOR_DEVIATION for budget in reduction.budget):
        yield (
            f"{FACTOR_DEVIATION} measures factors, which control: free has none of: "
            "add --control per-joint (or scalar)"
        )
    if _turns_seat(reduction) and any(
        budget.metric == ATTITUDE_ERROR for budget in reduction.budget
    ):
        yield "a budget on the attitude is of a seat that stays: leave seat_yaw and seat_pitch out"
    if reduction.jacobian == "adapted":
        yield "jacobian: adapted turns factors into rates, and control: free has none of them"


def _of_what_is_weighed(reduction: Reduction) -> Iterator[str]:
    """Name where nothing is left to reduce, or to reduce it with."""
    if len(reduction.hold) == 3:
        yield "hold leaves no joint to change"
    if not np.any(reduction.r1):
        yield "r1 weighs no Coriolis component"


def _turns_seat(reduction: Reduction) -> bool:
    return any(name.startswith("seat_") for name in reduction.optimise)
