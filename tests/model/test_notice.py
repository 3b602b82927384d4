"""Which notices warn of harm."""

from __future__ import annotations

from typing import get_args

from des_cli.model.notice import HARMS, Notice, NoticeName


def test_every_harm_is_a_name_and_no_other_word_is_one() -> None:
    assert set(HARMS) < set(get_args(NoticeName))
    assert Notice("turning", "x").harmful
    assert not Notice("record", "x").harmful
    assert not Notice("of a later version", "x").harmful
    assert str(Notice("record", "a line was skipped")) == "a line was skipped"
