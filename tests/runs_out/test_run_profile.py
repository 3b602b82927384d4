"""A run as a profile of its own."""

from __future__ import annotations

from dataclasses import replace

import pytest

from des_cli.profiles_in.yaml_nodes import parse_yaml
from des_cli.runs_out.run_profile import encode_run_profile
from tests.support.runs import make_run


@pytest.mark.parametrize("name", ["own", "a: b", "é😀", "a\x85b", "a\x7fb"])
def test_the_name_of_the_machine_reads_back_whatever_it_holds(name: str) -> None:
    run = make_run()
    machine = replace(run.profile.machine, name=name)
    made = encode_run_profile(replace(run, profile=replace(run.profile, machine=machine)), "c.csv")
    found = parse_yaml(made.decode(), "profile.yaml").plain()
    assert found["machine"]["name"] == name
    assert found["samples"] == {"file": "c.csv"}
