"""Where a profile comes from and how it is read: data that crosses process boundaries."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from des_cli.errors import Complaint, DesError, UsageError
from des_cli.profiles_in.caps import DEFAULT_CAPS, Caps
from des_cli.profiles_in.setting import AnySetting

# What needs numpy is imported when a profile is read: a worker must be able to set its
# number of BLAS threads before that, and a rejected command line needs none.
if TYPE_CHECKING:
    from des_cli.model.profile import Profile

STANDARD_STREAM = "-"
"""Stands for stdin as a source and for stdout as an output."""


@dataclass(frozen=True, slots=True)
class Source:
    """Where one profile comes from, and how it is read.

    Parameters
    ----------
    name : str
        A path, the name of a built-in profile, or ``-``.
    settings : tuple of str or Setting
        Overrides, ``reduction.r2=0.2``.
    columns : mapping of str to str
        Names of a CSV's columns: ours to the file's.
    separator, decimal : str, optional
        How a CSV is written.
    stdin : bytes, optional
        What ``-`` stands for.
    part : int, optional
        Which stretch between the gaps of a record that is split.
    caps : Caps
        The most that is read.
    """

    name: str
    settings: tuple[AnySetting, ...] = ()
    columns: Mapping[str, str] = field(default_factory=dict)
    separator: str | None = None
    decimal: str | None = None
    stdin: bytes | None = None
    part: int | None = None
    caps: Caps = DEFAULT_CAPS


def load_source(source: Source) -> Profile:
    """Load the profile of a source with its overrides."""
    from des_cli.profiles_in.load import load_profile

    return load_profile(source.name, part=source.part, **_how(source))


def name_of_source(source: Source) -> str:
    """Return the name of a profile that is rejected; empty where it cannot be told."""
    from des_cli.profiles_in.profile_name import find_name

    return find_name(source.name, settings=source.settings, stdin=source.stdin, caps=source.caps)


def load_source_variants(
    source: Source, variants: Sequence[Sequence[AnySetting]]
) -> list[Profile | DesError]:
    """Load the profile of a source once, with several lists of further settings.

    See ``profiles_in.variants.load_variants``.
    """
    from des_cli.profiles_in.variants import load_variants

    return load_variants(source.name, variants, part=source.part, **_how(source))


def split_source(source: Source) -> list[Source]:
    """Return a source for every stretch of a record that is split at its gaps.

    A profile that cannot be loaded stays one source, which says what is wrong with it.
    """
    from des_cli.profiles_in.load import count_parts

    try:
        parts = count_parts(source.name, **_how(source))
    except (DesError, OSError):
        parts = 1
    if parts == 1:
        return [source]
    return [replace(source, part=k + 1) for k in range(parts)]


def _how(source: Source) -> dict[str, Any]:
    """Return how a source is read."""
    return {
        "settings": source.settings,
        "columns": source.columns,
        "stdin": source.stdin,
        "separator": source.separator,
        "decimal": source.decimal,
        "caps": source.caps,
    }


def require_distinct_names(sources: Iterable[Source]) -> None:
    """Refuse a batch in which two profiles would share a run folder.

    A profile that cannot be loaded has no name and is passed over here: its
    own job says what is wrong with it.

    Raises
    ------
    UsageError
        Naming the sources that share a name, one line for each name.
    """
    by_name = defaultdict(list)
    for source in sources:
        try:
            by_name[load_source(source).name].append(source.name)
        except (DesError, OSError):
            continue
    complaints = [
        Complaint(name, f"several profiles have this name: {', '.join(same)}; rename all but one")
        for name, same in by_name.items()
        if len(same) > 1
    ]
    if complaints:
        raise UsageError(complaints)
