"""A run folder: the outputs of one profile, and a manifest that vouches for them.

``manifest.json`` is written last and lists every output with its size and
SHA-256. A file without an entry there is not an output, and a folder without a
manifest is not a run.
"""

from __future__ import annotations

import os
import stat
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from pathlib import Path

from des_cli.errors import Complaint, FileAccessError
from des_cli.model.run import Run
from des_cli.runs_out import atomic
from des_cli.runs_out.exchange import exchange
from des_cli.runs_out.manifest import (
    COMMANDS,
    MANIFEST,
    METRICS,
    PROFILE,
    SOURCE,
    TRAJECTORY,
    encode_json,
    encode_manifest,
    is_run,
    read_bytes,
    read_manifest,
)
from des_cli.runs_out.plain_words import plain_words
from des_cli.runs_out.run_profile import encode_run_profile
from des_cli.runs_out.tables import (
    command_columns,
    encode_table,
    trajectory_columns,
)
from des_cli.signals import undisturbed


def write_run(
    run: Run,
    folder: str | os.PathLike[str],
    *,
    plots: bool = True,
    overwrite: bool = False,
    accept: Callable[[bytes], None] = lambda _: None,
) -> tuple[Path, ...]:
    """Write the outputs of a run into its folder.

    Everything is built aside first. A folder that does not exist yet appears
    whole, in one step, and one that holds nothing but an earlier run is exchanged in one
    step where the system can. Into another the files are moved with the
    manifest last, and files that are not the run's stay untouched.

    Parameters
    ----------
    run : Run
    folder : path
        The folder itself; its parents are made where they are missing.
    plots : bool
        Whether to draw ``plots/*.png``.
    overwrite : bool
        Whether a run that is already there may be replaced. Needed for every
        folder that is not empty.
    accept : callable
        Given the command table, as it is read back from where it was built; what it raises
        leaves the folder as it was.

    Returns
    -------
    tuple of Path
        The files, the manifest last.

    Raises
    ------
    FileAccessError
        If the folder holds something and may not be written to, or a file
        cannot be written.
    NotReleasedError
        If a value of a table is not a finite number.
    """
    _require_free(Path(folder), overwrite)
    return write_outputs(
        encode_run(run, plots=plots),
        folder,
        overwrite=overwrite,
        accept=lambda built: accept(read_bytes(built / COMMANDS)),
    )


def encode_run(run: Run, *, plots: bool = True) -> dict[str, bytes]:
    """Return the outputs of a run by their names in its folder, the manifest last."""
    outputs = _outputs(run, plots)
    outputs[MANIFEST] = encode_manifest(run, outputs)
    return outputs


def write_outputs(
    outputs: Mapping[str, bytes],
    folder: str | os.PathLike[str],
    *,
    overwrite: bool = False,
    accept: Callable[[Path], None],
) -> tuple[Path, ...]:
    """Write what `encode_run` returned, as `write_run` does.

    Parameters
    ----------
    outputs : mapping of str to bytes
    folder, overwrite
        As of `write_run`.
    accept : callable
        Given the folder in which all was built; what it raises leaves the target as it was.
    """
    target = Path(folder)
    _require_free(target, overwrite)
    if not target.is_dir():
        _appear(target, outputs, accept)
    elif not (_may_be_exchanged(target) and _exchange(target, outputs, accept)):
        _require_own_places(target, outputs)
        _fill(target, outputs, accept)
    return tuple(target / name for name in outputs)


def discard_run(folder: str | os.PathLike[str]) -> None:
    """Remove the outputs that a folder's manifest lists, the command table first.

    The manifest goes last: whatever ends this midway, no table is left, and by what is left
    the next call finishes it. Nothing else in the folder is touched. A folder without a
    run is left as it is.

    Raises
    ------
    FileAccessError
        If a file cannot be removed.
    """
    home = Path(folder)
    if not is_run(home):
        return
    names = {entry["name"] for entry in read_manifest(home)["files"]}
    with undisturbed():
        for part in (names & {COMMANDS}, names - {COMMANDS}, {MANIFEST}):
            _remove(home, sorted(part))


def require_place(target: Path) -> None:
    """Refuse the name of a run folder where something else stands, or in a parent's place.

    Raises
    ------
    FileAccessError
    """
    with plain_words(target, "cannot be written"):
        # What is there at the nearest must be a folder; the rest is made.
        path = next((each for each in (target, *target.parents) if os.path.lexists(each)), None)
        if path is None or path.is_dir():
            return
        what = "is a file" if path.is_file() else "is no folder"
        if not path.exists():
            what = "is a link that leads nowhere"
    raise FileAccessError([Complaint(str(path), f"{what}; a run needs a folder, name another")])


def is_free(target: Path) -> bool:
    """Tell whether nothing stands where a run is to be; leftovers of a killed one do not count."""
    with plain_words(target, "cannot be written"):
        if not target.exists():
            return True
        return all(atomic.is_temporary(path.name) for path in target.iterdir())


def _require_free(target: Path, overwrite: bool) -> None:
    require_place(target)
    if overwrite or is_free(target):
        return
    if (target / MANIFEST).exists():
        what = "already holds a run; --overwrite replaces it"
    else:
        what = "is not empty and holds no run; name another folder, or --overwrite to write into it"
    raise FileAccessError([Complaint(str(target), what)])


def _require_own_places(target: Path, outputs: Iterable[str]) -> None:
    """Refuse to write through a link out of the folder, or in the place of a folder."""
    folders = {(target / name).parent for name in outputs} - {target}
    complaints = [
        Complaint(
            str(folder), "is not a folder of the run's own; remove it, or name another output"
        )
        for folder in sorted(folders)
        if folder.is_symlink() or (folder.exists() and not folder.is_dir())
    ]
    complaints += [
        Complaint(str(target / name), "is a folder; remove it, or name another output")
        for name in outputs
        if (target / name).is_dir() and not (target / name).is_symlink()
    ]
    if complaints:
        raise FileAccessError(complaints)


def _outputs(run: Run, plots: bool) -> dict[str, bytes]:
    trajectory = trajectory_columns(run)
    outputs = {
        COMMANDS: encode_table(command_columns(run), "csv"),
        TRAJECTORY: encode_table(trajectory, "parquet"),
        METRICS: encode_json(run.metrics),
    }
    if run.results.parameters:
        outputs[PROFILE] = encode_run_profile(run, COMMANDS)
    if run.profile.origin:
        outputs |= {f"{SOURCE}{file.name}": file.data for file in run.profile.origin.files}
    if plots:
        # Imported here: matplotlib costs half a second that --no-plots does not need.
        from des_cli.show.plots import draw_plots

        figures = draw_plots(trajectory, run.metrics)
        outputs |= {f"plots/{name}.png": png for name, png in figures.items()}
    return outputs


def _write_all(folder: Path, outputs: Mapping[str, bytes], accept: Callable[[Path], None]) -> None:
    for name, data in outputs.items():
        path = folder / name
        with plain_words(path, "cannot be written"):
            path.parent.mkdir(exist_ok=True)
        atomic.write_through(path, data)
    for inner in {(folder / name).parent for name in outputs}:
        atomic.sync_folder(inner)
    accept(folder)


def _appear(target: Path, outputs: Mapping[str, bytes], accept: Callable[[Path], None]) -> None:
    """Build a folder beside its name, and give it the name when it is whole."""
    with plain_words(target, "cannot be written"):
        target.parent.mkdir(parents=True, exist_ok=True)
        with atomic.new_folder(target.parent, target.name) as building:
            _write_all(building, outputs, accept)
            os.rename(building, target)
        atomic.sync_folder(target.parent)


def _may_be_exchanged(target: Path) -> bool:
    """Tell whether a folder holds an earlier run and nothing else, and is no one's place."""
    if not is_run(target) or not os.access(target.resolve().parent, os.W_OK):
        return False
    # Whoever stands in it would stay in the one that is removed.
    if Path.cwd().is_relative_to(target.resolve()):
        return False
    own = {MANIFEST, *(entry["name"] for entry in read_manifest(target)["files"])}
    folders = {str(Path(name).parent) for name in own}
    for path in target.rglob("*"):
        name = str(path.relative_to(target))
        if atomic.is_temporary(name.split(os.sep)[0]):
            continue
        if path.is_symlink() or name not in (folders if path.is_dir() else own):
            return False
    return True


def _exchange(target: Path, outputs: Mapping[str, bytes], accept: Callable[[Path], None]) -> bool:
    """Build a folder beside, and give each the name of the other; tell whether that went."""
    home = target.resolve()
    with (
        plain_words(target, "cannot be written"),
        atomic.new_folder(home.parent, home.name) as building,
    ):
        before, after = home.stat(), building.stat()
        if (before.st_uid, before.st_gid) != (after.st_uid, after.st_gid):
            return False
        _write_all(building, outputs, accept)
        building.chmod(stat.S_IMODE(before.st_mode))
        if not exchange(building, home):
            return False
        atomic.sync_folder(home.parent)
    return True


def _fill(target: Path, outputs: Mapping[str, bytes], accept: Callable[[Path], None]) -> None:
    """Build inside an existing folder, then move every file to its place, the manifest last.

    The run that was there loses its manifest before its first file is
    replaced, so that a mixture is never a run; it is put back if that fails.
    """
    with (
        plain_words(target, "cannot be written"),
        atomic.new_folder(target, MANIFEST) as building,
    ):
        _write_all(building, outputs, accept)
        aside = building / "earlier"
        earlier = [MANIFEST]  # one that is none of ours, or that is broken, also goes first
        if is_run(target):
            earlier += [entry["name"] for entry in read_manifest(target)["files"]]
        earlier += [name for name in outputs if name not in earlier]
        try:
            with undisturbed():
                _move(target, aside, _inside(target, earlier))
                *files, manifest = outputs
                _move(building, target, files)
                for inner in {(target / name).parent for name in files}:
                    atomic.sync_folder(inner)
                _move(building, target, [manifest])
        except BaseException:
            _remove(target, [name for name in outputs if not (building / name).exists()])
            _move(aside, target, reversed(earlier))
            raise
        _remove_empty(target, earlier)
        atomic.sync_folder(target)


def _move(source: Path, to: Path, names: Iterable[str]) -> None:
    """Move those of the named files that exist."""
    for name in names:
        if os.path.lexists(source / name):
            (to / name).parent.mkdir(parents=True, exist_ok=True)
            os.replace(source / name, to / name)


def _inside(home: Path, names: Iterable[str]) -> list[str]:
    # A linked folder may lead out of this one; what is there is not the run's.
    real = home.resolve()
    return [name for name in names if (home / name).parent.resolve().is_relative_to(real)]


def _remove_empty(home: Path, names: Iterable[str]) -> None:
    """Remove the folders of files that are gone, where nothing else is in them."""
    for folder in {(home / name).parent for name in names} - {home}:
        with suppress(OSError):
            folder.rmdir()


def _remove(home: Path, names: Iterable[str]) -> None:
    inside = _inside(home, names)
    for name in inside:
        path = home / name
        with plain_words(path, "cannot be removed"):
            path.unlink(missing_ok=True)
    _remove_empty(home, inside)
    atomic.sync_folder(home)
