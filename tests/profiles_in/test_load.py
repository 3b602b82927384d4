"""Where profiles come from: files beside them, standard input, and what cannot be read."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from des_cli.errors import FileAccessError, ProfileError, UsageError
from des_cli.model.profile import BodyRates
from des_cli.profiles_in.caps import Caps
from des_cli.profiles_in.load import load_profile
from tests.support.profiles import SMALL, load


def test_samples_come_from_a_csv_beside_the_profile(tmp_path: Path) -> None:
    folder = tmp_path / "logs"
    folder.mkdir()
    (folder / "log.csv").write_text("t,p,q,r\n0,1,2,3\n1,2,3,4\n")
    path = folder / "run.yaml"
    path.write_text(
        "format: des-coriolis/1\n"
        "samples: {file: log.csv, columns: {t_s: t, p_rad_s: p, q_rad_s: q, r_deg_s: r}}\n"
    )
    profile = load_profile(path)
    assert profile.name == "run"
    assert isinstance(profile.command, BodyRates)
    np.testing.assert_allclose(profile.command.start, [[1, 2, np.radians(3)]])
    (folder / "log.csv").write_text("t,p,q,r\n0,1,2,3\n1,2,3,5\n")
    assert load_profile(path).sha256 != profile.sha256
    (folder / "log.csv").write_text("t,p,q,r\n0,1,2,x\n1,2,3,5\n")
    with pytest.raises(ProfileError, match=r"log\.csv:2: r: must be a number, is 'x'"):
        load_profile(path)
    (folder / "log.csv").unlink()
    with pytest.raises(FileAccessError, match=r"log\.csv: cannot be read: No such file"):
        load_profile(path)
    (folder / "log.csv").write_text("t,p,q,r\n0,1,2,3\n1,2,3,5\n")
    with pytest.raises(ProfileError, match="the times come from the samples"):
        load_profile(path, settings=["time={start_s: 0, stop_s: 1, step_s: 1}"])


def test_a_machine_file_is_found_from_the_profile_and_from_a_setting(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    for folder, metres in ((here, 7), (there, 8)):
        folder.mkdir()
        (folder / "own.yaml").write_text(f"{{base: des, name: own, lengths_m: {{L2: {metres}}}}}\n")
    (there / "run.yaml").write_text(SMALL + "machine: own.yaml\n")
    monkeypatch.chdir(here)
    profile = load_profile(there / "run.yaml")
    assert profile.machine.lengths["L2"] == 8.0
    changed = load_profile(there / "run.yaml", settings=["machine=own.yaml"])
    assert changed.machine.lengths["L2"] == 7.0


def test_the_digest_tells_every_input_apart() -> None:
    digests = {
        load(SMALL).sha256,
        load(SMALL + "\n").sha256,
        load(SMALL, "reduction.r2=2").sha256,
        load(SMALL, "reduction.r2=3").sha256,
    }
    assert len(digests) == 4
    assert load(SMALL).sha256 == load(SMALL).sha256


def test_a_yaml_profile_must_be_utf_8(tmp_path: Path) -> None:
    path = tmp_path / "latin.yaml"
    path.write_bytes(SMALL.encode() + b"# \xe9t\xe9\n")
    with pytest.raises(ProfileError, match=r"latin\.yaml:8: is not UTF-8 text \(byte 0xe9\)"):
        load_profile(path)


def test_renaming_columns_of_a_yaml_profile_is_wrong_use() -> None:
    with pytest.raises(UsageError, match="renames columns of a CSV profile"):
        load_profile("cobra", columns={"t_s": "t"})


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes here")
@pytest.mark.parametrize("line", ["machine: ./pipe", "samples: {file: pipe}"])
def test_what_a_profile_refers_to_is_no_pipe(tmp_path: Path, line: str) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "run.yaml").write_text(f"format: des-coriolis/1\n{line}\n")
    with pytest.raises((FileAccessError, ProfileError), match="pipe: is a pipe, not a file"):
        load_profile(tmp_path / "run.yaml")


def test_only_the_caller_raises_the_caps(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t_s,arm_rpm,fork_deg,cab_deg\n" + "".join(f"{k},1,2,3\n" for k in range(5)))
    with pytest.raises(ProfileError, match="has more than 4 rows"):
        load_profile(path, caps=Caps(rows=4))
    assert len(load_profile(path, caps=Caps(rows=5)).t) == 5
    with pytest.raises(ProfileError, match="makes more than 4 samples"):
        load_profile("-", stdin=SMALL.encode(), caps=Caps(rows=4))
    path.write_bytes(bytes((1 << 20) + 1))
    with pytest.raises(FileAccessError, match="is larger than 1 MiB"):
        load_profile(path, caps=Caps(mib=1))
