"""Every part of the cross-coupling is declared once, with the place where it stands."""

from typing import get_args

from des_cli.model.coriolis import COMPONENTS, ComponentKey


def test_every_key_is_a_part_in_the_order_of_the_file() -> None:
    assert tuple(each.key for each in COMPONENTS) == get_args(ComponentKey)
    assert len({each.label for each in COMPONENTS}) == len(COMPONENTS)


def test_three_parts_stand_in_each_axes_and_one_is_the_whole() -> None:
    by_place = {(each.axes, each.index): each.key for each in COMPONENTS}
    assert by_place == {
        **{("report", i): key for i, key in enumerate(("ab3", "bb3", "cb3"))},
        **{("seat", i): f"seat_{key}" for i, key in enumerate("xyz")},
        (None, 0): "vector",
    }
