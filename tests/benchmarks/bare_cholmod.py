"""One bare CHOLMOD analyse + factorise through ctypes: the yardstick of the solver's speed, in the same process."""

from __future__ import annotations

import ctypes
import ctypes.util
import time

import numpy as np
import scipy.sparse

# The first fields of cholmod_common are not touched: CHOLMOD's defaults are what is measured. 16 KB is more than the
# structure takes in any SuiteSparse up to 7.
_COMMON_BYTES = 16384
_INT, _COMPLEX, _DOUBLE = 0, 2, 0


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


def seconds_to_factor(matrix: scipy.sparse.spmatrix) -> tuple[float, float]:
    """Seconds of cholmod_analyze and of cholmod_factorize with default settings, of a Hermitian matrix."""
    library = ctypes.CDLL("libcholmod.so.3")
    library.cholmod_analyze.restype = ctypes.c_void_p
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
    library.cholmod_free_factor(ctypes.byref(factor), common)
    library.cholmod_finish(common)
    if not ok:
        raise RuntimeError("bare CHOLMOD could not factorise the matrix")
    return analyzed - start, factored - analyzed
