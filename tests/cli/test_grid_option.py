"""``--grid`` on the command line: what it takes, and what it refuses."""

import click
import pytest

from des_cli.batch import source
from des_cli.batch.grid import Axis
from des_cli.cli.grid_option import read_grid
from des_cli.model.profile import Profile
from des_cli.profiles_in.setting import Setting
from tests.support.run_files import metrics_of, tree


@pytest.mark.parametrize(
    ("text", "axis"),
    [
        ("reduction.r2=0.2,1", Axis("reduction.r2", (0.2, 1))),
        (" r2 = 1, 1 ,2", Axis("reduction.r2", (1, 2))),
        ("r1=[0,2,0],[2,2,2]", Axis("reduction.r1", ([0, 2, 0], [2, 2, 2]))),
        ("time.step_s=0.1", Axis("time.step_s", (0.1,))),
        ("budget.seat_rate_deviation_relative=5%,0.1", None),
        ("ends=free,match-both", Axis("reduction.ends", ("free", "match-both"))),
    ],
)
def test_a_key_without_a_section_is_one_of_the_reduction(text: str, axis: Axis | None) -> None:
    share = Axis("reduction.budget.seat_rate_deviation_relative", (0.05, 0.1))
    assert read_grid([text], ()) == (axis or share,)


@pytest.mark.parametrize(
    ("texts", "words"),
    [
        (["r2"], "is not KEY=VALUE,VALUE"),
        (["=1"], "is not KEY=VALUE,VALUE"),
        (["r2="], "are not values with commas between"),
        (["r2=1,,2"], "are not values with commas between"),
        (["r2=[1"], "are not values with commas between"),
        (["a b=1"], "is not a path"),
        (["name=a,b"], "no key to vary"),
        (["r2=1", "reduction.r2=2"], "reduction.r2 is given twice"),
        (["budget.seat_g_rms_error_g=5%"], "is no share"),
    ],
)
def test_what_is_no_grid_is_refused(texts: list[str], words: str) -> None:
    with pytest.raises(click.UsageError, match=words):
        read_grid(texts, ())


BUDGET = Setting("reduction.budget", {"seat_g_rms_error_g": 0.05}, "--budget seat_g_rms_error_g")


@pytest.mark.parametrize(
    ("text", "setting"),
    [
        ("r2=1", "reduction.r2=2"),
        ("machine=des", "machine.limits.fork.jerk_rad_s3=3"),
        ("budget.seat_g_rms_error_g=0.1", BUDGET),
        ("budget=0.1", BUDGET),
    ],
)
def test_a_key_is_not_given_twice(text: str, setting: str | Setting) -> None:
    with pytest.raises(click.UsageError, match="leave one out"):
        read_grid([text], [setting])


def test_a_budget_beside_the_one_that_varies_is_kept() -> None:
    assert read_grid(["budget.seat_rate_deviation_relative=0.1"], [BUDGET, "time.step_s=0.5"])


def test_each_point_is_a_run_that_tells_its_setting_and_resumes(
    invoke, write_profile, tmp_path
) -> None:
    files = [write_profile(name).name for name in ("one", "two")]
    args = ("reduce", *files, "--grid", "r2=1,2", "--no-plots", "-o", "all", "--resume")
    done = invoke(*args)
    assert done.exit_code == 0, done.stderr
    assert {path.name for path in (tmp_path / "all").iterdir() if path.is_dir()} == {
        f"{name}__r2_{value}" for name in ("one", "two") for value in (1, 2)
    }
    for value in (1, 2):
        metrics = metrics_of(tmp_path / "all" / f"one__r2_{value}")
        assert metrics["solver"]["r2"] == [value] * 3
        assert metrics["profile"]["name"] == f"one__r2_{value}"
    before = tree(tmp_path / "all")
    again = invoke(*args[:3], "--grid", "r2=2,1,4", *args[5:])
    assert again.stderr.splitlines()[-1] == "6 profiles: 2 done, 4 already done"
    after = tree(tmp_path / "all")
    assert {name: after[name] for name in before if "/" in name} == {
        name: data for name, data in before.items() if "/" in name
    }


def test_a_point_of_another_profile_is_not_resumed(invoke, write_profile, tmp_path) -> None:
    file = write_profile("one")
    args = ("reduce", file.name, "--grid", "r2=1,2", "--no-plots", "--resume", "--keep-going")
    assert invoke(*args).exit_code == 0
    file.write_text(file.read_text().replace("8.8", "8.7"))
    result = invoke(*args)
    assert result.exit_code == 1
    assert result.stderr.count("is not a finished run of this very profile") == 2


def test_a_grid_of_one_point_is_named_like_one_of_many(invoke, small, tmp_path) -> None:
    assert invoke("reduce", small, "--grid", "r2=1", "-o", "out", "--no-plots").exit_code == 0
    assert (tmp_path / "out" / "small__r2_1" / "manifest.json").is_file()
    assert invoke("reduce", small, "--grid", "r2=1", "-o", "x.csv").exit_code == 2


def test_two_profiles_of_one_name_share_no_grid(invoke, write_profile, tmp_path) -> None:
    (tmp_path / "copy.yaml").write_bytes(write_profile("same").read_bytes())
    result = invoke("reduce", "same.yaml", "copy.yaml", "--grid", "r2=1,2")
    assert result.exit_code == 2
    assert "several profiles have this name: same.yaml, copy.yaml" in result.stderr


def test_only_the_profiles_are_read_to_compare_their_names_and_not_the_points(
    invoke, write_profile, monkeypatch: pytest.MonkeyPatch
) -> None:
    read = []
    load = source.load_source

    def noted(each: source.Source) -> Profile:
        read.append(each.name)
        return load(each)

    monkeypatch.setattr(source, "load_source", noted)
    files = [write_profile(name).name for name in ("one", "two")]
    assert invoke("reduce", *files, "--grid", "r2=1,2,3", "--dry-run").exit_code == 0
    assert read == files


def test_a_split_record_has_a_run_for_each_stretch_and_point(invoke, tmp_path) -> None:
    times = [0.1 * row + (5.0 if row > 10 else 0.0) for row in range(22)]
    rows = [f"{t:.6g},0,0,{0.05 + 0.002 * row}" for row, t in enumerate(times)]
    (tmp_path / "log.csv").write_text("\n".join(["t_s,p_rad_s,q_rad_s,r_rad_s", *rows, ""]))
    args = ("--gap", "split", "--limits", "warn", "--no-plots", "-o", "all")
    result = invoke("reduce", "log.csv", "--grid", "ends=free,match-start", *args)
    assert result.exit_code == 0, result.stderr
    assert {path.name for path in (tmp_path / "all").iterdir() if path.is_dir()} == {
        f"log__ends_{ends}-{part}" for ends in ("free", "match-start") for part in (1, 2)
    }


@pytest.mark.slow
def test_neither_jobs_nor_order_change_a_byte(command, write_profile, tmp_path) -> None:
    files = [write_profile(name).name for name in ("one", "two")]
    turns = (("1", files, "1,2"), ("2", files[::-1], "2,1"))
    for jobs, names, values in turns:
        args = (*names, "--grid", f"r2={values}", "--no-plots", "--jobs", jobs)
        done = command("reduce", *args, "-o", f"by{jobs}")
        assert done.returncode == 0, done.stderr
    by1, by2 = (
        {name: data for name, data in tree(tmp_path / by).items() if "/" in name}
        for by in ("by1", "by2")
    )
    assert len(by1) == 20
    assert by1 == by2
