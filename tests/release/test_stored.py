"""A stored run or table is measured anew: what was changed, and what is not to be played."""

from __future__ import annotations

import json
import os
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from des_cli.errors import BrokenRunError, ExitCode, UnreadableError
from des_cli.model.machine import Machine, Seat
from des_cli.model.machines import DES
from des_cli.model.run import Run
from des_cli.pipeline import reduce_profile
from des_cli.profiles_in.load import load_profile
from des_cli.release.stored import Verdict, check_stored_run, check_stored_table
from des_cli.runs_out.manifest import UNSEALED_FORMAT
from des_cli.runs_out.run_folder import write_run
from des_cli.runs_out.tables import command_columns, encode_table
from tests.support.run_files import replace_file, rewrite

FLIPS = int(os.environ.get("DES_CORIOLIS_FLIPS", "100"))
"""How many changed bytes are tried; docs/credibility.md tells of ten thousand."""


@pytest.fixture(scope="module")
def run() -> Run:
    settings = ["time.step_s=0.05", "reduction.lead_in_s=4", "reduction.lead_out_s=4"]
    return reduce_profile(load_profile("cobra_felt", settings=settings))


@pytest.fixture(scope="module")
def written(run: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("stored") / "cobra"
    write_run(run, folder, plots=False)
    return folder


@pytest.fixture
def folder(written: Path, tmp_path: Path) -> Path:
    """A copy that a test may change."""
    return Path(shutil.copytree(written, tmp_path / "cobra"))


def failed(verdict: Verdict) -> set[str]:
    return {check.key for check in verdict.failed}


def tight(**limits: float) -> Machine:
    """The DES with tighter limits of the fork."""
    arm, fork, cab = DES.limits
    return replace(DES, limits=(arm, replace(fork, **limits), cab))


def test_a_run_as_it_was_written_passes(folder: Path, run: Run) -> None:
    verdict = check_stored_run(str(folder))
    assert verdict.name == "cobra_felt"
    assert verdict.failed == ()
    assert verdict.notices == ()
    assert verdict.machine == run.profile.machine
    keys = {check.key for check in verdict.checks}
    assert {"table.fork", "limits.arm.jerk", "stopping.cab.end", "ride.turning_peak"} <= keys


def test_every_changed_byte_of_every_file_is_found(folder: Path) -> None:
    rng = np.random.default_rng(7)
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    sizes = np.array([path.stat().st_size for path in files], dtype=float)
    for number in range(FLIPS):
        # Every file as often as another, not by its size.
        path = files[number % len(files)]
        whole = path.read_bytes()
        changed = bytearray(whole)
        changed[int(rng.integers(sizes[number % len(files)]))] ^= int(rng.integers(1, 256))
        path.write_bytes(bytes(changed))
        with pytest.raises(BrokenRunError) as caught:
            check_stored_run(str(folder))
        assert path.name in str(caught.value)
        path.write_bytes(whole)
    assert check_stored_run(str(folder)).failed == ()


@pytest.mark.parametrize("name", ["commands.csv", "trajectory.parquet", "metrics.json"])
def test_a_lost_file_is_found(folder: Path, name: str) -> None:
    (folder / name).unlink()
    with pytest.raises(BrokenRunError, match=name):
        check_stored_run(str(folder))


def test_a_run_without_its_manifest_is_none(folder: Path) -> None:
    (folder / "manifest.json").unlink()
    with pytest.raises(BrokenRunError, match="has no manifest") as caught:
        check_stored_run(str(folder))
    assert caught.value.exit_code == ExitCode.PROFILE


@pytest.mark.parametrize("name", ["manifest.json", "commands.csv", "metrics.json"])
def test_a_file_that_cannot_be_read_is_not_called_changed(
    folder: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    really = os.open

    def refuse(path: os.PathLike[str], *args: int) -> int:
        if Path(path).name == name:
            raise PermissionError(13, "Permission denied")
        return really(path, *args)

    monkeypatch.setattr(os, "open", refuse)
    with pytest.raises(UnreadableError, match=f"{name}: cannot be read: Perm") as caught:
        check_stored_run(str(folder))
    assert caught.value.exit_code == ExitCode.FILE
    if name == "manifest.json":
        return
    # What is wrong all the same is not hidden behind it.
    (folder / "trajectory.parquet").unlink()
    with pytest.raises(BrokenRunError, match=f"{name}: cannot be read: Perm"):
        check_stored_run(str(folder))


def test_a_folder_that_cannot_be_searched_may_hold_a_run(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    really = os.stat

    def refuse(path: os.PathLike[str], **options: object) -> os.stat_result:
        if str(path).startswith(str(folder / "")):
            raise PermissionError(13, "Permission denied")
        return really(path, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(os, "stat", refuse)
    monkeypatch.setattr(Path, "exists", lambda *_, **__: False)  # as from Python 3.14 on
    with pytest.raises(UnreadableError, match="cannot be read: Permission denied"):
        check_stored_run(str(folder))


def test_a_table_that_is_not_of_the_solution_is_found_behind_right_digests(
    folder: Path, run: Run
) -> None:
    columns = command_columns(run)
    columns["fork_deg"] = columns["fork_deg"] + 1e-6
    replace_file(folder, "commands.csv", encode_table(columns, "csv"))
    assert failed(check_stored_run(str(folder))) == {"table.fork"}


def test_metrics_that_tell_a_softer_ride_are_found(folder: Path) -> None:
    metrics = json.loads((folder / "metrics.json").read_bytes())
    turning = metrics["felt"]["seat_angular_acceleration"]["magnitude"]
    turning["peak_after_rad_s2"] *= 0.5
    replace_file(folder, "metrics.json", json.dumps(metrics).encode())
    assert failed(check_stored_run(str(folder))) == {"ride.turning_peak"}


def test_metrics_of_another_profile_are_found(folder: Path) -> None:
    metrics = json.loads((folder / "metrics.json").read_bytes())
    metrics["profile"]["sha256"] = "0" * 64
    replace_file(folder, "metrics.json", json.dumps(metrics).encode())
    with pytest.raises(BrokenRunError, match="of another profile"):
        check_stored_run(str(folder))


@pytest.mark.parametrize(
    "changes",
    [
        {"machine": {}},
        {"machine": None},
        {"machine": {"name": "des", "base": "des", "limits": {"arm": {"rate_rad_s": "x"}}}},
        {"seat": {"yaw_rad": 1.0}},
        {"seat": []},
        {"start": {"arm_rad": "x"}},
    ],
)
def test_a_manifest_without_its_machine_is_refused(
    folder: Path, changes: dict[str, object]
) -> None:
    rewrite(folder, **changes)
    with pytest.raises(BrokenRunError, match=r"manifest\.json"):
        check_stored_run(str(folder))


def test_a_run_of_an_earlier_version_has_to_be_made_again(folder: Path) -> None:
    manifest = json.loads((folder / "manifest.json").read_bytes())
    del manifest["sha256"]
    manifest["format"] = UNSEALED_FORMAT
    (folder / "manifest.json").write_text(json.dumps(manifest))
    with pytest.raises(BrokenRunError, match="earlier version"):
        check_stored_run(str(folder))


def test_another_machines_limits_are_those_that_hold(folder: Path, run: Run) -> None:
    peak = float(np.max(np.abs(run.commands.rate_start[:, 1])))
    assert failed(check_stored_run(str(folder), tight(rate=1.01 * peak))) == set()
    found = failed(check_stored_run(str(folder), tight(rate=0.9 * peak)))
    assert "limits.fork.rate" in found
    for bad in (float("nan"), 0.0, -1.0):
        assert "limits.fork.jerk" in failed(check_stored_run(str(folder), tight(jerk=bad)))


def test_a_machine_of_another_shape_is_told(folder: Path) -> None:
    longer = replace(DES, name="longer", rows=(*DES.rows[:-1], replace(DES.rows[-1], a=9.0)))
    (notice,) = check_stored_run(str(folder), longer).notices
    assert (notice.name, notice.harmful) == ("geometry", True)


def test_where_the_machine_stands_is_compared_with_the_first_row(folder: Path, run: Run) -> None:
    first = run.commands.angle[0]
    there = np.array([run.commands.rate[0, 0], first[1], first[2]])
    assert failed(check_stored_run(str(folder), start=there)) == set()
    off = there + np.array([0.0, 0.0, 0.02])
    assert failed(check_stored_run(str(folder), start=off)) == {"start.cab"}


def test_a_run_beyond_limits_that_only_warned_does_not_pass(tmp_path: Path) -> None:
    settings = ["time.step_s=0.05", "machine.limits.fork.rate_rad_s=0.5"]
    profile = load_profile("cobra", settings=settings)
    assert profile.reduction.limits == "warn"
    write_run(reduce_profile(profile), tmp_path / "run", plots=False)
    assert "limits.fork.rate" in failed(check_stored_run(str(tmp_path / "run")))


@pytest.mark.parametrize("form", ["csv", "ndjson", "json", "parquet"])
def test_a_table_alone_is_measured_in_every_format(run: Run, form: str) -> None:
    data = encode_table(command_columns(run), form)  # type: ignore[arg-type]
    verdict = check_stored_table(data, "table", DES, Seat())
    assert verdict.failed == ()
    assert verdict.name == ""
    found = check_stored_table(data, "table", tight(rate=0.1), Seat())
    assert "limits.fork.rate" in failed(found)


def test_what_is_no_table_is_refused_with_its_label(run: Run) -> None:
    data = encode_table(command_columns(run), "csv")
    for broken in (b"", data[:-1], b"t_s,p\n1,2\n", data.replace(b"fork_deg", b"fork_rad")):
        with pytest.raises(BrokenRunError, match=r"^table: is no command table"):
            check_stored_table(broken, "table", DES, Seat())


def test_times_that_do_not_rise_end_the_check(run: Run) -> None:
    columns = command_columns(run)
    columns["t_s"] = columns["t_s"][::-1]
    verdict = check_stored_table(encode_table(columns, "csv"), "table", DES, Seat())
    assert failed(verdict) == {"table.times"}


def test_the_arms_angle_counts_where_it_is_limited(run: Run) -> None:
    """The table tells the arm's rate alone; it turns by what its rates add up to."""
    arm, fork, cab = DES.limits
    t = np.linspace(0.0, 4.0, 401)
    turned = 0.5 * (1 - np.cos(np.pi * t / 2)) ** 2
    zero = 0 * t
    columns = {"t_s": t, "arm_rpm": turned * 30 / np.pi, "fork_deg": zero, "cab_deg": zero}
    data = encode_table(columns, "csv")
    whole = float(np.sum(0.5 * (turned[1:] + turned[:-1]) * np.diff(t)))
    machine = replace(
        DES,
        limits=(replace(arm, angle=whole + 0.5, acceleration=9.0, jerk=99.0, rate=9.0), fork, cab),
    )
    assert failed(check_stored_table(data, "t", machine, Seat())) == set()
    verdict = check_stored_table(data, "t", machine, Seat(), arm_start=0.6)
    assert "limits.arm.angle" in failed(verdict)
