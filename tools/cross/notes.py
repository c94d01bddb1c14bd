# SPDX-License-Identifier: GPL-3.0-or-later
"""NOTES.txt in the zips: the tests of a package, and its third-party parts."""

from __future__ import annotations

import textwrap

from tools.cross import parts
from tools.cross.targets import TARGETS, Target
from tools.environment import OPENBLAS

WIDTH = 100


def text(target: Target, version: str) -> str:
    """Return the notes of the zips for one platform."""
    others = [other for other in TARGETS if other is not target]
    suitesparse = parts.SUITESPARSE.split("_")[1].split("+")[0]
    paragraphs = [
        f"Spectral Unwrap {version} for {target.name}",
        target.was_run,
        f"Inside: CHOLMOD of SuiteSparse {suitesparse} with METIS 5.1.0, in the native module, and OpenBLAS "
        f"{OPENBLAS} as {target.blas_name} beside it. The licenses of all that was taken from others are in the "
        "folder `licenses`: of the wheel in the extension, of the add-on in the zip for Blender 3.4 to 4.1.",
        "The packages for other platforms:",
    ]
    filled = [textwrap.fill(paragraph, WIDTH) for paragraph in paragraphs]
    listed = [textwrap.fill(f"{other.name}: {other.was_run}", WIDTH, subsequent_indent="  ") for other in others]
    return "\n\n".join([*filled, *listed]) + "\n"
