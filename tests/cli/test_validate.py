"""``validate``: what was understood on stdout, every problem on stderr."""

import json
from pathlib import Path


def test_a_good_profile_is_ok(invoke, small: str) -> None:
    result = invoke("validate", small)
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith(
        "small.yaml: ok: small, joint commands, 21 samples, 1 s, machine des; "
    )


def test_json_tells_what_was_understood(invoke, small: str) -> None:
    result = invoke("validate", small, "--format", "json", "--r2", "0.5", "--axes", "seat")
    facts = json.loads(result.stdout)
    assert facts["ok"] is True
    assert (facts["kind"], facts["samples"], facts["duration_s"]) == ("joints", 21, 1.0)
    assert facts["axes"] == "seat"
    assert len(facts["sha256"]) == 64


def test_all_problems_of_all_profiles_are_named(invoke, small: str, write_profile) -> None:
    bad = write_profile("bad", machine="dse", fork_deg="sin(")
    bad.write_text(bad.read_text().replace("r2: 1", "r3: 1"))
    result = invoke("validate", bad.name, small)
    assert result.exit_code == 3
    lines = result.stderr.splitlines()
    assert len(lines) >= 3
    assert all(line.startswith("bad.yaml:") for line in lines)
    assert "machine" in result.stderr
    assert "fork_deg" in result.stderr
    assert "r3" in result.stderr
    assert result.stdout.startswith("small.yaml: ok: ")


def test_json_tells_the_problems_too(invoke, write_profile) -> None:
    bad = write_profile("bad", fork_deg="sin(")
    result = invoke("validate", bad.name, "-f", "json")
    assert result.exit_code == 3
    facts = json.loads(result.stdout)
    assert facts["ok"] is False
    assert facts["problems"] == result.stderr.splitlines()


def test_a_missing_file_is_1(invoke) -> None:
    result = invoke("validate", "nowhere.yaml")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr.count("\n") == 1
    assert "nowhere.yaml" in result.stderr


def test_an_asked_g_is_named_as_one(invoke) -> None:
    done = invoke("validate", "g_rapid_onset", "--format", "json")
    assert json.loads(done.stdout)["kind"] == "g"
    assert "asked G" in invoke("validate", "g_rapid_onset").stdout


def test_several_kinds_of_failure_are_1(invoke, write_profile) -> None:
    bad = write_profile("bad", fork_deg="sin(")
    assert invoke("validate", bad.name, "nowhere.yaml").exit_code == 1


def test_stdin(invoke, small: str, tmp_path: Path) -> None:
    result = invoke("validate", "-", input=(tmp_path / small).read_bytes())
    assert (result.exit_code, result.stderr) == (0, "")
    assert "ok: small" in result.stdout


def test_stdin_twice_is_wrong_use(invoke) -> None:
    result = invoke("validate", "-", "-", input=b"")
    assert result.exit_code == 2
    assert "only once" in result.stderr


def test_the_line_tells_budgets_ends_jerk_and_what_the_occupant_may_get(
    invoke, write_profile
) -> None:
    machine = (
        "{base: des, limits: {arm: {jerk: unlimited}}, "
        "occupant: {gy_g: [-1, 1], gz_g: [null, 9], g_onset_g_s: 6}}"
    )
    path = write_profile("free", machine=machine, control="free", axes="seat")
    path.write_text(path.read_text().replace("r2: 1", "optimise: [seat_yaw, cab_start]"))
    result = invoke("validate", path.name, "--lead-out", "2")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.strip().endswith(
        "free, seat axes, seat_g_rms_error_g at most 0.05, seat_rate_deviation_relative at most "
        "0.1, seat_angular_acceleration_rms_ratio at most 1.05, "
        "seat_angular_acceleration_peak_ratio at most 1.1, "
        "optimise seat_yaw and cab_start, ends match-start, lead_out 2 s, limits warn, "
        "jerk limits unlimited, 5, 10 rad/s^3, gy_g -1 to 1, gz_g at most 9, g_onset_g_s at most 6"
    )
    facts = json.loads(invoke("validate", path.name, "--format", "json").stdout)
    assert facts["jerk_limit_rad_s3"] == {"arm": None, "fork": 5.0, "cab": 10.0}
    assert facts["occupant"] == {"gy_g": [-1.0, 1.0], "gz_g": [None, 9.0], "g_onset_g_s": 6.0}


def test_what_excludes_each_other_is_wrong_use(invoke, small: str) -> None:
    result = invoke("validate", small, "--objective", "felt", "--optimise", "seat_yaw")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.count("needs control: free") == 2
