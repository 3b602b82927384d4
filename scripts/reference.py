"""Write the pages of ``docs/reference`` from the code.

    python scripts/reference.py            write them
    python scripts/reference.py --check    name those that are missing or stale

What a metric or a column means stands in the code or on the pages that people wrote; a
key that no page explains ends the script with its name.
"""

from __future__ import annotations

import inspect
import itertools
import re
import sys
from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from des_cli import load_profile, reduce_profile
from des_cli.batch.summary import COLUMNS as SUMMARY_COLUMNS
from des_cli.errors import DesError, ExitCode
from des_cli.model.metric import METRICS, PEAK_METRICS, MetricKey
from des_cli.model.metrics import Singularity
from des_cli.model.run import Run
from des_cli.runs_out.point_table import COLUMNS as POINT_COLUMNS
from des_cli.runs_out.table_reading import COLUMNS as COMMAND_COLUMNS
from des_cli.runs_out.tables import trajectory_names
from des_cli.units import split_unit

DOCS = Path(__file__).resolve().parent.parent / "docs"
FOLDER = DOCS / "reference"
HEAD = "<!-- Written by scripts/reference.py from the code: do not edit. -->\n\n"

MEANING: Mapping[MetricKey, str] = {
    "joint_deviation_relative": "‖θ − Θ‖ / ‖Θ‖ of the joint angles, the study's measure",
    "joint_deviation_relative_squared": "its square",
    "mean_square_one_minus_p": "mean of (1 − p)²; only where the motion has factors",
    "seat_rate_deviation_relative": "‖after − before‖ / ‖before‖ of the seat's angular rate",
    "seat_g_deviation_relative": "the same of the G-vector",
    "seat_g_rms_error_g": "root mean square of the change of the G-vector",
    "seat_angular_acceleration_deviation_relative": "‖after − before‖ / ‖before‖ of the seat's "
    "total angular acceleration",
    "seat_angular_acceleration_rms_error_rad_s2": "root mean square of its change",
    "seat_angular_acceleration_rms_ratio": "its root mean square, after to before",
    "seat_angular_acceleration_peak_ratio": "its peak, after to before",
    "attitude_error_max_deg": "largest angle between the two attitudes of the seat",
}

COBRA = (
    "time.step_s=0.25",
    "reduction.control=free",
    "reduction.budget={seat_g_rms_error_g: 0.05, seat_rate_deviation_relative: 0.1}",
    "reduction.optimise=[seat_yaw, seat_pitch, fork_start, cab_start]",
)
"""With constants that are optimised; of the other run, a G that is asked for."""


def main() -> int:
    """Write the pages, or name those that are not as they would be written."""
    written = pages()
    if "--check" in sys.argv[1:]:
        for finding in (findings := list(stale(written))):
            print(finding, file=sys.stderr)
        return bool(findings)
    FOLDER.mkdir(exist_ok=True)
    for name, text in written.items():
        (FOLDER / name).write_text(text, encoding="utf-8")
    return 0


def pages() -> dict[str, str]:
    """Return the text of each page by the name of its file."""
    makers: dict[str, Callable[[], str]] = {
        "metrics.md": metrics_page,
        "columns.md": columns_page,
        "exit-codes.md": exit_codes_page,
        "python.md": python_page,
    }
    return {name: HEAD + make() for name, make in makers.items()}


def stale(written: Mapping[str, str]) -> Iterable[str]:
    """Yield a sentence for each page that is not there, is not as written, or is not written."""
    for name, text in written.items():
        path = FOLDER / name
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            yield f"docs/reference/{name}: is stale; python scripts/reference.py writes it"
    for path in sorted(FOLDER.glob("*")):
        if path.name not in written:
            yield f"docs/reference/{path.name}: is not written by scripts/reference.py"


# ---------------------------------------------------------------------- metrics
def metrics_page() -> str:
    """Return what may be budgeted, and every path of ``metrics.json``."""
    rows = []
    for key, metric in METRICS.items():
        unit = "share" if metric.relative else metric.unit
        rows.append((f"`{key}`", metric.label, unit, MEANING[key]))
    peaks = " and ".join(f"`{key}`" for key in METRICS if key in PEAK_METRICS)
    found: dict[str, Any] = {}
    for name, settings in (("cobra", COBRA), ("g_flight", ("time.step_s=0.5",))):
        found = _merged(found, reduce_profile(load_profile(name, settings=settings)).metrics)
    steps = found["changes"]
    done = next(step for step in steps.values() if step)
    found["changes"] = {name: step or done for name, step in steps.items()}
    # A key that is left out where it does not apply.
    found["singularity"] |= {field.name: None for field in fields(Singularity)}
    sections = [
        f"### {name}\n\n"
        + _table(("key", "unit"), [(f"`{name}.{path}`", unit) for path, unit in _leaves(value)])
        for name, value in found.items()
        if isinstance(value, dict)
    ]
    lists = [f"`{name}`" for name, value in found.items() if not isinstance(value, dict)]
    return f"""# Metrics

## Fidelity metrics

Each may be a [budget](../formats.md#reduction), the largest value that is allowed, and is
reported under `fidelity` in `metrics.json`. The label is what the summary calls it. Before is what
the profile asks for, after is the modified motion. A share may be given as a percentage. A
budget on {peaks}
holds at every instant, any other over the whole maneuver.

{_table(("key", "label", "unit", "what it is"), rows)}
## Keys of metrics.json

Every path, as `report --store --where` and the columns of a [store](../scale.md#a-store-of-runs)
have it; braces stand for each of several names. [Formats](../formats.md#metricsjson) says what they
mean. Numbers without a unit are shares, ratios or counts. {", ".join(lists)} are
lists of sentences, or of their names.

{chr(10).join(sections)}"""


def _merged(one: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    """Return the keys of both, and of each the value that has more keys of its own."""
    merged = dict(one)
    for key, value in other.items():
        mine = merged.get(key)
        if isinstance(mine, dict) and isinstance(value, dict):
            merged[key] = _merged(mine, value)
        elif not isinstance(mine, dict):
            merged[key] = value
    return merged


def _leaves(value: Mapping[str, Any], unit: str = "") -> list[tuple[str, str]]:
    """Return the paths below a section with their units; equal siblings share their rows."""
    groups: dict[tuple[tuple[str, str], ...], list[str]] = {}
    for key, inner in value.items():
        own = _unit(key) or unit
        if key in ("budget", "budgets"):
            below: tuple[tuple[str, str], ...] = ((".METRIC", "of the metric"),)
        elif isinstance(inner, dict):
            below = tuple((f".{path}", unit) for path, unit in _leaves(inner, own))
        else:
            below = ((f"#{key}", own),)  # of its own, whatever its siblings are
        groups.setdefault(below, []).append(key)
    rows = []
    for below, keys in groups.items():
        name = keys[0] if len(keys) == 1 else f"{{{','.join(keys)}}}"
        rows += [(path[1:] if path[0] == "#" else name + path, unit) for path, unit in below]
    return rows


def _unit(name: str) -> str:
    """Return the unit in the ending of a name, as it is written."""
    if name.endswith("_g_s"):  # G is no length, and its onset has no suffix of its own
        return "g/s"
    unit = split_unit(name)[1]
    return unit.suffix.replace("_s", "/s").replace("s2", "s²").replace("s3", "s³") if unit else ""


# ---------------------------------------------------------------------- columns
def columns_page() -> str:
    """Return every column of every table, with what it is."""
    formats, cli = (DOCS / name for name in ("formats.md", "cli.md"))
    trajectory = dict.fromkeys((*trajectory_names(1), *trajectory_names(3)))
    command = {"t_s": "time", "arm_rpm": "the arm's rate"}
    command |= {"fork_deg": "the fork's angle", "cab_deg": "the cab's angle"}
    tables = (
        ("The command table", COMMAND_COLUMNS, command),
        ("trajectory.parquet", trajectory, _meanings(formats, "trajectory.parquet")),
        ("summary.csv", SUMMARY_COLUMNS, _meanings(formats, "Summary of a batch")),
        ("Points of sweep", POINT_COLUMNS, _meanings(cli, "sweep")),
    )
    text = """# Columns

Every column of the tables that the tool writes, by its whole name. The ending is the
[unit](../formats.md#units). [Formats](../formats.md#run-folder) and [commands](../cli.md) tell of
the files; the columns of [an export](../formats.md#columns-of-an-export) are chosen.
"""
    for title, names, meanings in tables:
        groups: dict[str, list[str]] = {}
        for name in names:
            groups.setdefault(meanings[name], []).append(f"`{name}`")
        rows = [(", ".join(group), words) for words, group in groups.items()]
        text += f"\n## {title}\n\n{_table(('columns', 'what they are'), rows)}"
    return text


def _meanings(page: Path, title: str) -> dict[str, str]:
    """Return what the rows of a section say of the columns that they name."""
    text = page.read_text(encoding="utf-8")
    body = re.split(rf"^#+ {re.escape(title)}\n", text, flags=re.MULTILINE)[1]
    body = re.split(r"^#+ ", body, flags=re.MULTILINE)[0]
    meanings: dict[str, str] = {}
    for cell, words in re.findall(r"^\| (`.+?) \| (.+?) \|$", body, re.MULTILINE):
        # A link leads from the page where it stands.
        plain = re.sub(r"\[([^]]+)\]\([^)]+\)", r"\1", words)
        for pattern in re.findall(r"`([^`]+)`", cell):
            meanings |= dict.fromkeys(_expanded(pattern), plain)
    return meanings


def _expanded(pattern: str) -> list[str]:
    """Return the names that a pattern with braces stands for."""
    parts = re.split(r"\{([^}]*)\}", pattern)
    choices = [part.split(",") if i % 2 else [part] for i, part in enumerate(parts)]
    return ["".join(words) for words in itertools.product(*choices)]


# ---------------------------------------------------------------------- exit codes
def exit_codes_page() -> str:
    """Return each exit code with its meaning and the errors that end with it."""
    formats = (DOCS / "formats.md").read_text(encoding="utf-8")
    section = formats.partition("\n## Exit codes\n")[2]
    meanings = dict(re.findall(r"^\| (\d+) \| (.+) \|$", section, re.MULTILINE))
    errors: dict[int, list[str]] = {}
    for error in _subclasses(DesError):
        errors.setdefault(int(error.exit_code), []).append(f"`{error.__name__}`")
    rows = [
        (
            str(int(code)),
            f"`{code.name}`",
            meanings[str(int(code))],
            ", ".join(errors.get(code, [])),
        )
        for code in ExitCode
    ]
    return f"""# Exit codes

They are the same for every command. The names are those of `des_cli.errors.ExitCode`, and the
errors those that [Python](python.md#errors) raises instead. What to do about 3, 4 and 5 is in
[troubleshooting](../howto/troubleshooting.md).

{_table(("code", "name", "meaning", "in Python"), rows)}
After 3, 4 and 5 there is no command table of the profile;
[an earlier one](../cli.md#what-becomes-of-an-earlier-output) is removed, or named.
"""


def _subclasses(base: type[DesError]) -> list[type[DesError]]:
    return [each for own in base.__subclasses__() for each in (own, *_subclasses(own))]


# ---------------------------------------------------------------------- Python
def python_page() -> str:
    """Return the public functions, the run that they make, and the errors."""
    text = """# Python

```python
from des_cli import load_profile, reduce_profile

run = reduce_profile(load_profile("cobra_felt"))
run.require_release()
print(run.metrics["coriolis"]["vector"]["reduction"])
```

`des_cli` is typed. Everything is in SI units and radians. Keys of `run.metrics` are those of
[metrics.json](metrics.md#keys-of-metricsjson).
"""
    for name, function in (("load_profile", load_profile), ("reduce_profile", reduce_profile)):
        text += f"\n## {name}\n\n{_code(_signature(name, function))}\n{_text(function)}"
    text += f"\n## Run\n\n{_text(Run)}"
    for name, member in inspect.getmembers(Run):
        if not name.startswith("_") and inspect.getdoc(member) and name in vars(Run):
            shown = f"Run.{name}" + ("()" if inspect.isfunction(member) else "")
            text += f"\n### {shown}\n\n{_text(member)}"
    text += f"\n## Errors\n\n{_text(DesError)}\n"
    rows = [
        (f"`{error.__name__}`", str(int(error.exit_code)), _first_line(error))
        for error in _subclasses(DesError)
    ]
    return text + _table(("error", "exit code", "meaning"), rows)


def _signature(name: str, function: Callable[..., Any]) -> str:
    """Return a signature as it is written, a parameter a line."""
    signature = inspect.signature(function)
    lines, starred = [], False
    for parameter in signature.parameters.values():
        if parameter.kind is parameter.KEYWORD_ONLY and not starred:
            lines.append("    *,")
            starred = True
        shown = f"    {parameter.name}: {parameter.annotation}"
        if parameter.default is not parameter.empty:
            default = parameter.default
            plain = default is None or isinstance(default, (str, tuple))
            shown += f" = {default!r}" if plain else " = ..."
        lines.append(f"{shown},")
    return "\n".join([f"def {name}(", *lines, f") -> {signature.return_annotation}"])


def _code(text: str) -> str:
    return f"```python\n{text}\n```\n"


def _text(thing: object) -> str:
    return f"```text\n{inspect.getdoc(thing)}\n```\n"


def _first_line(thing: object) -> str:
    return (inspect.getdoc(thing) or "").splitlines()[0]


def _table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = [head, ("---",) * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n".replace("|  |", "| |") for line in lines)


if __name__ == "__main__":
    sys.exit(main())
