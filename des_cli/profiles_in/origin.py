"""From what was read of a profile to what makes it again.

No path goes into it: the files are to stand side by side in a folder of their own, and
where the profile names one of them otherwise, an option names it anew.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from des_cli.model.origin import Origin, SourceFile
from des_cli.profiles_in.caps import DEFAULT_CAPS, Caps
from des_cli.profiles_in.profile_name import name_of_file
from des_cli.profiles_in.referred import Referred
from des_cli.profiles_in.setting import AnySetting, Setting

FOLDER = "source"
"""Where the files are to stand, as seen from where the command is given."""


def origin_of(
    profile: SourceFile,
    referred: Sequence[Referred],
    settings: Sequence[AnySetting],
    columns: Mapping[str, str],
    written: Mapping[str, str],
    caps: Caps = DEFAULT_CAPS,
) -> Origin:
    """Return what makes a profile again.

    Parameters
    ----------
    profile : SourceFile
    referred : sequence of Referred
    settings, columns, caps
        As of ``load.load_profile``.
    written : mapping of str to str
        ``separator`` and ``decimal``, as far as they were given.
    """
    files, named = [profile], {}
    for each in referred:
        name = _file_name(each.name, {file.name for file in files})
        files.append(SourceFile(name, each.data))
        if each.by_option or each.name != name:
            named[each.key] = f"{FOLDER}/{name}"
    kept = [setting for setting in settings if _key(setting) not in named]
    # Where a file is named stands first: a setting may change what is in it.
    anew = [Setting(key, path, "") for key, path in named.items()]
    options = [("--set", str(setting)) for setting in (*anew, *kept)]
    options += [("--column", f"{ours}={theirs}") for ours, theirs in columns.items()]
    options += [(f"--{key}", value) for key, value in written.items()]
    for option, value, usual in (
        ("--max-rows", caps.rows, DEFAULT_CAPS.rows),
        ("--max-mib", caps.mib, DEFAULT_CAPS.mib),
    ):
        if value != usual:
            options.append((option, str(value)))
    return Origin(tuple(files), tuple(word for option in options for word in option))


def source_name(path: Path | None, is_yaml: bool) -> str:
    """Return what a profile's file is called beside its run: it makes the same name."""
    return f"{name_of_file(path)}{'.yaml' if is_yaml else '.csv'}"


def _file_name(path: str, taken: set[str]) -> str:
    """Return a plain name for a file, another than those that are taken."""
    given = Path(path.replace("\\", "/"))
    suffix = given.suffix if given.suffix.isascii() and given.suffix[1:].isalnum() else ""
    name = f"{name_of_file(given)}{suffix}"
    return name if name not in taken else f"of-{name}"


def _key(setting: AnySetting) -> str:
    return setting.path if isinstance(setting, Setting) else setting.partition("=")[0].strip()
