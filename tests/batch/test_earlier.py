"""An earlier output is never taken for the answer to a profile that has none."""

from pathlib import Path

import pytest

from des_cli.batch.earlier import settle, stands, unnamed
from des_cli.batch.job import JobResult, Output
from des_cli.errors import ExitCode
from des_cli.runs_out.manifest import is_run
from des_cli.runs_out.run_folder import write_run
from tests.support.run_files import tree

REFUSED = [ExitCode.PROFILE, ExitCode.NO_SOLUTION, ExitCode.NOT_RELEASED]
OTHER = [ExitCode.FILE, ExitCode.USAGE, ExitCode.BUG]


@pytest.fixture
def folder(tmp_path: Path, synthetic_run) -> Path:
    write_run(synthetic_run(11), tmp_path / "run", plots=False)
    return tmp_path / "run"


def failed(code: ExitCode) -> JobResult:
    return JobResult("p.yaml", "p", code, ("why",), state="failed")


def output(target: Path, *, overwrite: bool = True) -> Output:
    form = "csv" if target.suffix else None
    return Output(str(target), out_is_parent=False, table_format=form, overwrite=overwrite)


@pytest.mark.parametrize("code", REFUSED)
def test_what_is_answered_by_no_takes_the_earlier_run_away(folder: Path, code: ExitCode) -> None:
    (folder / "thesis.tex").write_bytes(b"years of work")
    (words,) = settle(output(folder), folder, failed(code))
    assert words.startswith(f"withdrew the earlier {folder}")
    assert set(tree(folder)) == {"thesis.tex"}


@pytest.mark.parametrize("code", REFUSED)
def test_a_table_goes_and_a_link_to_it_stays(tmp_path: Path, code: ExitCode) -> None:
    (tmp_path / "real.csv").write_bytes(b"old")
    link = tmp_path / "link.csv"
    link.symlink_to("real.csv")
    (words,) = settle(output(link), link, failed(code))
    assert words.startswith("withdrew")
    assert not (tmp_path / "real.csv").exists()
    assert link.is_symlink()


@pytest.mark.parametrize("code", OTHER)
def test_what_says_nothing_about_the_profile_leaves_it_and_says_so(
    folder: Path, code: ExitCode
) -> None:
    before = tree(folder)
    (words,) = settle(output(folder), folder, failed(code))
    assert words == f"left the earlier {folder} as it is: nothing was written"
    assert tree(folder) == before


@pytest.mark.parametrize("code", REFUSED)
def test_without_overwrite_it_is_left_and_that_is_said(folder: Path, code: ExitCode) -> None:
    before = tree(folder)
    (words,) = settle(output(folder, overwrite=False), folder, failed(code))
    assert words.startswith(f"left the earlier {folder} as it is: it is not what")
    assert tree(folder) == before


@pytest.mark.parametrize("manifest", [None, b"", b'{"format": "des-coriolis/run/1"', b"{}"])
def test_a_table_that_no_manifest_vouches_for_is_left_and_that_is_said(
    folder: Path, manifest: bytes | None
) -> None:
    (folder / "manifest.json").unlink()
    if manifest is not None:
        (folder / "manifest.json").write_bytes(manifest)
    before = tree(folder)
    (words,) = settle(output(folder), folder, failed(ExitCode.PROFILE))
    assert words.startswith(f"left the earlier {folder}")
    assert "no manifest" in words
    assert tree(folder) == before


def test_what_cannot_be_withdrawn_is_said(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def no(*_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied", "commands.csv")

    monkeypatch.setattr(Path, "unlink", no)
    lines = settle(output(folder), folder, failed(ExitCode.PROFILE))
    assert "cannot be removed: permission denied" in lines[0]
    assert lines[-1].startswith(f"left the earlier {folder}")
    assert is_run(folder)


def test_a_table_that_is_gone_is_not_said_to_be_left(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    really = Path.unlink

    def no(path: Path, **options: bool) -> None:
        if path.name == "metrics.json":
            raise PermissionError(13, "Permission denied", "metrics.json")
        really(path, **options)

    monkeypatch.setattr(Path, "unlink", no)
    lines = settle(output(folder), folder, failed(ExitCode.PROFILE))
    assert "metrics.json: cannot be removed: permission denied" in lines[0]
    assert lines[-1].startswith(f"withdrew the command table of the earlier {folder}")
    monkeypatch.undo()
    (words,) = settle(output(folder), folder, failed(ExitCode.PROFILE))
    assert words.startswith(f"withdrew the earlier {folder}")
    assert tree(folder) == {}


def test_nothing_is_said_where_nothing_stands_or_nothing_failed(
    tmp_path: Path, folder: Path
) -> None:
    for name in ("absent", "absent.csv"):
        target = tmp_path / name
        assert not stands(output(target), target)
        assert settle(output(target), target, failed(ExitCode.PROFILE)) == ()
    assert settle(output(folder), folder, JobResult("p.yaml", "p")) == ()
    assert is_run(folder)


def test_a_profile_without_a_name_may_have_a_run(tmp_path: Path) -> None:
    into = Output(str(tmp_path), overwrite=True)
    (words,) = unnamed(into, failed(ExitCode.PROFILE))
    assert "p.yaml" in words
    assert str(tmp_path) in words
    assert unnamed(into, failed(ExitCode.FILE)) == ()
    assert unnamed(Output(str(tmp_path / "absent")), failed(ExitCode.PROFILE)) == ()
