"""What computed a run, against what the library says of itself."""

from __future__ import annotations

import numpy as np
import scipy.linalg
from threadpoolctl import threadpool_info

from des_cli.runs_out.blas import blas_kernels


def test_every_kernel_is_named_once() -> None:
    scipy.linalg.solve(np.eye(2), np.ones(2))  # loads what it has not yet
    kernels = blas_kernels()
    assert kernels == sorted(set(kernels))
    for pool in threadpool_info():
        if pool["user_api"] == "blas" and "architecture" in pool:
            assert any(pool["architecture"] in kernel for kernel in kernels)
    assert kernels
