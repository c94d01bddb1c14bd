"""The libraries of the native module."""

from __future__ import annotations

from . import _native


def build_info() -> dict[str, str]:
    """Return the libraries that the module solves with in this process.

    "factorization" is the library and its version; "blas" the file of its BLAS and that BLAS's description of itself,
    empty without a BLAS; "kernel" the processor whose kernels the BLAS runs, such as "SkylakeX" for AVX-512 or
    "Haswell" for AVX2, empty if it is not OpenBLAS.
    """
    return _native.build_info()
