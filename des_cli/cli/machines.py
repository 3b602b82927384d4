"""``des-coriolis machines``: the machines that the tool knows, and one as a file."""

from __future__ import annotations

import json

import click

from des_cli.cli.command import OUTPUT, Command, option
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.completion import complete_machines
from des_cli.cli.options import text_or_json_option
from des_cli.cli.stdout import write_data


@click.command(
    cls=Command,
    short_help="List the built-in machines, or print one.",
    epilog="""\b
Examples:
  des-coriolis machines
  des-coriolis machines des > my.yaml
  des-coriolis reduce cobra --machine my.yaml
""",
)
@click.argument("machine", metavar="[NAME|FILE]", required=False, shell_complete=complete_machines)
@text_or_json_option("Text is a line a machine, or the YAML of one; json is an object a line.")
@option(OUTPUT, "--full", is_flag=True, help="Print the Denavit-Hartenberg rows too.")
@verbosity_options
def machines(machine: str | None, form: str, full: bool) -> None:
    """List the built-in machines, or print one: what may be changed of it, as a file.

    What is printed reads back, from a file of its own or below "machine:" in a profile,
    to the same machine, and a number that is changed in it changes the machine. A
    machine of rows of its own is printed with its rows.
    """
    from des_cli.model.machines import MACHINES
    from des_cli.profiles_in.machine_file import load_machine, machine_summary
    from des_cli.profiles_in.machine_text import machine_text
    from des_cli.profiles_in.machine_yaml import machine_mapping

    if machine is not None:
        shown = load_machine(machine, "NAME")
        if form == "json":
            write_data(json.dumps(machine_mapping(shown), ensure_ascii=False) + "\n")
        else:
            write_data(machine_text(shown, full=full))
        return
    known = {name: machine_summary(each) for name, each in MACHINES.items()}
    if form == "json":
        rows = [json.dumps({"name": name, "summary": text}) for name, text in known.items()]
    else:
        width = max(map(len, known))
        rows = [f"{name:<{width}}  {text}".rstrip() for name, text in known.items()]
    write_data("".join(row + "\n" for row in rows))
