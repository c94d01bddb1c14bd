# SPDX-License-Identifier: GPL-3.0-or-later
"""Run pytest inside Blender: `blender ... --python run_pytest.py -- <pytest arguments>`."""

import sys

import pytest

sys.exit(int(pytest.main(sys.argv[sys.argv.index("--") + 1 :])))
