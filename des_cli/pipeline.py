"""The sequence for one profile: desired motion, problem, solution, check, metrics."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from des_cli.kinematics.chain import chain_of
from des_cli.kinematics.response import respond, respond_as_requested
from des_cli.kinematics.smoothing import smooth_command
from des_cli.model.metric import Budget
from des_cli.model.metrics import Metrics
from des_cli.model.motion import DesiredMotion, Motion
from des_cli.model.profile import Profile
from des_cli.model.run import Check, Run
from des_cli.model.solution import Iteration
from des_cli.model.stage import OnStage, untold
from des_cli.reduction.baseline import compare
from des_cli.reduction.consistency import require_consistent
from des_cli.reduction.desired import find_desired, require_makeable
from des_cli.reduction.lead import add_leads
from des_cli.reduction.limits import find_occupant_violations, find_violations
from des_cli.reduction.solve import Found, find_motion
from des_cli.results.metrics import Measured, measure
from des_cli.verify.claim import Claim
from des_cli.verify.verify import verify


@dataclass(frozen=True)
class Prepared:
    """The motions that a reduction begins with.

    Profiles that differ in their ``reduction`` alone have the same: neither motion
    depends on it.

    Parameters
    ----------
    asked : DesiredMotion
        What the profile asks for: the record.
    target : DesiredMotion
        What the reduction begins from: the very same, or what conditioning made of it.
    """

    asked: DesiredMotion
    target: DesiredMotion


def prepare_profile(profile: Profile) -> Prepared:
    """Make the desired motion of a profile.

    Raises
    ------
    UsageError
        If the profile asks for G of a machine whose arm does not turn about the vertical.
    """
    asked = find_desired(profile)
    return Prepared(asked, _conditioned(profile, asked))


def reduce_profile(
    profile: Profile,
    *,
    prepared: Prepared | None = None,
    on_iteration: Callable[[Iteration], None] | None = None,
    on_stage: OnStage = untold,
) -> Run:
    """Reduce the Coriolis of one maneuver.

    Parameters
    ----------
    profile : Profile
    prepared : Prepared, optional
        What `prepare_profile` makes of it, where that is at hand.
    on_iteration : callable, optional
        Called with each line of the solver's log.
    on_stage : callable, optional
        Called with a few words for what is done next, at each step that may take long.

    Returns
    -------
    Run
        Also where the solver did not converge or a check failed:
        ``run.require_release()`` raises what stands against using it.

    Raises
    ------
    UsageError
        If the reduction asks for things that exclude each other.
    NotReleasedError
        If the profile asks for a G that the machine cannot make at all.
    """
    require_makeable(profile)
    require_consistent(profile.reduction, profile.name)
    if prepared is None:
        on_stage("desired motion")
        prepared = prepare_profile(profile)
    asked, target = prepared.asked, prepared.target
    found = find_motion(profile, asked, target, on_iteration, on_stage)
    on_stage("baselines")
    found, led = _with_leads(profile, found)
    most = profile.reduction.budget_of_record
    profile = replace(profile, reduction=replace(profile.reduction, budget=found.budgets))
    modified = found.solution.modified
    before = respond_as_requested(profile.machine, profile.seat, asked)
    after = respond(profile.machine, found.seat, modified)
    measured = Measured(
        profile=profile,
        asked=asked,
        target=target.motion,
        desired=found.desired,
        held=found.held,
        seat=found.seat,
        solution=found.solution,
        before=before,
        after=after,
        violations=(
            *find_violations(profile.machine, asked.motion, "desired"),
            *find_occupant_violations(
                profile.machine, profile.seat, before, asked.motion, "desired"
            ),
            *find_violations(profile.machine, led, "modified"),
            *find_occupant_violations(profile.machine, found.seat, after, modified, "modified"),
        ),
        baselines=compare(found.problem, modified, chain_of(profile.machine, found.seat)),
    )
    results = measure(measured)
    on_stage("verification")
    return Run(
        profile=profile,
        asked=asked,
        desired=found.desired,
        seat=found.seat,
        solution=found.solution,
        commands=led,
        before=before,
        after=after,
        checks=_checks(profile, asked, target, found, led, most, results),
        violations=measured.violations,
        results=results,
    )


def _with_leads(profile: Profile, found: Found) -> tuple[Found, Motion]:
    """Return what was found and its motion with the leads; a lead too short is infeasible."""
    reduction, modified = profile.reduction, found.solution.modified
    if not found.solution.usable or not (reduction.lead_in or reduction.lead_out):
        return found, modified
    led = add_leads(profile.machine, modified, reduction.lead_in, reduction.lead_out)
    if led.trouble and reduction.limits == "enforce":
        refused = replace(found.solution, status="infeasible", message=led.trouble)
        return replace(found, solution=refused), led.motion
    return found, led.motion


def _conditioned(profile: Profile, asked: DesiredMotion) -> DesiredMotion:
    """Return what the reduction begins from: the record, smoothed where the profile says so."""
    cutoff_hz = profile.smooth_cutoff_hz
    if math.isinf(cutoff_hz):
        return asked
    record = _on_rows(profile, asked)
    smooth = smooth_command(record.t, record.command, cutoff_hz)
    return find_desired(replace(record, command=smooth), divide=False)


def _on_rows(profile: Profile, asked: DesiredMotion) -> Profile:
    """Return the profile on the rows of the motion that it asks for."""
    return replace(profile, t=asked.motion.t, command=asked.rates or profile.command)


def _checks(
    profile: Profile,
    asked: DesiredMotion,
    target: DesiredMotion,
    found: Found,
    commands: Motion,
    most: tuple[Budget, ...],
    told: Metrics,
) -> tuple[Check, ...]:
    if not found.solution.usable:
        return ()
    claim = Claim(
        profile=_on_rows(profile, asked),
        requested=asked.motion,
        desired=found.desired if found.posed is None else found.posed.desired,
        seat=found.seat,
        solution=found.solution,
        posed=found.posed,
        commands=commands,
        target=target.motion,
        shortfall=asked.shortfall,
        held=found.held,
        most=most,
        told=told,
    )
    return verify(claim)
