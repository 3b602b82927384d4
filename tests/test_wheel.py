"""The wheel holds what an installed tool needs beside its code."""

import os
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def build(source: Path, out: Path) -> Path:
    """Build the wheel of a source tree."""
    pytest.importorskip("hatchling")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(out)]
    done = subprocess.run(command, cwd=source, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    (wheel,) = out.glob("des_coriolis-*.whl")
    return wheel


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build(ROOT, tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def names(wheel: Path) -> set[str]:
    with zipfile.ZipFile(wheel) as archive:
        return set(archive.namelist())


def test_every_source_file_and_profile_is_in_it(names: set[str]) -> None:
    source = {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "des_cli").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    profiles = {f"des_cli/profiles/{path.name}" for path in (ROOT / "profiles").iterdir()}
    assert "des_cli/py.typed" in source
    assert source | profiles <= names


def test_nothing_else_is_in_it(names: set[str]) -> None:
    assert {name.partition("/")[0].partition("-")[0] for name in names} == {
        "des_cli",
        "des_coriolis",
    }


def test_the_same_sources_make_the_same_bytes(wheel: Path, tmp_path: Path) -> None:
    """Elsewhere, at another time, with other dates of the files."""
    source = tmp_path / "elsewhere"
    source.mkdir()
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source)
    for name in ("des_cli", "profiles"):
        shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns("__pycache__"))
    for path in source.rglob("*"):
        os.utime(path, (1e9, 1e9))
    again = build(source, tmp_path)
    assert again.read_bytes() == wheel.read_bytes()


def plain(name: str) -> str:
    """A package's name as indexes compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def test_few_packages_are_depended_on_and_all_are_locked_with_digests() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    direct = {plain(re.split(r"[^\w.-]", each)[0]) for each in project["dependencies"]}
    assert len(direct) <= 11
    lock = (ROOT / "requirements.lock").read_text().replace("\\\n", " ")
    pins = [line for line in lock.splitlines() if line and not line.lstrip().startswith("#")]
    assert direct <= {plain(pin.partition("==")[0].strip()) for pin in pins}
    assert all("==" in pin and "--hash=sha256:" in pin for pin in pins)
