# SPDX-License-Identifier: GPL-3.0-or-later
"""Run pytest inside Blender: `blender ... --python run_pytest.py -- <folder with pytest> <pytest arguments>`."""

import sys

packages, *arguments = sys.argv[sys.argv.index("--") + 1 :]
# Last, so that Blender's own NumPy and bpy win over those of the environment.
sys.path.append(packages)

import pytest  # noqa: E402 - found only now

sys.exit(int(pytest.main(arguments)))
