"""Every combination of values that a profile is to be reduced with, a job for each."""

from __future__ import annotations

import hashlib
import json
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

from des_cli.batch.job import Job
from des_cli.batch.source import name_of_source
from des_cli.profiles_in.setting import Setting

NAME = "name"
"""The key by which the runs of a grid are told apart; a grid cannot vary it."""

_MOST_CHARACTERS, _MOST_BYTES = 100, 200
"""Of a profile's name, as the schema has it."""

_DIGEST = 8
"""Hexadecimal digits that tell names apart which would be cut or the same."""


@dataclass(frozen=True, slots=True)
class Axis:
    """A key and the values that it takes.

    Parameters
    ----------
    path : str
        Of the key, as ``--set`` has it: ``reduction.r2``.
    values : tuple
        Plain values, each once.
    """

    path: str
    values: tuple[Any, ...]

    def settings(self) -> tuple[Setting, ...]:
        """Return a setting for each value."""
        return tuple(
            Setting(self.path, value, f"--grid {self.path}={spelled(value)}")
            for value in self.values
        )


def grid_jobs(jobs: Sequence[Job], axes: Sequence[Axis]) -> list[Job]:
    """Make a job of every combination of values, for each of the jobs in turn.

    The last axis varies fastest. A job's profile is named after its own name and the
    values; where its own name cannot be told, the job says what is wrong with the profile.

    Parameters
    ----------
    jobs : sequence of Job
    axes : sequence of Axis
        Of different keys; none leaves the jobs as they are.
    """
    if not axes:
        return list(jobs)
    points = [_in_order(point) for point in product(*(axis.settings() for axis in axes))]
    labels, exact = _labels(axes), [" ".join(map(str, point)) for point in points]
    found = []
    for job in jobs:
        own = name_of_source(job.source)
        names = point_names(own, labels, exact) if own else [""] * len(points)
        for name, point in zip(names, points, strict=True):
            named = (Setting(NAME, name, "--grid"),) if name else ()
            source = replace(job.source, settings=(*job.source.settings, *point, *named))
            output = replace(job.output, out_is_parent=True)
            found.append(replace(job, source=source, output=output))
    return found


def point_names(own: str, labels: Sequence[str], exact: Sequence[str]) -> list[str]:
    """Return the names of a profile's runs, which are all different.

    Parameters
    ----------
    own : str
        Name of the profile.
    labels : sequence of str
        What tells the points apart, in characters that a name may have.
    exact : sequence of str
        The same in full. It makes the end of a name that would be too long, or another's.

    >>> point_names("cobra", ["r2_1", "r2_0.5"], ["r2=1", "r2=0.5"])
    ['cobra__r2_1', 'cobra__r2_0.5']
    >>> point_names("cobra", ["machine_a_b", "machine_a_b"], ["machine=a/b", "machine=a b"])
    ['cobra__machine_a_b-c414a32c', 'cobra__machine_a_b-9cd62323']
    """
    full = [f"{own}__{label}" for label in labels]
    often = Counter(full)
    return [
        _with_digest(name, point) if often[name] > 1 or _is_long(name) else name
        for name, point in zip(full, exact, strict=True)
    ]


def spelled(value: Any) -> str:
    """Return a value in characters that the name of a folder may have.

    >>> [spelled(each) for each in (0.05, [0, 2, 0], "match-both", "a/b.yaml", True)]
    ['0.05', '0,2,0', 'match-both', 'a_b.yaml', 'true']
    """
    if isinstance(value, list | tuple):
        return ",".join(map(spelled, value))
    text = value if isinstance(value, str) else json.dumps(value)
    return re.sub(r"[^\w.+-]", "_", text).strip(".-") or "_"


def _labels(axes: Sequence[Axis]) -> list[str]:
    """Return what tells the points apart: the last part of each key, and its value."""
    short = [axis.path.rpartition(".")[2] for axis in axes]
    keys = short if len(set(short)) == len(short) else [axis.path for axis in axes]
    parts = [
        [f"{spelled(key)}_{spelled(value)}" for value in axis.values]
        for key, axis in zip(keys, axes, strict=True)
    ]
    return ["__".join(point) for point in product(*parts)]


def _in_order(point: Sequence[Setting]) -> tuple[Setting, ...]:
    """Put what chooses a section before what changes a key in it."""
    return tuple(sorted(point, key=lambda setting: setting.path.count(".")))


def _is_long(name: str) -> bool:
    return len(name) > _MOST_CHARACTERS or len(name.encode()) > _MOST_BYTES


def _with_digest(name: str, of: str) -> str:
    digest = hashlib.sha256(f"{name} {of}".encode()).hexdigest()[:_DIGEST]
    while _is_long(f"{name}-{digest}"):
        name = name[:-1]
    return f"{name}-{digest}"
