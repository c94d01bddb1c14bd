# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams are the same on every processor: the kernels of the BLAS round in different ways."""

import os
import platform
import subprocess
import sys

import numpy as np
import pytest
import spectral_conformal as sc

from tests.module import meshes
from tests.module.hard_surfaces import torus

pytestmark = [
    pytest.mark.skipif("CHOLMOD" not in sc.build_info()["factorization"], reason="only CHOLMOD calls a BLAS"),
    pytest.mark.skipif(platform.machine() not in {"x86_64", "AMD64"}, reason="names kernels of x86-64"),
]
# Symmetric ones, where cuts at many places cost the same.
SHAPES = {
    "torus": torus(26, 11, 0.4),
    "hexagonal torus": torus(36, 6, 0.3),
    "torus of triangles": (torus(28, 13, 0.4)[0], meshes.triangles_of(np.array(torus(28, 13, 0.4)[1])).tolist()),
}


def write_seams(path):
    """Write the seams of all shapes to an .npz file."""
    np.savez(path, **{name: sc.suggest_seams(*mesh).seam_edges for name, mesh in SHAPES.items()})


def test_seams_do_not_depend_on_the_processor(tmp_path):
    found = {}
    for kernel in ("Prescott", "Nehalem", "Sandybridge", ""):  # the last is this processor's own
        path = tmp_path / f"seams {kernel}.npz"
        environ = {name: value for name, value in os.environ.items() if name != "OPENBLAS_CORETYPE"}
        if kernel:
            environ["OPENBLAS_CORETYPE"] = kernel
        call = f"from tests.module import test_processors; test_processors.write_seams({str(path)!r})"
        subprocess.run([sys.executable, "-c", call], env=environ, check=True)
        with np.load(path) as seams:
            found[kernel] = dict(seams)
    for kernel, seams in found.items():
        for name, edges in seams.items():
            np.testing.assert_array_equal(edges, found[""][name], err_msg=f"{name}, {kernel}")
