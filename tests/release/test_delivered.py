"""A run that another machine computed is measured anew where it is written."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from des_cli.errors import NotReleasedError
from des_cli.model.notice import Notice
from des_cli.model.run import Run
from des_cli.pipeline import reduce_profile
from des_cli.profiles_in.load import load_profile
from des_cli.release.delivered import require_delivered
from des_cli.runs_out.run_folder import write_run
from tests.support.run_files import replace_file, rewrite


def reduced(*settings: str) -> Run:
    return reduce_profile(load_profile("cobra_felt", settings=["time.step_s=0.05", *settings]))


@pytest.fixture(scope="module")
def run() -> Run:
    return reduced()


@pytest.fixture(scope="module")
def written(run: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("delivered") / "cobra"
    write_run(run, folder, plots=False)
    return folder


@pytest.fixture
def folder(written: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(written, tmp_path / "cobra"))


def test_the_run_that_was_asked_for_passes(folder: Path, run: Run) -> None:
    require_delivered(folder, run.profile, run.notices)


def test_a_changed_file_is_refused(folder: Path, run: Run) -> None:
    table = folder / "commands.csv"
    table.write_bytes(table.read_bytes().replace(b"1", b"2", 1))
    with pytest.raises(NotReleasedError, match="a worker sent is wrong: is not the file"):
        require_delivered(folder, run.profile)


def test_a_table_of_another_motion_is_refused_whatever_its_manifest_says(
    folder: Path, run: Run
) -> None:
    lines = (folder / "commands.csv").read_text().splitlines()
    t, arm, *rest = lines[50].split(",")
    lines[50] = ",".join([t, repr(float(arm) + 0.01), *rest])
    replace_file(folder, "commands.csv", ("\n".join(lines) + "\n").encode())
    with pytest.raises(NotReleasedError, match="a worker sent is wrong"):
        require_delivered(folder, run.profile)


def test_another_profile_or_machine_is_refused(folder: Path, run: Run) -> None:
    with pytest.raises(NotReleasedError, match="of another profile"):
        require_delivered(folder, replace(run.profile, sha256="0" * 64))
    arm, fork, cab = run.profile.machine.limits
    weak = replace(run.profile.machine, limits=(arm, replace(fork, rate=9.0), cab))
    with pytest.raises(NotReleasedError, match="of another machine"):
        require_delivered(folder, replace(run.profile, machine=weak))
    rewrite(folder, machine={"name": "des"})
    with pytest.raises(NotReleasedError, match="a worker sent is wrong"):
        require_delivered(folder, run.profile)


def test_a_notice_with_which_it_is_not_to_be_released(folder: Path, run: Run) -> None:
    harm = Notice("turning", "it got worse")
    require_delivered(folder, run.profile, [harm])
    with pytest.raises(NotReleasedError, match="not released for its notice turning"):
        require_delivered(folder, run.profile, [harm], {"turning"})


def test_limits_hold_only_a_profile_that_keeps_them(tmp_path: Path) -> None:
    """The Cobra of the study is beyond the jerk limits, and its profile only wants to be told."""
    run = reduce_profile(load_profile("cobra", settings=["time.step_s=0.1"]))
    write_run(run, tmp_path / "cobra", plots=False)
    require_delivered(tmp_path / "cobra", run.profile)
    strict = replace(run.profile, reduction=replace(run.profile.reduction, limits="enforce"))
    with pytest.raises(NotReleasedError, match="a worker sent is wrong: relative excess"):
        require_delivered(tmp_path / "cobra", strict)
