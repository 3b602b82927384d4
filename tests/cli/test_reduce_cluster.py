"""``reduce --scheduler`` with a real scheduler and workers on the loopback."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.dask_cluster import DaskCluster, dask_cluster
from tests.support.processes import start
from tests.support.run_files import tree

pytest.importorskip("distributed")

WATCH = """\
import os, sys
def note(event, args):
    if event == "open" and isinstance(args[0], str) and args[0].startswith({folder!r}):
        os.write(2, b"opened " + args[0].encode() + b"\\n")
sys.addaudithook(note)
open({folder!r} + "/none", "a").close()
"""
"""In the workers: what they open of a test's folder is written to their log, once at the least."""


@pytest.fixture
def cluster(
    tmp_path_factory: pytest.TempPathFactory, tmp_path: Path, python_environment: dict[str, str]
) -> Iterator[DaskCluster]:
    hook = tmp_path_factory.mktemp("hook")
    (hook / "sitecustomize.py").write_text(WATCH.format(folder=str(tmp_path)))
    path = f"{hook}:{python_environment['PYTHONPATH']}"
    home = tmp_path_factory.mktemp("cluster") / "home"
    with dask_cluster(home, python_environment | {"PYTHONPATH": path}, 2) as made:
        yield made


def wait_for(what: object, seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not what():  # type: ignore[operator]
        assert time.monotonic() < end
        time.sleep(0.01)


PROFILE = """\
format: des-coriolis/1
machine: machine.yaml
time: {start_s: 0, stop_s: 10, step_s: 0.1}
joints:
  arm_rpm: "8.8 - 0.66*t"
  fork_deg: "-60*(1 - cos(pi*t/5))"
  cab_deg: "30 - 2.5*t"
"""


@pytest.mark.slow
def test_a_worker_that_is_killed_changes_no_byte(
    cluster: DaskCluster, command, tmp_path: Path, python_environment: dict[str, str]
) -> None:
    (tmp_path / "machine.yaml").write_text("base: des\nname: mine\n")
    for name in ("one", "two"):
        (tmp_path / f"{name}.yaml").write_text(PROFILE)
    line = ("reduce", "one.yaml", "two.yaml", "--no-plots", "--grid")
    line = (*line, "budget.seat_g_rms_error_g=0.05,0.06,0.07,0.08")
    local = command(*line, "-o", "local")
    assert local.returncode == 0, local.stderr
    batch = start(
        *(sys.executable, "-m", "des_cli", *line),
        *("-o", "remote", "--scheduler", cluster.address),
        cwd=tmp_path,
        env=python_environment,
    )
    wait_for(lambda: list((tmp_path / "remote").glob("*/manifest.json")))
    assert batch.poll() is None
    cluster.workers[0].kill()
    done = len(list((tmp_path / "remote").glob("*/manifest.json")))
    assert done < 6, "the killed worker had nothing to do"
    assert batch.wait(120) == 0
    assert tree(tmp_path / "remote") == tree(tmp_path / "local")
    opened = [line for line in cluster.log("worker").splitlines() if line.startswith("opened ")]
    assert set(opened) == {f"opened {tmp_path}/none"}, "a worker opened a file of the client"


@pytest.mark.slow
def test_an_interruption_cancels_and_the_cluster_is_free_again(
    cluster: DaskCluster, command, tmp_path: Path, python_environment: dict[str, str]
) -> None:
    (tmp_path / "machine.yaml").write_text("base: des\nname: mine\n")
    (tmp_path / "one.yaml").write_text(PROFILE.replace("0.1}", "0.01}"))
    line = ("reduce", "one.yaml", "--no-plots", "--scheduler", cluster.address)
    grid = ("--grid", "budget.seat_g_rms_error_g=0.05,0.06,0.07,0.08,0.09,0.1")
    batch = start(
        *(sys.executable, "-m", "des_cli", *line, *grid), cwd=tmp_path, env=python_environment
    )
    wait_for(lambda: list(tmp_path.glob("runs/.*.lock")))
    time.sleep(1.0)
    began = time.monotonic()
    batch.send_signal(signal.SIGINT)
    assert batch.wait(30) == 130
    assert time.monotonic() - began < 10.0
    assert not [path for path in tmp_path.rglob(".*")]
    (tmp_path / "one.yaml").write_text(PROFILE.replace("0.1}", "0.25}"))
    again = command(*line, "-o", "again")
    assert again.returncode == 0, again.stderr


@pytest.mark.slow
def test_a_scheduler_that_is_lost_is_a_sentence_for_each_profile(
    cluster: DaskCluster, tmp_path: Path, python_environment: dict[str, str]
) -> None:
    (tmp_path / "machine.yaml").write_text("base: des\nname: mine\n")
    (tmp_path / "one.yaml").write_text(PROFILE.replace("0.1}", "0.02}"))
    line = ("reduce", "one.yaml", "--no-plots", "--keep-going", "--scheduler", cluster.address)
    grid = ("--grid", "budget.seat_g_rms_error_g=0.05,0.06,0.07,0.08,0.09,0.1")
    with open(tmp_path / "words", "wb") as words:
        batch = start(
            *(sys.executable, "-m", "des_cli", *line, *grid),
            **{"cwd": tmp_path, "env": python_environment, "stderr": words},
        )
        wait_for(lambda: list(tmp_path.glob("runs/*/manifest.json")))
        cluster.scheduler.kill()
        assert batch.wait(120) == 1
    said = (tmp_path / "words").read_text()
    assert "was given up: the scheduler is gone" in said
    assert "Traceback" not in said
    assert not list(tmp_path.glob("runs/.*"))


@pytest.mark.slow
def test_a_scheduler_that_is_not_there_is_one_sentence_within_ten_seconds(
    command, tmp_path: Path
) -> None:
    began = time.monotonic()
    done = command("reduce", "cobra", "--scheduler", "tcp://127.0.0.1:1")
    assert time.monotonic() - began < 10.0
    assert done.returncode == 1
    assert done.stderr.decode().splitlines() == ["tcp://127.0.0.1:1: no scheduler answers there"]
    assert not (tmp_path / "runs").exists()


@pytest.mark.parametrize(
    "args",
    [
        ["--scheduler", "host:8786"],
        ["--scheduler", "tcp://127.0.0.1:1", "--jobs", "2"],
        ["--scheduler", "tcp://127.0.0.1:1", "-o", "x.csv"],
    ],
)
def test_what_a_cluster_cannot_do_is_refused_at_once(invoke, small: str, args: list[str]) -> None:
    assert invoke("reduce", small, *args).exit_code == 2


def test_a_dry_run_needs_no_cluster(invoke, small: str) -> None:
    result = invoke("reduce", small, "--scheduler", "tcp://127.0.0.1:1", "--dry-run")
    assert (result.exit_code, "would be reduced" in result.stderr) == (0, True)
