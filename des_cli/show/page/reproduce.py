"""What a run was made of, so that it can be made again: command, profile, machine, versions."""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from des_cli.model.metrics import Metrics
from des_cli.runs_out.stored_run import StoredRun
from des_cli.show.page.machine_view import MachineView
from des_cli.show.words import PAGE, text_of

MOST_TEXT = 20_000
"""Characters of a source that are shown; a long table is in the run folder whole."""


@dataclass(frozen=True, slots=True)
class SourceText:
    """One file that the profile was read from, as far as the page shows it."""

    name: str
    text: str
    cut: bool


@dataclass(frozen=True, slots=True)
class Reproduction:
    """How a run is made again.

    Parameters
    ----------
    command : str
        For a shell in the run folder; empty where an earlier version did not keep it.
    sources : list of SourceText
    facts : list of (str, str)
        Machine, seat, versions, kernel.
    digests : list of (str, str)
        SHA-256 of the profile as it was read, and of every file.
    """

    command: str
    sources: list[SourceText]
    facts: list[tuple[str, str]]
    digests: list[tuple[str, str]]


def reproduction_of(run: StoredRun, metrics: Metrics, view: MachineView | None) -> Reproduction:
    """Return what the page says on making a run again."""
    made = _mapping(run.manifest.get("made"))
    words = made.get("command")
    listed = words if isinstance(words, list) else []
    return Reproduction(
        shlex.join(str(word) for word in listed),
        [_source_text(name, data) for name, data in run.sources.items()],
        list(_facts(run, metrics, view)),
        list(_digests(run, metrics)),
    )


def seat_words(view: MachineView | None) -> str:
    """Say how the seat is fixed; empty if that is not known."""
    if view is None:
        return ""
    yaw, pitch = (PAGE.number(math.degrees(each), 4) for each in (view.after.yaw, view.after.pitch))
    return f"yaw {yaw}°, pitch {pitch}°"


def _facts(run: StoredRun, metrics: Metrics, view: MachineView | None) -> Iterator[tuple[str, str]]:
    tool = _mapping(run.manifest.get("tool"))
    machine = _mapping(run.manifest.get("machine"))
    yield "made by", f"{text_of(tool.get('name'))} {text_of(tool.get('version'))}"
    kernels = tool.get("blas")
    if isinstance(kernels, list) and kernels:
        yield "linear algebra", ", ".join(map(str, kernels))
    yield "machine", text_of(metrics.profile.machine)
    if machine.get("source"):
        yield "from", text_of(machine["source"])
    if view is not None:
        yield "seat", seat_words(view)
        lengths = [
            f"{name} {PAGE.number(length, 5)} m" for name, length in view.machine.lengths.items()
        ]
        if lengths:
            yield "lengths", ", ".join(lengths)


def _digests(run: StoredRun, metrics: Metrics) -> Iterator[tuple[str, str]]:
    yield "profile, as read", text_of(metrics.profile.sha256)
    files = run.manifest.get("files")
    for entry in files if isinstance(files, list) else []:
        if isinstance(entry, dict):
            yield text_of(entry.get("name")), text_of(entry.get("sha256"))


def _source_text(name: str, data: bytes) -> SourceText:
    text = data.decode("utf-8", "replace")
    return SourceText(name, text[:MOST_TEXT], len(text) > MOST_TEXT)


def _mapping(value: object) -> Mapping[str, Any]:
    return value if isinstance(value, dict) else {}
