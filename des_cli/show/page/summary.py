"""What a run did, in sentences that name the price beside the gain."""

from __future__ import annotations

from des_cli.model.coriolis import COMPONENTS, ComponentKey
from des_cli.model.metric import (
    JOINT_DEVIATION,
    JOINT_DEVIATION_SQUARED,
    SEAT_G_ERROR,
    SEAT_RATE_DEVIATION,
)
from des_cli.model.metrics import Metrics
from des_cli.results.worse import worse_words
from des_cli.show.page.cells import limits_cell
from des_cli.show.standing import budget_words, change_words
from des_cli.show.weighted import weighted_component
from des_cli.show.words import PAGE, in_sentence, listed, text_of

# A component that grows by less is rounding, or noise in a component that
# hardly exists.
_WORTH_A_WORD = 0.005


def summary_sentences(metrics: Metrics) -> list[str]:
    """Return the summary of a run.

    Parameters
    ----------
    metrics : Metrics

    Returns
    -------
    list of str
        What got worse to sit in; the gain; what is felt of it; what was allowed;
        what keeping the limits changed; which components grew; what is wrong; what
        it and simpler ways cost by the study's measure. What is not known is left out.
    """
    sentences = [
        _worse(metrics),
        _gain(metrics),
        _felt(metrics),
        _allowed(metrics),
        _changed(metrics),
        _moved(metrics),
        _wrong(metrics),
        _study(metrics),
    ]
    return [sentence for sentence in [*sentences, *_baselines(metrics)] if sentence]


def _worse(metrics: Metrics) -> str:
    found = PAGE.sentence(worse_words(metrics))
    return f"{found[0].upper()}{found[1:]}." if found else ""


def _gain(metrics: Metrics) -> str:
    weighted = weighted_component(metrics.solver)
    keys: list[ComponentKey] = (
        [weighted, "vector"] if weighted else ["vector", "seat_x", "seat_y", "seat_z"]
    )
    reductions = {key: metrics.coriolis.reduction(key) for key in keys}
    taken = [
        f"{PAGE.percent(value)} off {in_sentence(key)}"
        for key, value in reductions.items()
        if value is not None and value >= 0
    ]
    if not taken:
        return "Took nothing off the cross-coupling."
    return f"Took {listed(taken)}."


def _allowed(metrics: Metrics) -> str:
    budget = budget_words(metrics)
    return f"Spent of its budget: {budget}." if budget else ""


def _changed(metrics: Metrics) -> str:
    if metrics.executable.replaced is not True:
        return ""
    changed = change_words(metrics.executable.change)
    if not changed:
        return (
            "What the profile asks for beyond the machine's limits is rounded by less than "
            "anybody could notice."
        )
    whole = PAGE.percent(metrics.executable.change.joint_change_relative)
    return (
        "The machine cannot make the motion that the profile asks for: the nearest one inside "
        f"its limits is the desired motion here ({changed}; {whole} of the joint angles)."
    )


def _felt(metrics: Metrics) -> str:
    rate = metrics.fidelity.value(SEAT_RATE_DEVIATION)
    error = metrics.fidelity.value(SEAT_G_ERROR)
    turning = metrics.felt.turning.rms
    parts = []
    if rate is not None:
        parts.append(f"the seat's angular rate is off by {PAGE.percent(rate)}")
    if error is not None:
        parts.append(f"its G-vector by {PAGE.number(error, 3)} g rms")
    if turning.known is not None:
        parts.append(
            f"the total angular acceleration is {PAGE.number(turning.after, 3)} rad/s² rms, "
            f"{PAGE.number(turning.before, 3)} before"
        )
    return f"What the pilot feels of it: {listed(parts)}." if parts else ""


def _study(metrics: Metrics) -> str:
    cost = metrics.fidelity.value(JOINT_DEVIATION)
    squared = metrics.fidelity.value(JOINT_DEVIATION_SQUARED)
    if cost is None:
        return ""
    return (
        f"By the study's measure: {PAGE.percent(cost)} joint deviation "
        f"({PAGE.percent(squared)} squared)."
    )


def _moved(metrics: Metrics) -> str:
    grown = []
    axes = metrics.solver.axes
    for component in COMPONENTS:
        if axes == "seat" and component.axes == "report":
            continue  # the pilot feels none of the study's components by itself
        reduction = metrics.coriolis.reduction(component.key)
        if reduction is not None and reduction < -_WORTH_A_WORD:
            grown.append(f"{in_sentence(component.key)} by {PAGE.percent(-reduction)}")
    if not grown:
        return ""
    return f"It was partly moved, not removed: the squared integral grew for {listed(grown)}."


def _wrong(metrics: Metrics) -> str:
    parts = []
    status = text_of(metrics.solver.status)
    if status == "acceptable":
        parts.append(
            "The solver stopped short of its tolerance (acceptable): the motion is verified, "
            "but not quite the best one."
        )
    elif metrics.solver.converged is False:
        parts.append(f"The solver did not converge ({status}).")
    limits = limits_cell(metrics)
    if limits.mark == "bad":
        parts.append(f"The modified motion breaks limits of the machine; {limits.text}.")
    return " ".join(parts)


def _baselines(metrics: Metrics) -> list[str]:
    sentences = []
    constant, sweep = metrics.baseline.constant_p, metrics.baseline.report_sweep
    if constant and constant.p is not None and constant.joint_deviation is not None:
        sentences.append(
            f"A constant p = {PAGE.number(constant.p, 3)} reaches the same reduction at "
            f"{PAGE.percent(constant.joint_deviation)} joint deviation."
        )
    if sweep and sweep.reduction is not None and sweep.joint_deviation is not None:
        takes, off = ("takes", "off") if sweep.reduction >= 0 else ("adds", "to")
        sentences.append(
            f"The study's single sweep {takes} {PAGE.percent(abs(sweep.reduction))} {off} what is "
            f"weighed, at {PAGE.percent(sweep.joint_deviation)} joint deviation."
        )
    return sentences
