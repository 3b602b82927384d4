"""The same input gives the same bytes, whatever surrounds the process."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support.run_files import tree

PROFILES = ("one", "two")


@pytest.fixture
def reduced(command, write_profile, tmp_path: Path) -> Callable[..., dict[str, bytes]]:
    """Reduce two profiles in a process of its own; return the files by their names."""
    one, two = (write_profile(name, r2=r2).name for name, r2 in (("one", "0.5"), ("two", "2")))

    def reduce(out: str, *options: str, **env: str) -> dict[str, bytes]:
        names = (two, one) if "--jobs" in options else (one, two)
        done = command("-q", "reduce", *names, "-o", out, *options, env=env)
        assert done.returncode == 0, done.stderr
        files = tree(tmp_path / out)
        del files["summary.csv"]  # in the order of the call
        return files

    return reduce


@pytest.mark.slow
def test_bytes_do_not_depend_on_what_surrounds_the_process(reduced) -> None:
    plain = reduced("a", PYTHONHASHSEED="0", TZ="UTC", LC_ALL="C.UTF-8")
    assert {name.partition("/")[0] for name in plain} == set(PROFILES)
    assert any(name.endswith(".png") for name in plain)
    other = reduced(
        *("b", "--jobs", "2"),
        PYTHONHASHSEED="4242",
        TZ="Asia/Kathmandu",
        LC_ALL="tr_TR.UTF-8",
        LANG="de_DE.UTF-8",
        OPENBLAS_NUM_THREADS="2",
        OMP_NUM_THREADS="2",
        COLUMNS="40",
        PYTHONOPTIMIZE="1",
    )
    assert other == plain


def test_a_run_is_made_again_from_its_own_folder(
    invoke, write_profile, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    name = write_profile("one").name
    options = ["--r2", "0.7", "--set", "seat.yaw_deg=80", "--no-plots"]
    assert invoke("-q", "reduce", name, *options, "-o", "run").exit_code == 0
    first = tree(tmp_path / "run")
    assert first["source/one.yaml"] == (tmp_path / name).read_bytes()
    program, *words = json.loads(first["manifest.json"])["made"]["command"]
    assert program == "des-coriolis"
    (tmp_path / name).unlink()
    monkeypatch.chdir(tmp_path / "run")
    assert invoke("-q", *words, "--no-plots").exit_code == 0
    assert tree(tmp_path / "run" / "again") == first
