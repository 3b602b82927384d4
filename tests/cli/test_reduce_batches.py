"""``reduce`` with several profiles, and again."""

import csv
from pathlib import Path

import pytest

from tests.support.run_files import RUN_FILES, replace_file


def summary_of(folder: Path) -> list[dict[str, str]]:
    with open(folder / "summary.csv", newline="") as file:
        return list(csv.DictReader(file))


def test_several_profiles_have_a_folder_each(invoke, write_profile, tmp_path) -> None:
    files = [write_profile(name).name for name in ("one", "two")]
    result = invoke("reduce", *files, "--no-plots", "-o", "all")
    assert (result.exit_code, result.stdout) == (0, "")
    assert {path.name for path in (tmp_path / "all").iterdir()} == {"one", "two", "summary.csv"}
    assert result.stderr.splitlines()[-1] == "2 profiles: 2 done"


def test_a_batch_stops_at_the_first_failure(invoke, write_profile, tmp_path) -> None:
    files = [write_profile("bad", fork_deg="sin(").name, write_profile("good").name]
    result = invoke("reduce", *files, "--no-plots")
    assert result.exit_code == 1
    assert "1 failed, 1 not run (--keep-going" in result.stderr
    assert not (tmp_path / "runs" / "good").exists()


@pytest.mark.slow
@pytest.mark.parametrize("jobs", ["1", "2"])
def test_keep_going_runs_the_others(invoke, write_profile, tmp_path, jobs: str) -> None:
    names = ("first", "bad", "last")
    files = [write_profile(name, **{"fork_deg": "sin("} if name == "bad" else {}) for name in names]
    args = [path.name for path in files]
    result = invoke("reduce", *args, "--no-plots", "--keep-going", "--jobs", jobs)
    assert result.exit_code == 1
    lines = [line for line in result.stderr.splitlines() if not line.startswith(" ")]
    assert [line.split()[0].partition(":")[0] for line in lines[:3]] == [
        "first",
        "bad.yaml",
        "last",
    ]
    assert lines[-1] == "3 profiles: 2 done, 1 failed"
    assert {path.name for path in (tmp_path / "runs").iterdir()} == {"first", "last", "summary.csv"}
    rows = summary_of(tmp_path / "runs")
    assert [(row["folder"], row["state"], row["exit_code"]) for row in rows] == [
        ("first", "reduced", "0"),
        ("", "failed", "3"),
        ("last", "reduced", "0"),
    ]
    assert "bad.yaml" in rows[1]["message"]


@pytest.mark.slow
def test_the_number_of_jobs_does_not_change_a_byte(command, write_profile, tmp_path) -> None:
    files = [write_profile(name).name for name in ("one", "two")]
    for jobs in ("1", "2"):
        done = command("reduce", *files, "--no-plots", "--jobs", jobs, "-o", f"by{jobs}")
        assert done.returncode == 0, done.stderr
    for name in ("one", "two"):
        for file in RUN_FILES:
            single = (tmp_path / "by1" / name / file).read_bytes()
            assert single == (tmp_path / "by2" / name / file).read_bytes()
    by1, by2 = ((tmp_path / f"by{jobs}" / "summary.csv").read_bytes() for jobs in (1, 2))
    assert by1 == by2


def test_two_profiles_of_one_name_are_refused_before_anything_runs(
    invoke, write_profile, tmp_path
) -> None:
    first = write_profile("same")
    (tmp_path / "copy.yaml").write_bytes(first.read_bytes())
    result = invoke("reduce", first.name, "copy.yaml", "--keep-going")
    assert result.exit_code == 2
    assert "same.yaml, copy.yaml" in result.stderr
    assert not (tmp_path / "runs").exists()


def test_resume_keeps_a_finished_run_and_refuses_another(invoke, write_profile, tmp_path) -> None:
    files = [write_profile(name).name for name in ("one", "two")]
    assert invoke("reduce", files[0], "--no-plots").exit_code == 0
    table = tmp_path / "runs" / "one" / "commands.csv"
    before = table.stat().st_mtime_ns
    result = invoke("reduce", *files, "--no-plots", "--resume")
    assert result.exit_code == 0
    assert result.stderr.splitlines()[-1] == "2 profiles: 1 done, 1 already done"
    assert table.stat().st_mtime_ns == before
    kept, done = summary_of(tmp_path / "runs")
    assert (kept.pop("state"), done.pop("state")) == ("kept", "reduced")
    assert set(kept) == set(done)
    own = ("source", "name", "folder")
    assert {key: kept[key] for key in kept if key not in own} == {
        key: done[key] for key in done if key not in own
    }
    result = invoke("reduce", files[0], "--no-plots", "--resume", "--r2", "8")
    assert result.exit_code == 1
    assert "very same profile" in result.stderr or "of this very profile" in result.stderr


def test_resume_takes_no_odd_metrics_for_those_of_the_profile(
    invoke, write_profile, tmp_path
) -> None:
    """Each listed in its manifest with the right digest, as a forger would."""
    file = write_profile("one").name
    assert invoke("reduce", file, "--no-plots").exit_code == 0
    folder = tmp_path / "runs" / "one"
    for odd in (
        *(b"[]", b"{}", b"", b"\xff", b"null", b'{"profile": [1]}', b'{"profile": null}'),
        *(b'{"profile": "x"}', b'{"profile": {"sha256": [1]}}', b'{"profile": {"sha256": NaN}}'),
        b'{"profile": %b}' % (b"9" * 5000),
        b'{"profile": %b%b}' % (b"[" * 100_000, b"]" * 100_000),
    ):
        replace_file(folder, "metrics.json", odd)
        result = invoke("reduce", file, "--no-plots", "--resume")
        assert result.exit_code == 1, odd[:80]
        assert result.stderr.splitlines()[-1].endswith(
            "is not a finished run of this very profile; --overwrite replaces it"
        )


def test_the_closing_table_has_a_line_a_run_and_a_dry_run_no_summary(
    invoke, write_profile, tmp_path
) -> None:
    files = [write_profile("bad", fork_deg="sin(").name, write_profile("good").name]
    assert invoke("reduce", *files, "--dry-run", "--keep-going").exit_code == 1
    assert not (tmp_path / "runs").exists()
    result = invoke("reduce", *files, "--no-plots", "--keep-going")
    head, bad, good, _ = result.stderr.splitlines()[-4:]
    assert head.split()[:2] == ["profile", "status"]
    assert (bad.split()[:2], bad.split()[-1]) == (["bad.yaml", "rejected"], "3")
    assert (good.split()[:2], good.split()[-1]) == (["good", "converged"], "0")
    quiet = invoke("-q", "reduce", *files, "--no-plots", "--keep-going", "--resume")
    assert "status" not in quiet.stderr
    assert [row["state"] for row in summary_of(tmp_path / "runs")] == ["failed", "kept"]
