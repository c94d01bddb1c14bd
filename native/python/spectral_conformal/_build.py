"""What the native module was built with."""

from __future__ import annotations

from . import _native


def build_info() -> dict[str, str]:
    """Return what the module solves with, here and now.

    "factorization" is the library and its version; "blas" the file of the BLAS behind it and what that says of itself,
    empty without one; "kernel" the processor whose kernels this BLAS runs, such as "SkylakeX" for AVX-512 or "Haswell"
    for AVX2, empty where it is no OpenBLAS.
    """
    return _native.build_info()
