"""What a ``g:`` section may hold: components of every kind, onsets that join, rates beside them."""

from __future__ import annotations

import pytest

from des_cli.profiles_in.command_schema import Segment
from des_cli.profiles_in.expression import Expression
from des_cli.profiles_in.g_schema import G, Onset
from tests.support.schemas import accepted, refused


def test_a_component_is_a_number_an_expression_segments_or_onsets() -> None:
    g = accepted(G, "{gx_g: 1, gy_g: 0.1*t, gz_g: [{from_s: 0, to_s: 1, value: 2}]}")
    assert g.gx_g == 1.0
    assert isinstance(g.gy_g, Expression)
    assert [type(each) for each in g.gz_g] == [Segment]
    ramps = accepted(G, "{gz_g: [{hold_g: 1.4, hold_s: 5}, {to_g: 9, onset_g_s: 0.1}]}")
    assert ramps.gz_g == [Onset(hold_g=1.4, hold_s=5.0), Onset(to_g=9.0, onset_g_s=0.1)]
    assert (ramps.gx_g, ramps.given("p")) == (None, None)


def test_a_ramp_may_begin_at_once_and_need_not_hold() -> None:
    g = accepted(G, "{gz_g: [{hold_g: 2, hold_s: 0}, {to_g: -100, onset_g_s: 1}]}")
    assert [each.hold_s for each in g.gz_g] == [0.0, None]


def test_rates_and_their_washout_are_in_the_unit_of_their_key() -> None:
    g = accepted(G, "{p_deg_s: t, q_rpm: 3, washout_ms: 250}")
    value, unit = g.given("q")
    assert (value, unit.suffix) == (3.0, "rpm")
    assert g.si("washout") == 0.25


@pytest.mark.parametrize(
    ("lines", "place", "words"),
    [
        ("gz_g: [{to_g: 2, onset_g_s: 1}]", "gz_g[0]", "starts from nowhere"),
        ("gz_g: [{hold_g: 2, hold_s: 1, to_g: 3}]", "gz_g[0]", "a hold and a ramp in one"),
        ("gz_g: [{hold_g: 2, hold_s: 1, onset_g_s: 3}]", "gz_g[0]", "a hold and a ramp in one"),
        ("gz_g: [{hold_g: 2}]", "gz_g[0]", "does not say how long"),
        ("gz_g: [{hold_g: 2, hold_s: 0}]", "gz_g[0].hold_s", "lasts no time"),
        ("gz_g: [{hold_g: 2, hold_s: 1}, {hold_g: 3, hold_s: 1}]", "gz_g[1].hold_g", "first alone"),
        ("gz_g: [{hold_g: 2, hold_s: 1}, {to_g: 3}]", "gz_g[1]", "give to_g and onset_g_s"),
        ("gz_g: [{hold_g: 2, hold_s: 1}, {onset_g_s: 3}]", "gz_g[1]", "is not a whole ramp"),
        ("gz_g: [{hold_g: 2, hold_s: 1}, {to_g: 2, onset_g_s: 1}]", "gz_g[1].to_g", "before (2 g)"),
        ("gz_g: [{hold_g: 2, hold_s: 1}, {to_g: 3, onset_g_s: 1}, {to_g: 3, onset_g_s: 1}]",
         "gz_g[2].to_g", "before (3 g)"),
        ("gz_g: [{hold_g: 2, hold_s: 1}, {to_g: 3, onset_g_s: 0}]", "onset_g_s", "greater than 0"),
        ("gz_g: [{hold_g: 2, hold_s: -1}]", "gz_g[0].hold_s", "at least 0"),
        ("gz_g: [{hold_g: 200, hold_s: 1}]", "hold_g", "at most 100"),
        ("gz_g: [{hold_g: -100.1, hold_s: 1}]", "hold_g", "at least -100"),
        ("gz_g: [{hold_g: 2, hold_s: 1, onset: 1}]", "onset", "did you mean onset_g_s"),
        ("gz_g: [{hold_g: 2, hold_s: 1}, 3]", "gz_g[1]", "must be a mapping"),
        ("gz_g: []", "gz_g", "is an empty list"),
        ("gz_g: true", "gz_g", "must be a number, an expression in t"),
        ("gz_g: {hold_g: 1}", "gz_g", "or a list of onsets {hold_g, hold_s}"),
        ("{gz_g: 2, r_deg_s: 3}", "r_deg_s", "is not a key here"),
        ("washout_s: 0", "washout_s", "greater than 0"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_its_place(lines: str, place: str, words: str) -> None:
    (line,) = refused(G, lines)
    assert f"{place}: " in line
    assert words in line
