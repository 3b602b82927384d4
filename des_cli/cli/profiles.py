"""``des-coriolis profiles``: the maneuvers that come with the tool."""

from __future__ import annotations

import difflib
import json

import click

from des_cli.cli.command import Command
from des_cli.cli.common_options import verbosity_options
from des_cli.cli.completion import complete_builtin
from des_cli.cli.options import text_or_json_option
from des_cli.cli.stdout import write_data


@click.command(
    cls=Command,
    short_help="List the built-in profiles, or print one.",
    epilog="""\b
Examples:
  des-coriolis profiles
  des-coriolis profiles cobra > my.yaml
""",
)
@click.argument("name", required=False, shell_complete=complete_builtin)
@text_or_json_option("Of the list; json prints one object a line.")
@verbosity_options
def profiles(name: str | None, form: str) -> None:
    """List the built-in profiles, or print the file of the one called NAME."""
    from des_cli.profiles_in.builtin import builtin_profiles

    known = {profile.name: profile for profile in builtin_profiles()}
    if name is not None:
        if name not in known:
            near = difflib.get_close_matches(name, known, n=1)
            hint = f" Did you mean {near[0]!r}?" if near else f" There are {', '.join(known)}."
            raise click.UsageError(f"No built-in profile is called {name!r}.{hint}")
        write_data(known[name].path.read_bytes())
        return
    if form == "json":
        rows = [json.dumps({"name": p.name, "summary": p.summary}) for p in known.values()]
    else:
        width = max(map(len, known), default=0)
        rows = [f"{p.name:<{width}}  {p.summary}".rstrip() for p in known.values()]
    write_data("".join(row + "\n" for row in rows))
