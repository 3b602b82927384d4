"""Arrays of the model are copies of one shape that nobody can change."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from des_cli.model.arrays import Floats, freeze, frozen, read_only


@dataclass(frozen=True)
class Record:
    values: Floats


def test_what_is_kept_is_a_double_precision_copy_that_cannot_be_changed() -> None:
    source = np.array([[1, 2], [3, 4]])
    kept = read_only(source, (2, 2))
    source[0, 0] = 9
    assert kept.dtype == np.float64
    np.testing.assert_array_equal(kept, [[1.0, 2.0], [3.0, 4.0]])
    with pytest.raises(ValueError, match="read-only"):
        kept[0, 0] = 0.0


def test_an_axis_of_any_length_is_none() -> None:
    assert read_only(np.zeros((7, 3)), (None, 3)).shape == (7, 3)
    assert read_only([], (None,)).shape == (0,)


@pytest.mark.parametrize("shape", [(2,), (3, 2), (None,), (2, 3, 1)])
def test_another_shape_is_refused_with_both(shape: tuple[int | None, ...]) -> None:
    with pytest.raises(ValueError, match="expected") as caught:
        read_only(np.zeros((2, 3)), shape)
    assert str(caught.value) == f"shape (2, 3), expected {shape}"


def test_a_field_of_a_frozen_record_becomes_its_copy() -> None:
    source = np.arange(3.0)
    record = Record(source)
    freeze(record, "values", (3,))
    source[:] = 0.0
    assert record.values.tolist() == [0.0, 1.0, 2.0]
    assert not record.values.flags.writeable


def test_what_nobody_can_change_is_not_copied() -> None:
    """Nor a view of it: both ends of the intervals of a smooth motion are one array."""
    kept = frozen(np.zeros((4, 3)))
    assert read_only(kept, (4, 3)) is kept
    assert np.shares_memory(read_only(kept[1:], (3, 3)), kept)


def test_what_somebody_can_change_still_is_copied() -> None:
    """Read-only views of an array, of bytes that are not, and other types than double."""
    owner = np.zeros((4, 3))
    view = owner[1:]
    view.flags.writeable = False
    memory = np.frombuffer(bytearray(96), dtype=np.float64).reshape(4, 3)
    memory.flags.writeable = False
    single = np.zeros((4, 3), dtype=np.float32)
    single.flags.writeable = False
    for values in (view, memory, single):
        kept = read_only(values, (None, 3))
        assert kept.dtype == np.float64
        assert not np.shares_memory(kept, values)
