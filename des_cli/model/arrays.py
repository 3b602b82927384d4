"""Arrays that nobody can change once they are part of the model."""

from __future__ import annotations

from typing import Any, TypeAlias, TypeGuard

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats: TypeAlias = NDArray[np.float64]
"""Double-precision array; the docstring at its use gives shape and unit."""

Indices: TypeAlias = NDArray[np.intp]
"""Array of whole numbers that index another one."""

Flags: TypeAlias = NDArray[np.bool_]
"""Boolean array."""


def read_only(values: ArrayLike, shape: tuple[int | None, ...]) -> Floats:
    """Return a read-only double-precision copy of ``values``.

    What is read-only already, down to who owns the memory, is returned as it is.

    Parameters
    ----------
    values : array_like
    shape : tuple of int or None
        The expected shape; None accepts any length on that axis.

    Raises
    ------
    ValueError
        If the shape is another one.
    """
    array = values if _is_frozen(values) else np.array(values, dtype=np.float64)
    fits = array.ndim == len(shape) and all(
        want is None or want == have for want, have in zip(shape, array.shape, strict=True)
    )
    if not fits:
        raise ValueError(f"shape {array.shape}, expected {shape}")
    array.flags.writeable = False
    return array


def frozen(values: Floats) -> Floats:
    """Make an array of the caller's own read-only, so that the model need not copy it."""
    values.flags.writeable = False
    return values


def _is_frozen(values: ArrayLike) -> TypeGuard[Floats]:
    """Return whether nobody can write to an array of doubles, not through its base either."""
    if not isinstance(values, np.ndarray) or values.dtype != np.float64:
        return False
    owner: object = values if values.base is None else values.base
    if not isinstance(owner, np.ndarray) or not owner.flags.owndata:
        return False
    return not values.flags.writeable and not owner.flags.writeable


def freeze(record: Any, name: str, shape: tuple[int | None, ...]) -> None:
    """Replace an array field of a frozen dataclass by its read-only copy."""
    object.__setattr__(record, name, read_only(getattr(record, name), shape))


def inner(one: Floats, other: Floats) -> Floats:
    """Return the inner product along the last axis; on a short one this is what numpy does fast."""
    return np.asarray(np.einsum("...i,...i->...", one, other))


def length(vectors: Floats) -> Floats:
    """Return the Euclidean length along the last axis."""
    return np.asarray(np.sqrt(inner(vectors, vectors)))
