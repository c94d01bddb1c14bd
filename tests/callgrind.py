# SPDX-License-Identifier: GPL-3.0-or-later
"""Instructions of calls, counted by valgrind, in a process of Python that makes many of them."""

import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# Before and after what is counted; Python itself does not call it.
MARKER = "getppid"
ENVIRON = {
    "OPENBLAS_NUM_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    # The same instructions on every processor that has them; valgrind knows no newer ones.
    "OPENBLAS_CORETYPE": "Haswell",
    "PYTHONHASHSEED": "0",
}


def count(call: Callable[[], object]) -> None:
    """Make a call that is counted."""
    os.getppid()
    call()
    os.getppid()


def counts(number: int, *arguments: str) -> list[int]:
    """Run Python under callgrind, BLAS in one thread; return the instructions of each of its `number` counted calls."""
    with tempfile.TemporaryDirectory() as folder:
        profile = Path(folder) / "profile"
        valgrind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={profile}", f"--dump-before={MARKER}"]
        result = subprocess.run(
            [*valgrind, sys.executable, *arguments],
            cwd=ROOT,
            env={**os.environ, **ENVIRON},
            capture_output=True,
            text=True,
            check=False,
        )
        if result.returncode:
            raise RuntimeError(f"{' '.join(arguments)}: {result.stderr[-3000:]}")
        # The first profile is of what comes before the first marker.
        return [_counted(Path(f"{profile}.{2 * k}")) for k in range(1, number + 1)]


def _counted(profile: Path) -> int:
    found = re.search(r"^summary: (\d+)", profile.read_text(errors="replace"), re.MULTILINE)
    assert found, f"{profile} has no summary"
    return int(found[1])
