# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch with failing workers: the names of assets say what goes wrong.

`crash` aborts, `hang` sleeps, `once` sleeps when it is read for the first time, `greedy` takes memory. A file beside
the asset says that one of them sleeps.
"""

import os
import sys
import time
from pathlib import Path

from spectral_conformal.batch import command, files, worker


def sleeps(path):
    """Return the file that is there as soon as the reading of an asset sleeps."""
    return path.with_suffix(".sleeps")


def faulty(read):
    def read_with_faults(path, settings):
        if path.name.startswith("crash"):
            os.abort()
        if path.name.startswith("hang") or (path.name.startswith("once") and not sleeps(path).exists()):
            sleeps(path).touch()
            time.sleep(600.0)
        if path.name.startswith("greedy"):
            held = []
            for _ in range(400):
                held.append(b"x" * (10 << 20))
                time.sleep(0.02)
        return read(path, settings)

    return read_with_faults


def main():
    if sys.argv[1:] == ["--worker"]:
        files.read = faulty(files.read)
        return worker.main()
    words = [sys.executable, "-m", "tests.module.batch_with_faults", "--worker"]
    return command.main(sys.argv[1:], words)


if __name__ == "__main__":
    print(Path(__file__).name, sys.argv[1:], file=sys.stderr)
    sys.exit(main())
