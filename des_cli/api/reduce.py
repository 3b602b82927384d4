"""``reduce_profile`` of the Python interface: a name, a file or a profile goes in."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeAlias

from des_cli import pipeline
from des_cli.api.run import Run
from des_cli.errors import Complaint, UsageError
from des_cli.model.metric import JOINT_DEVIATION, METRICS, Budget, metric_named
from des_cli.model.profile import Profile
from des_cli.model.solution import Iteration
from des_cli.model.stage import OnStage, untold
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.setting import Setting

Budgets: TypeAlias = Mapping[str, float] | float
"""The most of each metric, by its key; a number alone is the joint deviation's."""


def reduce_profile(
    profile: Profile | str | os.PathLike[str],
    *,
    budget: Budgets | None = None,
    settings: Mapping[str, Any] | None = None,
    on_iteration: Callable[[Iteration], None] | None = None,
    on_stage: OnStage = untold,
) -> Run:
    """Reduce the Coriolis cross-coupling of one maneuver.

    Parameters
    ----------
    profile : Profile, str or path
        What `load_profile` returned, the name of a built-in profile, or a YAML or CSV file.
    budget : mapping of str to float, or float, optional
        The most of each fidelity metric by its key, in its unit, instead of the profile's
        budgets. A number alone is that of the joint deviation, the study's measure.
    settings : mapping of str to object, optional
        Values of other keys by their paths, as ``--set`` gives them:
        ``{"reduction.ends": "match-both"}``. Of a name or a file only.
    on_iteration : callable, optional
        Called with each line of the solver's log.
    on_stage : callable, optional
        Called with a few words for what is done next.

    Returns
    -------
    Run
        Also where there is no solution, or a check failed: ``run.released`` says so.

    Raises
    ------
    ProfileError, FileAccessError
        If the profile cannot be read, with all of its problems.
    UsageError
        If the reduction asks for things that exclude each other, or a budget is on no metric.
    NotReleasedError
        If the profile asks for a G that the machine cannot make at all.
    """
    if isinstance(profile, Profile):
        if settings:
            what = "is read already: give its name or its file to change settings"
            raise UsageError([Complaint(profile.name, what)])
        if budget is not None:
            reduction = replace(profile.reduction, budget=_budgets(budget))
            profile = replace(profile, reduction=reduction)
    else:
        given = [Setting(path, value, f"settings[{path!r}]") for path, value in _items(settings)]
        if budget is not None:
            value = dict(budget) if isinstance(budget, Mapping) else budget
            given.append(Setting("reduction.budget", value, "budget"))
        source = str(profile) if isinstance(profile, str) else Path(profile)
        profile = load_profile(source, settings=given)
    return Run(pipeline.reduce_profile(profile, on_iteration=on_iteration, on_stage=on_stage))


def _items(settings: Mapping[str, Any] | None) -> list[tuple[str, Any]]:
    return [] if settings is None else list(settings.items())


def _budgets(budget: Budgets) -> tuple[Budget, ...]:
    """Return budgets, or say what is wrong with them."""
    given = dict(budget) if isinstance(budget, Mapping) else {JOINT_DEVIATION: budget}
    found, complaints = [], []
    for key, most in given.items():
        metric = metric_named(key)
        if metric is None:
            known = ", ".join(each.key for each in METRICS.values())
            complaints.append(Complaint("budget", f"{key} is no metric: {known}"))
        elif not most > 0.0:
            complaints.append(Complaint(f"budget[{key!r}]", f"must be positive, is {most!r}"))
        else:
            found.append(Budget(metric.key, float(most)))
    if complaints:
        raise UsageError(complaints)
    return tuple(found)
