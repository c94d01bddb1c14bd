"""Other programs that map a mesh to the plane, if installed: libigl, xatlas and BFF."""

from __future__ import annotations

import importlib
import re
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

from tests.benchmarks import generated
from tests.benchmarks.runs import Figures, NotMeasured

LIBIGL, XATLAS, BFF = "igl.lscm", "xatlas", "BFF"


def libigl(vertices: np.ndarray, triangles: np.ndarray) -> float:
    """Return the seconds of `igl.lscm` with two boundary vertices held, far from each other along the boundary.

    Raises:
        NotMeasured: it is not installed.
    """
    igl = _module("igl", "libigl")
    loop = igl.boundary_loop(triangles)
    pins = loop[[0, len(loop) // 2]]
    start = time.perf_counter()
    igl.lscm(vertices, triangles, pins, np.array([[0.0, 0.0], [1.0, 0.0]]))
    return time.perf_counter() - start


def xatlas(vertices: np.ndarray, triangles: np.ndarray) -> float:
    """Return the seconds of `xatlas.parametrize`, which also cuts the mesh into charts and packs them.

    Raises:
        NotMeasured: it is not installed.
    """
    module = _module("xatlas", "xatlas")
    start = time.perf_counter()
    module.parametrize(vertices.astype(np.float32), triangles.astype(np.uint32))
    return time.perf_counter() - start


def solver(peer: str, program: str | None = None) -> str:
    """Return on which linear algebra a peer runs, for the reader of its figures."""
    if peer != BFF:
        return {LIBIGL: "Eigen's own factorization, no BLAS, 1 thread", XATLAS: "its own code, no BLAS"}[peer]
    listed = subprocess.run(["ldd", str(program)], capture_output=True, text=True, check=False).stdout
    found = sorted(set(re.findall(r"^\s*(lib[\w.-]*(?:blas|lapack)[\w.-]*)", listed, re.MULTILINE)))
    return f"{', '.join(found) or 'what is linked into the program'}, with its own number of threads"


def bff(program: str | None, vertices: np.ndarray, triangles: np.ndarray) -> float:
    """Return the seconds of `PROGRAM in.obj out.obj`, which reads and writes files in that time.

    Raises:
        NotMeasured: no program is given.
        RuntimeError: it failed, or wrote no map.
    """
    if program is None:
        raise NotMeasured("give BFF by --bff PROGRAM")
    with tempfile.TemporaryDirectory() as folder:
        given, made = Path(folder) / "in.obj", Path(folder) / "out.obj"
        generated.write_obj(given, vertices, triangles)
        start = time.perf_counter()
        done = subprocess.run([program, str(given), str(made)], capture_output=True, text=True, check=False)
        seconds = time.perf_counter() - start
        if done.returncode:
            raise RuntimeError(f"{program} ended with {done.returncode}:\n{done.stderr[-2000:]}")
        if not made.exists() or not any(line.startswith("vt ") for line in made.read_text().splitlines()):
            raise RuntimeError(f"{program} ended well but wrote no map to its second argument")
    return seconds


def _module(name: str, package: str) -> object:
    try:
        return importlib.import_module(name)
    except ImportError:
        raise NotMeasured(f"{package} is not installed (build/venv/bin/python -m pip install {package})") from None


def measure(peer: str, vertices: np.ndarray, triangles: np.ndarray, program: str | None = None) -> Figures:
    """Return the seconds of a peer by its name, or why there are none.

    Raises:
        RuntimeError: BFF failed.
    """
    try:
        if peer == BFF:
            return {"seconds": bff(program, vertices, triangles)}
        return {"seconds": {LIBIGL: libigl, XATLAS: xatlas}[peer](vertices, triangles)}
    except NotMeasured as reason:
        return {"reason": str(reason)}
