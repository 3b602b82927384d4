"""Tasks over an Executor, or one after the other in this process.

A task is plain data that can cross a process boundary, and so is its result: a
pool of this machine's processes and threads that wait for a cluster (``cluster``) are
one code path.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from itertools import islice
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias, TypeVar

from des_cli.errors import Complaint, FileAccessError
from des_cli.model.stage import OnStage, untold
from des_cli.signals import raise_if_stopped

if TYPE_CHECKING:
    from des_cli.model.solution import Iteration

    OnIteration: TypeAlias = Callable[[Iteration], None]


AHEAD = 1024
"""Tasks that an executor is given before the first of them is told: the most results that wait."""

LOST = "its worker process died, perhaps for want of memory; try fewer --jobs"
"""What is said of a task whose worker is gone."""


class Task(Protocol):
    """What there is to do."""

    @property
    def label(self) -> str:
        """What a message about it begins with."""


class Result(Protocol):
    """What became of a task."""

    @property
    def ok(self) -> bool:
        """Whether it did not fail."""


AnyTask = TypeVar("AnyTask", bound=Task)
AnyResult = TypeVar("AnyResult", bound=Result)
_Task = TypeVar("_Task", contravariant=True)
_Result = TypeVar("_Result", covariant=True)


class Work(Protocol[_Task, _Result]):
    """A function of a module, which does one task: a worker finds it by its name.

    Whatever fails becomes part of its result. The callbacks are for a task that is done
    in this process: a worker has none.
    """

    def __call__(
        self, task: _Task, on_iteration: OnIteration | None = ..., on_stage: OnStage = ..., /
    ) -> _Result:
        """Do a task."""


def run_tasks(
    tasks: Sequence[AnyTask],
    work: Work[AnyTask, AnyResult],
    failed: Callable[[AnyTask, Exception], AnyResult],
    executor: Executor | None = None,
    *,
    keep_going: bool = False,
    on_iteration: OnIteration | None = None,
    on_stage: OnStage = untold,
    on_finished: Callable[[], None] = lambda: None,
) -> Iterator[AnyResult]:
    """Yield the result of every task, in the order of the tasks.

    Parameters
    ----------
    tasks : sequence
    work : callable
        What is done with each.
    failed : callable
        Makes the result of a task whose worker was lost.
    executor : Executor, optional
        Runs them; without one they run here, one after the other.
    keep_going : bool
        Whether to go on after a failed task; without it no task is begun that
        has not begun, and none of those has a result.
    on_iteration, on_stage : callable, optional
        For tasks that run here.
    on_finished : callable, optional
        Called whenever a task has ended, in any order and from any thread.
    """
    if executor is None:
        for task in tasks:
            result = work(task, on_iteration, on_stage)
            on_finished()
            yield result
            if not (result.ok or keep_going):
                return
        return

    def note(future: Future[AnyResult]) -> None:
        if not future.cancelled():
            on_finished()

    waiting = iter(tasks)
    begun: deque[tuple[AnyTask, Future[AnyResult]]] = deque()

    def begin(count: int) -> None:
        for task in islice(waiting, count):
            future = _submitted(executor, work, task)
            begun.append((task, future))
            future.add_done_callback(note)

    try:
        begin(AHEAD)
        while begun:
            task, future = begun.popleft()
            # What had begun when another task failed is finished and told.
            if future.cancelled():
                continue
            result = _result_of(task, future, failed)
            del future  # and its result, of which a long batch has many
            if result.ok or keep_going:
                begin(1)
            else:
                waiting = iter(())
                _cancel(each for _, each in begun)
            yield result
    finally:
        _cancel(each for _, each in begun)


def _submitted(
    executor: Executor, work: Work[AnyTask, AnyResult], task: AnyTask
) -> Future[AnyResult]:
    """Have a task done; by an executor that is broken it has failed already."""
    try:
        return executor.submit(work, task)
    except BrokenExecutor as error:
        lost: Future[AnyResult] = Future()
        lost.set_exception(error)
        return lost


def _cancel(futures: Iterable[Future[Any]]) -> None:
    """Cancel every task that has not begun."""
    for future in futures:
        future.cancel()


def _result_of(
    task: AnyTask, future: Future[AnyResult], failed: Callable[[AnyTask, Exception], AnyResult]
) -> AnyResult:
    try:
        return future.result()
    except BrokenExecutor:
        return failed(task, FileAccessError([Complaint(task.label, LOST)]))
    except Exception as error:  # of the executor; the work itself raises none
        raise_if_stopped(error)
        return failed(task, error)
