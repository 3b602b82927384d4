"""One profile that is to be reduced in several ways: its file is read once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from des_cli.errors import DesError, ProfileError
from des_cli.model.profile import Profile, Reduction
from des_cli.profiles_in.caps import DEFAULT_CAPS, Caps
from des_cli.profiles_in.findings import bounded
from des_cli.profiles_in.gaps import GapHandling
from des_cli.profiles_in.load import parse_file
from des_cli.profiles_in.profile_file import ProfileFile
from des_cli.profiles_in.profile_yaml import parse_document, parse_settings
from des_cli.profiles_in.reduction_section import read_reduction
from des_cli.profiles_in.schema import ProfileSettings
from des_cli.profiles_in.setting import AnySetting
from des_cli.profiles_in.source import decode


def load_variants(
    source: str | Path,
    variants: Sequence[Sequence[AnySetting]],
    *,
    settings: Sequence[AnySetting] = (),
    columns: Mapping[str, str] | None = None,
    stdin: bytes | None = None,
    part: int | None = None,
    separator: str | None = None,
    decimal: str | None = None,
    caps: Caps = DEFAULT_CAPS,
) -> list[Profile | DesError]:
    """Read a profile with further settings of its reduction, several times over.

    Parameters
    ----------
    source, settings, columns, stdin, part, separator, decimal, caps
        As of `load_profile`.
    variants : sequence of sequence of str or Setting
        At least one; settings of keys of ``reduction``, and of no others.

    Returns
    -------
    list of Profile or DesError
        For each variant what `load_profile` returns or raises with its settings after the
        common ones. The profiles share all but their reductions; only the first has a
        digest, as the others are not read by themselves.

    Raises
    ------
    FileAccessError
        If the file cannot be read.
    """
    file = ProfileFile.read(source, stdin, caps)
    gaps = GapHandling(part=part)
    first, *others = ([*settings, *further] for further in variants)
    try:
        profile = parse_file(file, first, dict(columns or {}), gaps, separator, decimal)
    except DesError as error:
        # What is wrong beside the reduction is wrong with all.
        return [error, *(_fault(file, each) or error for each in others)]
    found: list[Profile | DesError] = [profile]
    for each in others:
        try:
            found.append(
                replace(profile, reduction=_parse_reduction(file, each), sha256="", origin=None)
            )
        except DesError as error:
            found.append(error)
    return found


def _fault(file: ProfileFile, settings: Sequence[AnySetting]) -> DesError | None:
    """Return what is wrong with a reduction."""
    try:
        _parse_reduction(file, settings)
    except DesError as error:
        return error
    return None


def _parse_reduction(file: ProfileFile, settings: Sequence[AnySetting]) -> Reduction:
    """Return how a profile is to be reduced, of which nothing else is made."""
    document: ProfileSettings
    try:
        if file.is_yaml:
            text = decode(file.data, file.label)
            document, findings = parse_document(text, file.label, settings)
        else:
            document, findings = parse_settings(settings, file.label)
        reduction = read_reduction(document.reduction, findings)
        findings.raise_if_any()
    except ProfileError as error:
        raise ProfileError(bounded(error.complaints)) from None
    return reduction
