"""Sizes of what is felt pair the number before with the one after."""

from dataclasses import fields

import pytest

from des_cli.model.felt import BeforeAfter, Felt, GAxis, GSizes, RateSizes, TurningSizes


@pytest.mark.parametrize("kind", [RateSizes, TurningSizes, GSizes])
def test_every_pair_has_its_own_two_fields(kind: type) -> None:
    names = [field.name for field in fields(kind)]
    sizes = kind(**{name: float(number) for number, name in enumerate(names)})
    pairs = {
        name: getattr(kind, name).fget(sizes)
        for name in ("rms", "peak", "least", "largest", "onset", "jump")
        if isinstance(getattr(kind, name, None), property)
    }
    stems = {"least": "min", "largest": "max"}
    for name, pair in pairs.items():
        before, after = (names[int(number)] for number in pair)
        assert before.startswith(f"{stems.get(name, name)}_before_")
        assert after == before.replace("before", "after")
    assert 2 * len(pairs) == sum("before" in name or "after" in name for name in names)


def test_a_pair_is_known_where_both_numbers_are() -> None:
    assert BeforeAfter(0.0, 0.0).known == (0.0, 0.0)
    assert BeforeAfter(None, 1.0).known is None
    assert BeforeAfter(1.0, None).known is None


@pytest.mark.parametrize("hardest", ["gx", "gy", "gz"])
def test_the_hardest_onset_is_the_largest_afterwards(hardest: GAxis) -> None:
    onsets: dict[GAxis, GSizes] = {
        "gx": GSizes(onset_before_g_s=9.0, onset_after_g_s=0.2),
        "gy": GSizes(onset_before_g_s=9.0),
        "gz": GSizes(onset_before_g_s=9.0, onset_after_g_s=0.1),
    }
    onsets[hardest] = GSizes(onset_before_g_s=0.0, onset_after_g_s=0.3)
    assert Felt(seat_g=onsets).hardest_onset == hardest


def test_of_nothing_measured_nothing_is_known() -> None:
    felt = Felt()
    assert felt.turning.rms.known is None
    assert felt.turning is felt.seat_angular_acceleration["magnitude"]
    assert felt.hardest_onset == "gx"
