"""What a shell may complete: names that the tool knows, runs and files.

It is asked at every press of a key, so nothing is imported here that imports numpy.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import click

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

Items: TypeAlias = "list[CompletionItem[str]]"
Complete: TypeAlias = Callable[[click.Context, click.Parameter, str], Items]

MANIFEST = "manifest.json"
"""What a folder holds that is a run; whether it is whole, the command says."""

_PROFILES, _MACHINES = (".yaml", ".yml", ".csv"), (".yaml", ".yml")
_TABLES = (".csv", ".ndjson", ".json", ".parquet")

_OTHER_KEYS = ("time.start_s", "time.stop_s", "time.step_s", "seat.yaw_deg", "seat.pitch_deg")
"""Of a profile beside ``reduction:``, those that are often set."""


def complete_files(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
    """Leave it to the shell to complete a file."""
    return [_item(incomplete, kind="file")]


def complete_folders(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
    """Leave it to the shell to complete a folder."""
    return [_item(incomplete, kind="dir")]


def complete_profiles(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
    """Complete a built-in profile, or a file."""
    from des_cli.profiles_in.builtin import builtin_profiles

    known = {profile.name: profile.summary for profile in builtin_profiles()}
    return _known_or_file(known, _PROFILES, incomplete)


def complete_builtin(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
    """Complete a built-in profile."""
    from des_cli.profiles_in.builtin import builtin_profiles

    return _matching({each.name: each.summary for each in builtin_profiles()}, incomplete)


def complete_machines(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
    """Complete a built-in machine, or a file."""
    from des_cli.model.machines import MACHINES

    return _known_or_file(dict.fromkeys(MACHINES, ""), _MACHINES, incomplete)


def complete_runs(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
    """Complete a run folder, of those under ``runs/`` without being named, or anything else."""
    from des_cli.cli.options import DEFAULT_RUNS

    typed = os.path.dirname(incomplete)
    found = dict.fromkeys(
        f"{folder}/{name}" if folder else name
        for folder in dict.fromkeys((typed, DEFAULT_RUNS))
        for name in _names(folder)
        if (Path(folder) / name / MANIFEST).is_file()
    )
    return _matching(dict.fromkeys(found, ""), incomplete) or [_item(incomplete, kind="file")]


def complete_targets(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
    """Complete a run folder, a table of the current folder, or any file."""
    runs = [item for item in complete_runs(context, parameter, incomplete) if item.type == "plain"]
    tables = {name: "" for name in _names("") if name.endswith(_TABLES)}
    return [*runs, *_matching(tables, incomplete)] or [_item(incomplete, kind="file")]


def complete_budget(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
    """Complete the metric of a budget: ``seat_g_rms_error_g=``."""
    return [] if "=" in incomplete else _matching(_metrics(), incomplete)


def complete_setting(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
    """Complete a key of ``--set``, or its value where that is a word."""
    from des_cli.cli.options import reduction_words

    keys = {f"reduction.{key}": words for key, words in reduction_words().items()}
    keys |= dict.fromkeys(_OTHER_KEYS, ())
    return _complete_key(keys, "reduction.budget.", incomplete, several=False)


def complete_grid(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
    """Complete a key of ``--grid``, or its values, one after the other."""
    from des_cli.cli.options import reduction_words

    keys = reduction_words() | dict.fromkeys(_OTHER_KEYS, ())
    return _complete_key(keys, "budget.", incomplete, several=True)


def complete_where(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
    """Complete the column that a condition begins with."""
    from des_cli.model.coriolis import COMPONENTS
    from des_cli.model.metric import METRICS

    metrics: dict[str, str] = {metric.key: metric.label for metric in METRICS.values()}
    parts = {f"{part.key}.reduction": part.label for part in COMPONENTS}
    return _matching({**metrics, **parts, "status": "", "machine": ""}, incomplete)


def complete_columns(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
    """Complete the last column of a list."""
    from des_cli.model.machine import JOINTS
    from des_cli.runs_out.forms import QUANTITIES, TIMES
    from des_cli.units import suffixes

    times = [f"{stem}_{unit}" for stem in TIMES for unit in suffixes("time")]
    joints = [
        f"{joint}_{unit}" for joint in JOINTS for kind in QUANTITIES for unit in suffixes(kind)
    ]
    return _next_of_list([*times, *joints], "", incomplete)


def complete_words(words: Mapping[str, str]) -> Complete:
    """Return what completes one of these words, each with what it is."""

    def complete(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
        return _matching(words, incomplete)

    return complete


def complete_list(words: Iterable[str]) -> Complete:
    """Return what completes the last of several of these words, with commas between."""

    def complete(context: click.Context, parameter: click.Parameter, incomplete: str) -> Items:
        return _next_of_list(words, "", incomplete)

    return complete


def _complete_key(
    keys: Mapping[str, tuple[str, ...]], budgets: str, incomplete: str, *, several: bool
) -> Items:
    key, equals, values = incomplete.partition("=")
    if not equals:
        named = {f"{name}=": "" for name in keys}
        named |= {f"{budgets}{name}": text for name, text in _metrics().items()}
        return _matching(named, incomplete)
    words = keys.get(key, ())
    if several:
        return _next_of_list(words, f"{key}=", values)
    return _matching({f"{key}={word}": "" for word in words}, incomplete)


def _next_of_list(words: Iterable[str], before: str, values: str) -> Items:
    done, comma, _ = values.rpartition(",")
    left = [word for word in words if word not in done.split(",")]
    named = {f"{before}{done}{comma}{word}": "" for word in left}
    return _matching(named, f"{before}{values}")


def _metrics() -> dict[str, str]:
    from des_cli.model.metric import METRICS

    return {
        f"{metric.key}=": f"{metric.label} [{metric.unit or '%'}]" for metric in METRICS.values()
    }


def _known_or_file(known: Mapping[str, str], suffixes: tuple[str, ...], incomplete: str) -> Items:
    """Complete names and such files of the current folder; a shell completes what is no such."""
    here = {name: "" for name in _names("") if name.endswith(suffixes)}
    return _matching({**here, **known}, incomplete) or [_item(incomplete, kind="file")]


def _matching(words: Mapping[str, str], incomplete: str) -> Items:
    return [_item(word, text) for word, text in words.items() if word.startswith(incomplete)]


def _item(value: str, text: str = "", kind: str = "plain") -> CompletionItem[str]:
    from click.shell_completion import CompletionItem

    return CompletionItem(value, type=kind, help=text or None)


def _names(folder: str) -> list[str]:
    """Return what a folder holds, in order; nothing where it cannot be read."""
    try:
        return sorted(name for name in os.listdir(folder or ".") if not name.startswith("."))
    except OSError:
        return []
