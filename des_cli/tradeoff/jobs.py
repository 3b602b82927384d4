"""The points of a trade-off curve as jobs over an Executor.

As in ``batch``: a job and its result are plain data, so that the pool of this
machine and a cluster's executor are one code path.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from des_cli.batch.source import Source, load_source
from des_cli.errors import DesError, ExitCode, Failure
from des_cli.model.stage import OnStage, untold
from des_cli.model.tradeoff import TradePoint

# What needs numpy is imported when a job runs, as in `batch`.
if TYPE_CHECKING:
    from des_cli.model.profile import Control, Profile
    from des_cli.model.solution import Iteration


@dataclass(frozen=True, slots=True)
class PointJob:
    """One optimum, or the baselines.

    Parameters
    ----------
    source : Source
        The profile with its settings.
    control, swept, value
        What the settings ask for, to name the point by; empty for the baselines.
    weights : tuple of float
        r2 of the study's law, for the baselines.
    """

    source: Source
    control: Control = "scalar"
    swept: str = ""
    value: float = 0.0
    weights: tuple[float, ...] = ()

    @property
    def label(self) -> str:
        """What a message about it begins with."""
        return self.source.name

    @property
    def baselines(self) -> bool:
        """Whether this is the job of the baselines."""
        return not self.swept


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
        failure = Failure.of(error)
        if job.baselines:
            return cls((), failure=failure)
        message = "; ".join(failure.lines)
        point = TradePoint("optimum", job.control, job.swept, job.value, "failed", message=message)
        return cls((point,), failure=failure)


def check_points(jobs: Sequence[PointJob]) -> Profile:
    """Load each job's profile and refuse what the solver would refuse.

    Returns
    -------
    Profile
        Of the last job.

    Raises
    ------
    DesError
        The first kind of error that there is, with all complaints of its kind.
    """
    from des_cli.reduction.consistency import require_consistent

    profile: Profile | None = None
    errors: list[DesError] = []
    for each in jobs:
        try:
            profile = load_source(each.source)
            if not each.baselines:
                require_consistent(profile.reduction)
        except DesError as error:
            errors.append(error)
    if errors:
        same = [p for error in errors if type(error) is type(errors[0]) for p in error.complaints]
        raise type(errors[0])(list(dict.fromkeys(same)))
    assert profile is not None, "there is a job"
    return profile


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

        profile = load_source(job.source)
        if job.baselines:
            on_stage("baselines")
            return PointResult(tuple(baseline_points(profile, job.weights)))
        point = trade_point(profile, note, on_stage)
        # of several budgets, only the job knows which one is swept
        return PointResult((replace(point, swept=job.swept, value=job.value),), tuple(log))
    except Exception as error:
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
