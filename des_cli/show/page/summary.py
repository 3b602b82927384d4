"""What a run did, in sentences that name the price beside the gain."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from des_cli.model.coriolis import COMPONENTS
from des_cli.results.reading import lookup, number
from des_cli.results.worse import worse_words
from des_cli.show.page.comparison import limits_cell
from des_cli.show.page.numbers import percent, plain, words
from des_cli.show.plots.standing import budget_words, change_words
from des_cli.show.plots.weighted import weighted_component

_NAMES: Mapping[str, str] = {
    component.key: component.label if component.axes else f"the {component.label}"
    for component in COMPONENTS
}

_TOTAL = "felt.seat_angular_acceleration.magnitude"

# A component that grows by less is rounding, or noise in a component that
# hardly exists.
_WORTH_A_WORD = 0.005


def summary_sentences(metrics: Mapping[str, Any]) -> list[str]:
    """Return the summary of a run.

    Parameters
    ----------
    metrics : mapping
        The content of ``metrics.json``.

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


def _worse(metrics: Mapping[str, Any]) -> str:
    found = worse_words(metrics).replace("->", "→").replace(" -", " −")
    return f"{found[0].upper()}{found[1:]}." if found else ""


def _gain(metrics: Mapping[str, Any]) -> str:
    weighted = weighted_component(metrics)
    keys = [weighted, "vector"] if weighted else ["vector", "seat_x", "seat_y", "seat_z"]
    reductions = {key: number(metrics, f"coriolis.{key}.reduction") for key in keys}
    taken = [
        f"{percent(value)} off {_NAMES[key]}"
        for key, value in reductions.items()
        if value is not None and value >= 0
    ]
    if not taken:
        return "Took nothing off the cross-coupling."
    return f"Took {_listed(taken)}."


def _allowed(metrics: Mapping[str, Any]) -> str:
    budget = budget_words(metrics)
    return f"Spent of its budget: {budget}." if budget else ""


def _changed(metrics: Mapping[str, Any]) -> str:
    if lookup(metrics, "executable.replaced") is not True:
        return ""
    changed = change_words(metrics)
    if not changed:
        return (
            "What the profile asks for beyond the machine's limits is rounded by less than "
            "anybody could notice."
        )
    whole = percent(number(metrics, "executable.joint_change_relative"))
    return (
        "The machine cannot make the motion that the profile asks for: the nearest one inside "
        f"its limits is the desired motion here ({changed}; {whole} of the joint angles)."
    )


def _felt(metrics: Mapping[str, Any]) -> str:
    rate = number(metrics, "fidelity.seat_rate_deviation_relative")
    error = number(metrics, "fidelity.seat_g_rms_error_g")
    before, after = (number(metrics, f"{_TOTAL}.rms_{when}_rad_s2") for when in ("before", "after"))
    parts = []
    if rate is not None:
        parts.append(f"the seat's angular rate is off by {percent(rate)}")
    if error is not None:
        parts.append(f"its G-vector by {plain(error, 3)} g rms")
    if before is not None and after is not None:
        parts.append(
            f"the total angular acceleration is {plain(after, 3)} rad/s² rms, "
            f"{plain(before, 3)} before"
        )
    return f"What the pilot feels of it: {_listed(parts)}." if parts else ""


def _study(metrics: Mapping[str, Any]) -> str:
    cost = number(metrics, "fidelity.joint_deviation_relative")
    squared = number(metrics, "fidelity.joint_deviation_relative_squared")
    if cost is None:
        return ""
    return f"By the study's measure: {percent(cost)} joint deviation ({percent(squared)} squared)."


_STUDY = frozenset(each.key for each in COMPONENTS if each.axes == "report")


def _moved(metrics: Mapping[str, Any]) -> str:
    grown = []
    axes = lookup(metrics, "solver.axes")
    for key, name in _NAMES.items():
        if axes == "seat" and key in _STUDY:
            continue  # the pilot feels none of the study's components by itself
        reduction = number(metrics, f"coriolis.{key}.reduction")
        if reduction is not None and reduction < -_WORTH_A_WORD:
            grown.append(f"{name} by {percent(-reduction)}")
    if not grown:
        return ""
    return f"It was partly moved, not removed: the squared integral grew for {_listed(grown)}."


def _wrong(metrics: Mapping[str, Any]) -> str:
    parts = []
    status = words(lookup(metrics, "solver.status"))
    if status == "acceptable":
        parts.append(
            "The solver stopped short of its tolerance (acceptable): the motion is verified, "
            "but not quite the best one."
        )
    elif lookup(metrics, "solver.converged") is False:
        parts.append(f"The solver did not converge ({status}).")
    limits = limits_cell(metrics)
    if limits.mark == "bad":
        parts.append(f"The modified motion breaks limits of the machine; {limits.text}.")
    return " ".join(parts)


def _baselines(metrics: Mapping[str, Any]) -> list[str]:
    sentences = []
    p = number(metrics, "baseline.constant_p.p")
    cost = number(metrics, "baseline.constant_p.joint_deviation_relative")
    if p is not None and cost is not None:
        sentences.append(
            f"A constant p = {plain(p, 3)} reaches the same reduction at {percent(cost)} "
            "joint deviation."
        )
    reduction = number(metrics, "baseline.report_sweep.reduction")
    cost = number(metrics, "baseline.report_sweep.joint_deviation_relative")
    if reduction is not None and cost is not None:
        sentences.append(
            f"The study's single sweep {'takes' if reduction >= 0 else 'adds'} "
            f"{percent(abs(reduction))} {'off' if reduction >= 0 else 'to'} what is weighed, "
            f"at {percent(cost)} joint deviation."
        )
    return sentences


def _listed(parts: Sequence[str]) -> str:
    """Join parts as a sentence does.

    >>> _listed(["a"]), _listed(["a", "b"]), _listed(["a", "b", "c"])
    ('a', 'a and b', 'a, b and c')
    """
    return " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)
