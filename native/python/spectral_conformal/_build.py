"""What the native module was built with."""

from __future__ import annotations

from . import _native


def build_info() -> dict[str, str]:
    """Return the factorisation library ("factorization") and the BLAS behind it ("blas": file and configuration)."""
    return _native.build_info()
