"""What is told of a G that the machine cannot make."""

from __future__ import annotations

from des_cli.model.motion import GOffset
from des_cli.results.asked_g import asked_g_metrics, asked_g_sentence


def test_nothing_is_told_where_no_g_is_asked() -> None:
    assert asked_g_metrics(None) is None
    assert asked_g_sentence(None) == ""


def test_the_sentence_has_the_offset_the_onset_and_the_rates() -> None:
    offset = GOffset(0.2, 1.5, 6.3, 6.0, 2.8)
    sentence = asked_g_sentence(offset)
    for part in ("0.2 g rms", "1.5 g at most, at t = 6.3 s", "2.8 g/s, asked 6"):
        assert part in sentence
    assert "roll" not in sentence
    assert "roll rate is off by 0.3 and the pitch rate by 1.7 rad/s" in asked_g_sentence(
        GOffset(0.2, 1.5, 6.3, 6.0, 2.8, 0.3, 1.7)
    )
