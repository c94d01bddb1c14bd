# SPDX-License-Identifier: GPL-3.0-or-later
"""Unwrap many files: all doors of the batch.

    python -m spectral_unwrap INPUTS... --out DIR                             from a folder that has the add-on in it
    blender --background --python spectral_unwrap/__main__.py -- INPUTS... --out DIR
    blender --command spectral_unwrap INPUTS... --out DIR                     4.2 and later, with the add-on enabled

The first two run this file, the last what `batch/blender_command.py` registers.
"""

import importlib
import importlib.util
import sys
from pathlib import Path

_NAME = "spectral_unwrap"
# The first argument of a worker of the batch.
_WORKER = "--worker"


def _package() -> str:
    """Return the name of this add-on's package; run as a script, it is none, and gets loaded."""
    if __package__:
        return __package__
    folder = Path(__file__).resolve().parent
    if _NAME not in sys.modules:
        spec = importlib.util.spec_from_file_location(
            _NAME, folder / "__init__.py", submodule_search_locations=[str(folder)]
        )
        module = importlib.util.module_from_spec(spec)
        sys.modules[_NAME] = module
        spec.loader.exec_module(module)
    return _NAME


def _arguments() -> list[str]:
    """Return the arguments that are meant for the batch: in Blender, those after two dashes."""
    if "--" in sys.argv:
        return sys.argv[sys.argv.index("--") + 1 :]
    return sys.argv[1:]


def main() -> int:
    """Run the batch, or a worker of one; return the exit code."""
    arguments = _arguments()
    package = _package()
    if arguments[:1] == [_WORKER]:
        # The wheel's other modules can be imported after this one only.
        importlib.import_module("bpy")
        # The properties of meshes that an unwrap reads.
        importlib.import_module(package).register()
        return importlib.import_module(f"{package}.batch.worker").main()
    return importlib.import_module(f"{package}.batch.command").main(arguments)


if __name__ == "__main__":
    sys.exit(main())
