"""What computed a run, as far as its last bits depend on it."""

from __future__ import annotations


def blas_kernels() -> list[str]:
    """Name the BLAS libraries that are loaded, each with its kernel for this CPU.

    The same input gives the same bytes with the same kernel; with another, sums are taken
    in another order.

    Returns
    -------
    list of str
        Such as ``openblas SkylakeX``, sorted.
    """
    from threadpoolctl import threadpool_info

    pools = (pool for pool in threadpool_info() if pool.get("user_api") == "blas")
    return sorted(
        {f"{pool['internal_api']} {pool.get('architecture', '')}".strip() for pool in pools}
    )
