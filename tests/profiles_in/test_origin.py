"""What was read of a profile makes it again, from a folder of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from des_cli.cli.reduce import reduce
from des_cli.model.machines import MACHINES
from des_cli.model.profile import Profile
from des_cli.profiles_in.caps import DEFAULT_CAPS
from des_cli.profiles_in.load import load_profile
from des_cli.profiles_in.machine_text import machine_text
from des_cli.profiles_in.setting import Setting

PROFILE = """\
format: des-coriolis/1
machine: {machine}
time: {{start_s: 0, stop_s: 1, step_s: 0.1}}
joints: {{arm_rpm: "8 + t", fork_deg: "10*t", cab_deg: "5*t"}}
"""


def again(profile: Profile, folder: Path, monkeypatch: pytest.MonkeyPatch) -> Profile:
    """Read a profile from what it keeps of itself, as its command would."""
    assert profile.origin is not None
    (folder / "source").mkdir(parents=True)
    for file in profile.origin.files:
        assert "/" not in file.name
        (folder / "source" / file.name).write_bytes(file.data)
    monkeypatch.chdir(folder)
    context = reduce.make_context(
        "reduce", [f"source/{profile.origin.files[0].name}", *profile.origin.options]
    )
    given = context.params
    return load_profile(
        given["profiles"][0],
        settings=given["settings"],
        columns=given["columns"],
        separator=given["separator"],
        decimal=given["decimal"],
        caps=DEFAULT_CAPS,
    )


def test_a_profile_alone_has_the_same_digest(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "ride.yaml"
    path.write_text(PROFILE.format(machine="des"))
    profile = load_profile(path, settings=["reduction.r2=0.3", Setting("seat", {"yaw_deg": 1}, "")])
    found = again(profile, tmp_path / "run", monkeypatch)
    assert (found.sha256, found.name) == (profile.sha256, "ride")


def test_files_elsewhere_stand_beside_it_and_are_named_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "deep").mkdir()
    (tmp_path / "ride.yaml").write_text(machine_text(MACHINES["des"]))
    path = tmp_path / "deep" / "ride.yaml"
    path.write_text(PROFILE.format(machine="../ride.yaml"))
    profile = load_profile(path)
    assert profile.origin is not None
    assert [file.name for file in profile.origin.files] == ["ride.yaml", "of-ride.yaml"]
    assert profile.origin.options == ("--set", 'machine="source/of-ride.yaml"')
    found = again(profile, tmp_path / "run", monkeypatch)
    assert found.machine == profile.machine
    assert str(tmp_path) not in " ".join(profile.origin.options)


def test_a_table_keeps_how_it_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = [f"{i / 10:.1f};{8 + i};{10 * i};{5 * i}".replace(".", ",") for i in range(5)]
    path = tmp_path / "log.csv"
    path.write_text("\n".join(["time;arm_rpm;fork_deg;cab_deg", *rows]) + "\n")
    profile = load_profile(path, columns={"t_s": "time"}, separator=";", decimal=",")
    found = again(profile, tmp_path / "run", monkeypatch)
    assert (found.sha256, found.name) == (profile.sha256, "log")


def test_standard_input_gets_a_name() -> None:
    profile = load_profile("-", stdin=PROFILE.format(machine="des").encode())
    assert profile.origin is not None
    assert profile.origin.files[0].name == "stdin.yaml"
