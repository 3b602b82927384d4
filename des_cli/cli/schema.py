"""``des-coriolis schema``: the JSON Schema of a profile, for editors."""

from __future__ import annotations

import json

import click

from des_cli.cli.command import Command
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.stdout import write_data


@click.command(
    cls=Command,
    epilog="""\b
Example:
  des-coriolis schema > des-coriolis.schema.json
""",
)
@verbosity_options
def schema() -> None:
    """Print the JSON Schema of YAML profiles.

    An editor that knows it completes the keys and marks mistakes while you
    type.
    """
    from des_cli.profiles_in.schema import profile_json_schema

    write_data(json.dumps(profile_json_schema(), indent=2, ensure_ascii=False) + "\n")
