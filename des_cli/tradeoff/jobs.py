"""The points of a trade-off curve as jobs over an Executor.

As in ``batch``: a job and its result are plain data, so that the pool of this
machine and a cluster's executor are one code path.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from des_cli.batch.source import Source, load_source_variants
from des_cli.errors import DesError, ExitCode, Failure
from des_cli.model.stage import OnStage, untold
from des_cli.model.tradeoff import TradePoint
from des_cli.profiles_in.setting import AnySetting
from des_cli.signals import raise_if_stopped

# What needs numpy is imported when a job runs, as in `batch`.
if TYPE_CHECKING:
    from des_cli.model.profile import Control, Profile
    from des_cli.model.solution import Iteration
    from des_cli.pipeline import Prepared


@dataclass(frozen=True, slots=True)
class PointPlan:
    """What one point of a curve asks for: an optimum, or the baselines.

    Parameters
    ----------
    settings : tuple of str or Setting
        Further ``--set`` strings for the profile's reduction.
    control, swept, value
        What these ask for, to name the point by; empty for the baselines.
    weights : tuple of float
        r2 of the study's law, for the baselines.
    """

    settings: tuple[AnySetting, ...]
    control: Control = "scalar"
    swept: str = ""
    value: float = 0.0
    weights: tuple[float, ...] = ()

    @property
    def baselines(self) -> bool:
        """Whether this asks for the baselines."""
        return not self.swept


@dataclass(frozen=True, slots=True)
class PointJob:
    """A point to be computed, with all that is needed for it.

    Parameters
    ----------
    label : str
        What a message about it begins with.
    plan : PointPlan
    profile : Profile
        With the reduction of the point.
    prepared : Prepared, optional
        The desired motion, one for all points; None where it cannot be made: each
        point then says why.
    """

    label: str
    plan: PointPlan
    profile: Profile
    prepared: Prepared | None


@dataclass(frozen=True, slots=True)
class PointResult:
    """What became of a job: its points, and why it failed if it did."""

    points: tuple[TradePoint, ...]
    log: tuple[Iteration, ...] = ()
    failure: Failure | None = None

    @property
    def ok(self) -> bool:
        """Whether the job did not fail."""
        return self.failure is None

    @classmethod
    def failed(cls, job: PointJob, error: Exception) -> PointResult:
        """Make the result of a job that an exception ended."""
        failure, plan = Failure.of(error), job.plan
        if plan.baselines:
            return cls((), failure=failure)
        message = "; ".join(failure.lines)
        point = TradePoint(
            "optimum", plan.control, plan.swept, plan.value, "failed", message=message
        )
        return cls((point,), failure=failure)


def load_points(source: Source, plans: Sequence[PointPlan]) -> list[Profile]:
    """Load a profile once, with the reduction of each plan, and refuse what cannot be solved.

    Parameters
    ----------
    source : Source
    plans : sequence of PointPlan
        At least one.

    Raises
    ------
    DesError
        The first kind of error that there is, with all complaints of its kind.
    """
    from des_cli.reduction.consistency import require_consistent

    profiles: list[Profile] = []
    errors: list[DesError] = []
    loaded = load_source_variants(source, [plan.settings for plan in plans])
    for plan, profile in zip(plans, loaded, strict=True):
        if isinstance(profile, DesError):
            errors.append(profile)
            continue
        profiles.append(profile)
        try:
            if not plan.baselines:
                require_consistent(profile.reduction)
        except DesError as error:
            errors.append(error)
    if errors:
        same = [p for error in errors if type(error) is type(errors[0]) for p in error.complaints]
        raise type(errors[0])(list(dict.fromkeys(same)))
    return profiles


def make_jobs(
    label: str, plans: Sequence[PointPlan], profiles: Sequence[Profile]
) -> list[PointJob]:
    """Return the jobs of a curve's points, for which the desired motion is made once.

    Parameters
    ----------
    label : str
        What messages begin with.
    plans : sequence of PointPlan
    profiles : sequence of Profile
        For each plan, the same but for its reduction.
    """
    from des_cli.pipeline import prepare_profile

    prepared: Prepared | None
    try:
        prepared = prepare_profile(profiles[0])
    except Exception:  # each point meets it again, and says so
        prepared = None
    return [
        PointJob(label, plan, profile, prepared)
        for plan, profile in zip(plans, profiles, strict=True)
    ]


def run_point(
    job: PointJob,
    on_iteration: Callable[[Iteration], None] | None = None,
    on_stage: OnStage = untold,
) -> PointResult:
    """Compute the point of a job, or the points of the baselines.

    Whatever fails becomes part of the result, so that one point does not end
    the others; only an interruption passes through.
    """
    log: list[Iteration] = []

    def note(iteration: Iteration) -> None:
        log.append(iteration)
        if on_iteration is not None:
            on_iteration(iteration)

    try:
        from des_cli.tradeoff.baselines import baseline_points
        from des_cli.tradeoff.point import trade_point

        plan, profile, prepared = job.plan, job.profile, job.prepared
        if plan.baselines:
            on_stage("baselines")
            return PointResult(tuple(baseline_points(profile, plan.weights, prepared)))
        point = trade_point(profile, prepared, note, on_stage)
        # of several budgets, only the plan knows which one is swept
        return PointResult((replace(point, swept=plan.swept, value=plan.value),), tuple(log))
    except Exception as error:
        raise_if_stopped(error)
        return PointResult.failed(job, error)


def exit_code_of(results: Sequence[PointResult]) -> ExitCode:
    """Return how a sweep ends.

    ``DONE`` where every point that was asked for has an answer, a solution or that
    there is none; ``NO_SOLUTION`` where none has a solution; otherwise ``FILE``, as
    for a batch of which part failed. A bug stays a bug.
    """
    failures = [result.failure.exit_code for result in results if result.failure]
    if ExitCode.BUG in failures:
        return ExitCode.BUG
    asked = [p for result in results for p in result.points if p.algorithm == "optimum"]
    if not any(point.solved for point in asked):
        return ExitCode.NO_SOLUTION
    done = not failures and all(point.answered for point in asked)
    return ExitCode.DONE if done else ExitCode.FILE
