"""``des-coriolis validate``: is this a profile, and how was it understood."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import click

from des_cli.cli.console import Console
from des_cli.cli.options import (
    profile_argument,
    read_stdin,
    reduction_options,
    reduction_settings,
    setting_options,
    text_or_json_option,
    verbosity_options,
)
from des_cli.cli.stdout import write_data
from des_cli.errors import DesError, ExitCode
from des_cli.failure import Failure
from des_cli.job import STANDARD_STREAM, Job

if TYPE_CHECKING:
    from des_cli.model.profile import Profile


@click.command(
    short_help="Check profiles and name all of their problems.",
    epilog="""\b
Examples:
  des-coriolis validate my.yaml
  des-coriolis validate *.yaml --format json
""",
)
@profile_argument
@setting_options
@reduction_options
@text_or_json_option("json prints one object a line.")
@verbosity_options
@click.pass_obj
def validate(
    console: Console,
    profiles: tuple[str, ...],
    settings: tuple[str, ...],
    columns: dict[str, str],
    form: str,
    **reduction: Any,
) -> ExitCode:
    """Check each PROFILE without reducing it, and name all of its problems.

    Prints a line for each good profile on stdout. The exit code is 3 if a
    profile is rejected, 2 if its reduction asks for what excludes each other,
    1 if a file cannot be read.
    """
    from des_cli.batch import load_job
    from des_cli.pipeline import require_consistent

    stdin = read_stdin(profiles)
    codes = set()
    for source in profiles:
        job = Job(
            source,
            settings=(*settings, *reduction_settings(reduction)),
            columns=columns,
            stdin=stdin if source == STANDARD_STREAM else None,
        )
        try:
            profile = load_job(job)
            require_consistent(profile.reduction, profile.name)
        except (DesError, OSError) as error:
            failure = Failure.of(error)
            codes.add(failure.exit_code)
            console.failure(failure)
            if form == "json":
                write_data(json.dumps(_rejected(source, failure)) + "\n")
            continue
        facts = understood(source, profile)
        write_data((json.dumps(facts) if form == "json" else _line(facts)) + "\n")
    # Several kinds of failure have no code in common but that of a batch.
    return codes.pop() if len(codes) == 1 else ExitCode.FILE if codes else ExitCode.DONE


def understood(source: str, profile: Profile) -> dict[str, Any]:
    """Return what a profile was taken for."""
    from des_cli.model.profile import JointCommands

    reduction = profile.reduction
    return {
        "source": source,
        "ok": True,
        "name": profile.name,
        "kind": "joints" if isinstance(profile.command, JointCommands) else "body_rates",
        "samples": len(profile.t),
        "duration_s": float(profile.t[-1] - profile.t[0]),
        "machine": profile.machine.name,
        "method": reduction.method,
        "algorithm": reduction.algorithm,
        "control": reduction.control,
        "axes": reduction.axes,
        "budget": {b.metric: b.most for b in reduction.budget} or None,
        "limits": reduction.limits,
        "sha256": profile.sha256,
    }


def _rejected(source: str, failure: Failure) -> dict[str, Any]:
    return {"source": source, "ok": False, "problems": list(failure.lines)}


def _line(facts: dict[str, Any]) -> str:
    kind = {"joints": "joint commands", "body_rates": "body rates"}[facts["kind"]]
    return (
        f"{facts['source']}: ok: {facts['name']}, {kind}, {facts['samples']} samples, "
        f"{facts['duration_s']:g} s, machine {facts['machine']}; {facts['method']} Coriolis by "
        f"{facts['algorithm']}, {facts['control']}, {facts['axes']} axes, "
        + "".join(
            f"{metric} at most {most:g}, " for metric, most in (facts["budget"] or {}).items()
        )
        + f"limits {facts['limits']}"
    )
