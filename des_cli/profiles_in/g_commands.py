"""An asked G, from a ``g:`` section or from samples, made into the model's command."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from des_cli.model.arrays import Floats
from des_cli.model.profile import WASHOUT, BodyRates, GCommand
from des_cli.profiles_in.caps import DEFAULT_CAPS
from des_cli.profiles_in.commands import (
    checked_grid,
    covers,
    largest_size,
    read_time,
    sample_body_rates,
)
from des_cli.profiles_in.expression import constant_expression, parse_expression
from des_cli.profiles_in.findings import Findings
from des_cli.profiles_in.g_schema import G_STEMS, MOST_G, RATE_STEMS, Onset
from des_cli.profiles_in.sampling import (
    MAX_WORK,
    Piece,
    SamplingError,
    Sides,
    grid_with_joints,
    pieces_of,
    regular_grid,
    sample_sides,
)
from des_cli.profiles_in.sections import Section
from des_cli.profiles_in.yaml_nodes import Step
from des_cli.units import STANDARD_GRAVITY_M_S2, Unit, split_unit

STEP = 0.02
"""Time between samples [s] of a G profile that does not say, and the longest one of a
recorded one: what lies between its rows is a straight line in G, and none in the joints."""


def read_g(
    section: Section, time: Any, findings: Findings, *, most_samples: int = DEFAULT_CAPS.rows
) -> tuple[Floats, GCommand] | None:
    """Sample a ``g:`` section.

    Parameters
    ----------
    section : Section
        A `g_schema.G`.
    time : Section, optional
        The ``time:`` section; what it does not say follows from the onsets.
    findings : Findings
        Takes what is wrong.
    most_samples : int

    Returns
    -------
    t, command : (n,) array and GCommand, or None
        None after saying what is wrong.
    """
    values = {stem: getattr(section, f"{stem}_g") for stem in G_STEMS}
    given = {stem: value for stem, value in values.items() if value is not None}
    _check_whole(section, given, findings)
    grid = _read_time(list(given.values()), time, findings, most_samples)
    if grid is None or not given:
        return None
    start, stop, _ = grid
    pieces = {
        stem: onset_pieces(value, start, stop) if _is_onsets(value) else pieces_of(value)
        for stem, value in given.items()
    }
    units: dict[str, Unit] = {}
    paths: dict[str, list[Step]] = {stem: ["g", f"{stem}_g"] for stem in given}
    for stem in RATE_STEMS:
        if written := section.given(stem):
            pieces[stem], units[stem] = pieces_of(written[0]), written[1]
            paths[stem] = ["g", str(section.given_key(stem))]
    whole = [covers(parts, grid, paths[stem], findings) for stem, parts in pieces.items()]
    if not all(whole):
        return None
    t = grid_with_joints(
        regular_grid(*grid), (piece.start for parts in pieces.values() for piece in parts)
    )
    if len(t) * sum(map(largest_size, pieces.values())) > MAX_WORK:
        findings.add(["g"], "takes too much arithmetic; give a longer step or simpler expressions")
        return None
    asked = {stem: _sampled(pieces[stem], t, paths[stem], findings) for stem in given}
    rates = _rates(pieces, units, paths, t, findings) if units else None
    if not all(asked.values()) or (units and rates is None):
        return None
    nothing = np.zeros(len(t) - 1)
    sides = [asked.get(stem) for stem in G_STEMS]
    command = GCommand(
        start=np.column_stack([each.start if each else nothing for each in sides]),
        end=np.column_stack([each.end if each else nothing for each in sides]),
        rates=rates,
        washout=section.si("washout", WASHOUT),
    )
    return t, command


def onset_pieces(onsets: Sequence[Onset], start: float, stop: float) -> tuple[Piece, ...]:
    """Return ramps and holds as the stretches of a command; the last G holds to the stop.

    Parameters
    ----------
    onsets : sequence of Onset
    start, stop : float
        Of the profile [s].
    """
    pieces: list[Piece] = []
    at, level = start, float(onsets[0].hold_g)
    for index, onset in enumerate(onsets):
        if index:
            slope = onset.onset_g_s if onset.to_g > level else -onset.onset_g_s
            end = _rounded(at + abs(onset.to_g - level) / onset.onset_g_s)
            ramp = parse_expression(f"{level!r} + {float(slope)!r}*(t - {at!r})")
            pieces.append(Piece(at, end, ramp, index))
            at, level = end, float(onset.to_g)
        if onset.hold_s:
            end = _rounded(at + onset.hold_s)
            pieces.append(Piece(at, end, constant_expression(level), index))
            at = end
    if at < stop:
        pieces.append(Piece(at, stop, constant_expression(level), len(onsets) - 1))
    return tuple(pieces)


def sampled_g(
    t: Floats, columns: Mapping[str, Floats], washout: float = WASHOUT
) -> tuple[Floats, GCommand]:
    """Return the command of recorded samples, straight lines between them.

    Parameters
    ----------
    t : (n,) array
        [s]
    columns : mapping of str to (n,) array
        ``gx``, ``gy``, ``gz`` [m/s^2] and ``p``, ``q`` [rad/s]; what is not there is zero.
    washout : float
        Time constant with which the rates are washed out [s].

    Returns
    -------
    t : (m,) array
        With samples in between where those recorded are more than ``STEP`` apart.
    command : GCommand
    """
    count = np.maximum(1, np.ceil(np.diff(t) / STEP - 1e-6)).astype(np.intp)
    first = np.repeat(np.cumsum(count) - count, count)
    part = (np.arange(count.sum()) - first) / np.repeat(count, count)
    fine = np.append(np.repeat(t[:-1], count) + part * np.repeat(np.diff(t), count), t[-1])

    def filled(stems: Sequence[str], unit: float) -> Floats:
        nothing = np.zeros_like(t)
        return np.column_stack([np.interp(fine, t, columns.get(s, nothing)) / unit for s in stems])

    asked = filled(G_STEMS, STANDARD_GRAVITY_M_S2)
    rates = None
    if any(stem in columns for stem in RATE_STEMS):
        turning = filled((*RATE_STEMS, "r"), 1.0)
        rates = BodyRates(turning[:-1], 0.5 * (turning[:-1] + turning[1:]), turning[1:])
    return fine, GCommand(asked[:-1], asked[1:], rates, washout)


def _check_whole(section: Section, given: Mapping[str, Any], findings: Findings) -> None:
    """Say what the schema cannot: that a G is asked at all, and rates where they wash out."""
    if not given:
        keys = ", ".join(f"{stem}_g" for stem in G_STEMS)
        findings.add(["g"], f"asks for no G: give one or more of {keys}")
    if section.given("washout") and not any(section.given(stem) for stem in RATE_STEMS):
        key = str(section.given_key("washout"))
        findings.add(["g", key], "washes out nothing: give p or q, or leave this out", of_key=True)


def _read_time(
    values: list[Any], time: Any, findings: Findings, most_samples: int
) -> tuple[float, float, float] | None:
    """Return start, stop and step [s]; the stop is where the last onset ends."""
    start = time.si("start") if time is not None else 0.0
    lengths = [onset_pieces(value, start, start)[-1].stop for value in values if _is_onsets(value)]
    default = {"start": 0.0, "step": STEP}
    if lengths:
        default["stop"] = max(lengths)
    elif time is None:
        what = "time is missing: give time: {stop_s: …}; only a list of onsets makes its own"
        findings.add((), what)
        return None
    if time is None:
        return checked_grid((0.0, default["stop"], STEP), None, findings, most_samples)
    return read_time(time, findings, default, most_samples=most_samples)


def _is_onsets(value: Any) -> bool:
    return isinstance(value, list) and isinstance(value[0], Onset)


def _rounded(time: float) -> float:
    """Return a time that sums of decimals mean, so that it falls on a sample."""
    return round(time, 9)


def _sampled(
    pieces: tuple[Piece, ...], t: Floats, path: list[Step], findings: Findings
) -> Sides | None:
    try:
        sides = sample_sides(pieces, t, 1.0, rates=False)
    except SamplingError as error:
        findings.add(path, str(error))
        return None
    beyond = np.maximum(np.abs(sides.start), np.abs(sides.end)) > MOST_G
    if beyond.any():
        at = t[int(np.argmax(beyond))]
        findings.add(path, f"is beyond {MOST_G:g} g at t = {at:.12g} s: no machine makes that")
        return None
    return sides


def _rates(
    pieces: Mapping[str, tuple[Piece, ...]],
    units: Mapping[str, Unit],
    paths: Mapping[str, list[Step]],
    t: Floats,
    findings: Findings,
) -> BodyRates | None:
    """Return the rates beside the G; one that is not given is zero, and so is the yaw rate."""
    nothing = pieces_of(0.0)
    stems = (*RATE_STEMS, "r")
    per_second = split_unit("r_rad_s")[1]
    assert per_second is not None, "the table has it"
    return sample_body_rates(
        {stem: pieces[stem] if stem in units else nothing for stem in stems},
        {stem: units.get(stem, per_second) for stem in stems},
        {stem: paths.get(stem, ["g"]) for stem in stems},
        t,
        findings,
    )
