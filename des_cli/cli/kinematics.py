"""``des-coriolis kinematics``: what a state of the joints, or a motion, does at the seat."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, cast

import click

from des_cli.batch.job import TableFormat
from des_cli.batch.source import Source
from des_cli.cli.command import OUTPUT, Command, option
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.completion import complete_profiles
from des_cli.cli.options import TABLE_FORMATS
from des_cli.cli.source_options import machine_option, read_stdin, setting_options, source_of
from des_cli.cli.state_options import in_si, option_name, state_options
from des_cli.cli.stdout import write_data
from des_cli.model.machine import JOINTS, Seat
from des_cli.profiles_in.caps import Caps
from des_cli.profiles_in.setting import AnySetting

if TYPE_CHECKING:
    from des_cli.model.arrays import Floats


@click.command(
    cls=Command,
    short_help="Show the kinematics of a state, or of a profile's motion.",
    epilog="""\b
Examples:
  des-coriolis kinematics --arm-rpm 20 --fork-deg 60 --fork-deg-s 30 --cab-deg 10
  des-coriolis kinematics --arm-rad-s 2 --cab-rad-s 1 --machine johnsville --format json
  des-coriolis kinematics cobra --format csv > states.csv
""",
)
@click.argument("profile", metavar="[PROFILE]", required=False, shell_complete=complete_profiles)
@state_options()
@machine_option
@setting_options
@option(
    OUTPUT,
    "-f",
    "--format",
    "form",
    type=click.Choice(["text", *TABLE_FORMATS]),
    help="Of what goes to stdout.  [default: text on a terminal, else json]",
)
@verbosity_options
def kinematics(
    profile: str | None,
    machine: str | None,
    settings: tuple[AnySetting, ...],
    columns: dict[str, str],
    separator: str | None,
    decimal: str | None,
    caps: Caps,
    form: str | None,
    **numbers: float | None,
) -> None:
    """Show everything that the study derives: of one state, or of a motion.

    Without PROFILE: of the joint angles, rates and accelerations given by
    options, each in any unit; what is not given is 0. With PROFILE: at each
    sample of its desired motion. Shown are the transform, the Jacobians, the
    angular velocity and acceleration with its Coriolis part, and what the
    seat's acceleration is made of.
    """
    given = {name: value for name, value in numbers.items() if value is not None}
    on_terminal = sys.stdout is not None and sys.stdout.isatty()
    form = form or ("text" if on_terminal else "json")
    if form == "parquet" and on_terminal:
        raise click.UsageError("parquet is not for a terminal: redirect stdout.")
    if profile is not None:
        _refuse_beside_profile(given)
        source = source_of(
            profile,
            settings,
            machine=machine,
            stdin=read_stdin((profile,), caps),
            columns=columns,
            separator=separator,
            decimal=decimal,
            caps=caps,
        )
        write_data(_motion(source, form))
        return
    if settings or columns or separator or decimal:
        raise click.UsageError("--set, --column and the like change a PROFILE, and none is given.")
    write_data(_state(in_si(given), machine or "des", form))


def _state(si: Mapping[tuple[str, str], float], choice: str, form: str) -> bytes | str:
    """Return the kinematics of the state that the options describe."""
    import numpy as np

    from des_cli.cli.state_text import state_text
    from des_cli.profiles_in.machine_file import load_machine
    from des_cli.runs_out.state_tables import encode_state
    from des_cli.study.state import report_states

    machine = load_machine(choice, "--machine")
    default = Seat()
    seat = Seat(
        yaw=si.get(("seat_yaw", "angle"), default.yaw),
        pitch=si.get(("seat_pitch", "angle"), default.pitch),
    )
    angle, rate, acceleration = (
        np.array([[si.get((joint, kind), 0.0) for joint in JOINTS]])
        for kind in ("angle", "rate", "acceleration")
    )
    report = report_states(machine, seat, angle, rate, acceleration)
    if form == "text":
        return state_text(report, machine, seat)
    about = {"machine": machine.name, "seat_yaw_rad": seat.yaw, "seat_pitch_rad": seat.pitch}
    return encode_state(report, cast(TableFormat, form), about)


def _motion(source: Source, form: str) -> bytes | str:
    """Return the kinematics of a profile's desired motion."""
    from des_cli.batch.source import load_source
    from des_cli.cli.state_text import motion_text
    from des_cli.reduction.desired import find_desired
    from des_cli.runs_out.state_tables import encode_states
    from des_cli.study.state import report_motion

    profile = load_source(source)
    motion = find_desired(profile).motion
    t: Floats = motion.t
    report = report_motion(profile.machine, profile.seat, motion)
    if form == "text":
        return motion_text(t, report)
    return encode_states(report, cast(TableFormat, form), t)


def _refuse_beside_profile(given: Mapping[str, float]) -> None:
    if given:
        options = ", ".join(option_name(name) for name in given)
        raise click.UsageError(
            f"{options}: a PROFILE says this by itself; change it with --set, "
            "such as --set seat.yaw_deg=0."
        )
