"""Options that condition a record, on the commands that read one."""

from __future__ import annotations

import click
import pytest

from des_cli.cli.conditioning_options import conditioning_settings
from des_cli.profiles_in.setting import Setting


def test_each_option_is_a_setting() -> None:
    values = {
        "trim": " 2 : 30.5",
        "body_axes": "p=x, q=-y, r=-z",
        "euler": "ZYX",
        "resample": "0.02",
        "smooth": "2",
    }
    assert conditioning_settings(values) == (
        Setting("trim", {"from_s": 2, "to_s": 30.5}, "--trim 2 : 30.5"),
        Setting("axes", {"p": "x", "q": "-y", "r": "-z"}, "--body-axes p=x, q=-y, r=-z"),
        Setting("samples.euler", "zyx", "--euler ZYX"),
        Setting("resample.step_s", 0.02, "--resample 0.02"),
        Setting("smooth.cutoff_hz", 2, "--smooth 2"),
    )
    (setting,) = conditioning_settings({"trim": ":3", "smooth": None})
    assert setting.value == {"to_s": 3}


@pytest.mark.parametrize(("key", "text"), [("trim", "5"), ("trim", ":"), ("body_axes", "x,-y,-z")])
def test_a_text_of_another_form_is_wrong_use(key: str, text: str) -> None:
    with pytest.raises(click.UsageError, match=f"--{key.replace('_', '-')} {text}: give"):
        conditioning_settings({key: text})


def test_commands_take_them_together_with_set(invoke, tmp_path) -> None:
    rows = "".join(f"{k / 50},0.1,0.2,{k / 500}\n" for k in range(200))
    (tmp_path / "log.csv").write_text("t_s,p_rad_s,q_rad_s,r_rad_s\n" + rows)
    options = ("--trim", "1:3", "--body-axes", "p=x,q=-y,r=-z", "--resample", "0.04")
    done = invoke("kinematics", "log.csv", "--set", "initial.fork_deg=20", *options, "-f", "ndjson")
    assert done.exit_code == 0, done.stderr
    lines = done.stdout.splitlines()
    assert len(lines) == 51
    assert '"t_s":1.0' in lines[0].replace(" ", "")
    refused = invoke("validate", "log.csv", *options, "--smooth", "20")
    assert refused.exit_code == 3
    assert "smooth.cutoff_hz: 20 Hz is not below 12.5 Hz" in refused.stderr
    assert invoke("validate", "log.csv", *options, "--smooth", "2").exit_code == 0


def test_a_state_has_no_record_to_condition(invoke) -> None:
    done = invoke("kinematics", "--arm-rpm", "3", "--smooth", "2")
    assert done.exit_code == 2
    assert "change a PROFILE, and none is given" in done.stderr
