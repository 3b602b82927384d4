"""``des-coriolis validate``: is this a profile, and how was it understood."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import click

from des_cli.cli.command import Command
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.console import Console
from des_cli.cli.options import reduction_options, reduction_settings, text_or_json_option
from des_cli.cli.source_options import (
    machine_option,
    profile_argument,
    read_stdin,
    setting_options,
    source_of,
)
from des_cli.cli.stdout import write_line, write_words
from des_cli.errors import DesError, ExitCode, Failure
from des_cli.profiles_in.caps import Caps
from des_cli.profiles_in.setting import AnySetting

if TYPE_CHECKING:
    from des_cli.model.profile import Profile


KINDS = {"JointCommands": "joints", "BodyRates": "body_rates", "GCommand": "g"}
"""What the commands of a profile are called, by the class that the model has for them."""


@click.command(
    cls=Command,
    short_help="Check profiles and name all of their problems.",
    epilog="""\b
Examples:
  des-coriolis validate my.yaml
  des-coriolis validate *.yaml --format json
""",
)
@profile_argument
@machine_option
@setting_options
@reduction_options
@text_or_json_option("json prints one object a line.")
@verbosity_options
@click.pass_obj
def validate(
    console: Console,
    profiles: tuple[str, ...],
    machine: str | None,
    settings: tuple[AnySetting, ...],
    columns: dict[str, str],
    separator: str | None,
    decimal: str | None,
    caps: Caps,
    form: str,
    **reduction: Any,
) -> ExitCode:
    """Check each PROFILE without reducing it, and name all of its problems.

    Prints a line for each good profile on stdout. The exit code is 3 if a
    profile is rejected, 2 if its reduction asks for what excludes each other,
    1 if a file cannot be read.
    """
    from des_cli.batch.source import load_source, split_source
    from des_cli.reduction.consistency import require_consistent

    stdin = read_stdin(profiles, caps)
    codes = set()
    with console.working(len(profiles)) as line:
        sources = [
            source_of(
                name,
                (*settings, *reduction_settings(reduction)),
                machine=machine,
                stdin=stdin,
                columns=columns,
                separator=separator,
                decimal=decimal,
                caps=caps,
            )
            for name in profiles
        ]
        for source in [part for whole in sources for part in split_source(whole)]:
            line.stage(f"reading {source.name}")
            try:
                profile = load_source(source)
                require_consistent(profile.reduction, profile.name)
            except (DesError, OSError) as error:
                failure = Failure.of(error)
                codes.add(failure.exit_code)
                console.failure(failure, profile=source.name)
                if form == "json":
                    _write(console, json.dumps(_rejected(source.name, failure)))
            else:
                for remark in profile.remarks:
                    console.say(f"{source.name}: {remark}", "notice", profile=source.name)
                facts = understood(source.name, profile)
                if form == "json":
                    _write(console, json.dumps(facts))
                else:
                    with console.aside():
                        write_words(_line(facts))
            line.advance()
    # Several kinds of failure have no code in common but that of a batch.
    return codes.pop() if len(codes) == 1 else ExitCode.FILE if codes else ExitCode.DONE


def _write(console: Console, line: str) -> None:
    with console.aside():
        write_line(line)


def understood(source: str, profile: Profile) -> dict[str, Any]:
    """Return what a profile was taken for."""
    from des_cli.model.machine import JOINTS
    from des_cli.profiles_in.machine_yaml import occupant_mapping

    reduction, machine = profile.reduction, profile.machine
    return {
        "source": source,
        "ok": True,
        "name": profile.name,
        "kind": KINDS[type(profile.command).__name__],
        "samples": len(profile.t),
        "duration_s": float(profile.t[-1] - profile.t[0]),
        "machine": machine.name,
        "method": reduction.method,
        "algorithm": reduction.algorithm,
        "control": reduction.control,
        "axes": reduction.axes,
        "objective": reduction.objective,
        "budget": {b.metric: b.most for b in reduction.budget} or None,
        "optimise": list(reduction.optimise),
        "ends": reduction.ends,
        "lead_in_s": reduction.lead_in,
        "lead_out_s": reduction.lead_out,
        "limits": reduction.limits,
        "jerk_limit_rad_s3": {
            joint: None if math.isinf(limit.jerk) else limit.jerk
            for joint, limit in zip(JOINTS, machine.limits, strict=True)
        },
        "occupant": occupant_mapping(machine.occupant) or None,
        "remarks": list(profile.remarks),
        "sha256": profile.sha256,
    }


def _rejected(source: str, failure: Failure) -> dict[str, Any]:
    return {"source": source, "ok": False, "problems": list(failure.lines)}


def _line(facts: dict[str, Any]) -> str:
    kind = {"joints": "joint commands", "body_rates": "body rates", "g": "asked G"}[facts["kind"]]
    parts = [
        f"{facts['method']} cross-coupling by {facts['algorithm']}",
        facts["control"],
        f"{facts['axes']} axes",
        *([f"objective {facts['objective']}"] if facts["objective"] != "coriolis" else []),
        *(f"{metric} at most {most:g}" for metric, most in (facts["budget"] or {}).items()),
        *([f"optimise {' and '.join(facts['optimise'])}"] if facts["optimise"] else []),
        f"ends {facts['ends']}",
        *(
            f"{lead} {facts[f'{lead}_s']:g} s"
            for lead in ("lead_in", "lead_out")
            if facts[f"{lead}_s"]
        ),
        f"limits {facts['limits']}",
        _jerk(facts["jerk_limit_rad_s3"]),
        *_bounds(facts["occupant"] or {}),
    ]
    return (
        f"{facts['source']}: ok: {facts['name']}, {kind}, {facts['samples']} samples, "
        f"{facts['duration_s']:g} s, machine {facts['machine']}; {', '.join(parts)}"
    )


def _jerk(limits: dict[str, float | None]) -> str:
    if all(limit is None for limit in limits.values()):
        return "jerk unlimited"
    each = ("unlimited" if limit is None else f"{limit:g}" for limit in limits.values())
    return f"jerk limits {', '.join(each)} rad/s^3"


def _bounds(occupant: dict[str, Any]) -> list[str]:
    """Say what the occupant may get: ``gy_g -1 to 1``, ``g_onset_g_s at most 3``."""
    words = []
    for key, bound in occupant.items():
        if not isinstance(bound, list):
            words.append(f"{key} at most {bound:g}")
        elif None in bound:
            least, most = bound
            words.append(f"{key} at least {least:g}" if most is None else f"{key} at most {most:g}")
        else:
            words.append(f"{key} {bound[0]:g} to {bound[1]:g}")
    return words
