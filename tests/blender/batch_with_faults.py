# SPDX-License-Identifier: GPL-3.0-or-later
"""The batch with workers that meet what Blender meets in the wild: asset names say what goes wrong in them.

`crash` aborts, `hang` sleeps, `greedy` takes memory, `slow` takes its time.
"""

import importlib
import os
import sys
import time
from pathlib import Path

NAME = "spectral_unwrap"


def faulty(read):
    def read_with_faults(path):
        if path.name.startswith("crash"):
            os.abort()
        if path.name.startswith("hang"):
            time.sleep(600.0)
        if path.name.startswith("slow"):
            time.sleep(2.0)
        if path.name.startswith("greedy"):
            held = []
            for _ in range(400):
                held.append(b"x" * (10 << 20))
                time.sleep(0.02)
        read(path)

    return read_with_faults


def main():
    if sys.argv[1:] == ["--worker"]:
        importlib.import_module("bpy")
        importlib.import_module(NAME).register()
        formats = importlib.import_module(f"{NAME}.batch.formats")
        formats.read = faulty(formats.read)
        return importlib.import_module(f"{NAME}.batch.worker").main()
    command = importlib.import_module(f"{NAME}.batch.command")
    return command.main(sys.argv[1:], [sys.executable, "-m", "tests.blender.batch_with_faults", "--worker"])


if __name__ == "__main__":
    print(Path(__file__).name, sys.argv[1:], file=sys.stderr)
    sys.exit(main())
