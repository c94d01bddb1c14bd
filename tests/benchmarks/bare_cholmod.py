"""Bare CHOLMOD through ctypes, in the same process: the yardstick for the solver's speed.

It is the library beside the module, which is bound to the module's BLAS. Debian's own calls the reference BLAS, several
times slower.
"""

from __future__ import annotations

import ctypes
import re
import statistics
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import scipy.sparse
import spectral_conformal

# The first fields of cholmod_common are not touched: CHOLMOD's defaults are what is measured. 16 KB is more than the
# structure takes in any SuiteSparse up to 7.
_COMMON_BYTES = 16384
_INT, _COMPLEX, _DOUBLE = 0, 2, 0
_FOLDER = Path(spectral_conformal.__file__).parent
# Their files, None in a module without them.
LIBRARY = next(_FOLDER.glob("libspectral_conformal_cholmod.*"), None)
_OPENBLAS = next(_FOLDER.glob("libspectral_conformal_openblas.*"), None)


def blas() -> str:
    """Return the name, version and kernel of the BLAS of both the module and bare CHOLMOD; empty without CHOLMOD."""
    info = spectral_conformal.build_info()
    version = re.search(r"\((OpenBLAS \d+\.\d+\.\d+)", info["blas"])
    return f"{version[1]} ({info['kernel']})" if version else ""


@contextmanager
def threads(count: int) -> Iterator[None]:
    """Let the BLAS of bare CHOLMOD use this many threads; the module sets its own number in each call."""
    library = ctypes.CDLL(str(_OPENBLAS))
    before = library.scipy_openblas_get_num_threads()
    library.scipy_openblas_set_num_threads(count)
    try:
        yield
    finally:
        library.scipy_openblas_set_num_threads(before)


class _Sparse(ctypes.Structure):
    """cholmod_sparse, see cholmod_core.h."""

    _fields_ = [
        ("nrow", ctypes.c_size_t),
        ("ncol", ctypes.c_size_t),
        ("nzmax", ctypes.c_size_t),
        ("p", ctypes.c_void_p),
        ("i", ctypes.c_void_p),
        ("nz", ctypes.c_void_p),
        ("x", ctypes.c_void_p),
        ("z", ctypes.c_void_p),
        ("stype", ctypes.c_int),
        ("itype", ctypes.c_int),
        ("xtype", ctypes.c_int),
        ("dtype", ctypes.c_int),
        ("sorted", ctypes.c_int),
        ("packed", ctypes.c_int),
    ]


class _Dense(ctypes.Structure):
    """cholmod_dense."""

    _fields_ = [
        ("nrow", ctypes.c_size_t),
        ("ncol", ctypes.c_size_t),
        ("nzmax", ctypes.c_size_t),
        ("d", ctypes.c_size_t),
        ("x", ctypes.c_void_p),
        ("z", ctypes.c_void_p),
        ("xtype", ctypes.c_int),
        ("dtype", ctypes.c_int),
    ]


@contextmanager
def _factored(matrix: scipy.sparse.spmatrix) -> Iterator[tuple]:
    """Yield the library, its common and the factor of a Hermitian matrix, by default settings, and two durations."""
    library = ctypes.CDLL(str(LIBRARY))
    library.cholmod_analyze.restype = ctypes.c_void_p
    library.cholmod_solve.restype = ctypes.c_void_p
    lower = scipy.sparse.csc_matrix(scipy.sparse.tril(matrix))
    lower.sort_indices()
    indptr = lower.indptr.astype(np.int32)
    indices = lower.indices.astype(np.int32)
    data = np.ascontiguousarray(lower.data, dtype=np.complex128)
    n = lower.shape[0]
    pointers = (indptr.ctypes.data, indices.ctypes.data, None, data.ctypes.data, None)
    sparse = _Sparse(n, n, lower.nnz, *pointers, -1, _INT, _COMPLEX, _DOUBLE, 1, 1)
    common = ctypes.create_string_buffer(_COMMON_BYTES)
    library.cholmod_start(common)
    start = time.perf_counter()
    factor = ctypes.c_void_p(library.cholmod_analyze(ctypes.byref(sparse), common))
    analyzed = time.perf_counter()
    ok = library.cholmod_factorize(ctypes.byref(sparse), factor, common)
    factored = time.perf_counter()
    try:
        if not ok:
            raise RuntimeError("bare CHOLMOD could not factorize the matrix")
        yield library, common, factor, analyzed - start, factored - analyzed
    finally:
        library.cholmod_free_factor(ctypes.byref(factor), common)
        library.cholmod_finish(common)


def seconds_to_factor(matrix: scipy.sparse.spmatrix, count: int) -> tuple[float, float]:
    """Seconds of cholmod_analyze and of cholmod_factorize of a Hermitian matrix, with this many threads of the BLAS."""
    with threads(count), _factored(matrix) as (_library, _common, _factor, analyze, factorize):
        return analyze, factorize


def seconds_to_solve(matrix: scipy.sparse.spmatrix, rounds: int = 15) -> float:
    """Seconds of one cholmod_solve with the factor of a Hermitian matrix, the median of several, by one thread."""
    n = matrix.shape[0]
    right = np.random.default_rng(0).normal(size=(n, 2)).view(np.complex128).ravel()
    dense = _Dense(n, 1, n, n, right.ctypes.data, None, _COMPLEX, _DOUBLE)
    seconds = []
    with threads(1), _factored(matrix) as (library, common, factor, _analyze, _factorize):
        for _ in range(rounds):
            start = time.perf_counter()
            solution = ctypes.c_void_p(library.cholmod_solve(0, factor, ctypes.byref(dense), common))
            seconds.append(time.perf_counter() - start)
            library.cholmod_free_dense(ctypes.byref(solution), common)
    return statistics.median(seconds)
