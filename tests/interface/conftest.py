# SPDX-License-Identifier: GPL-3.0-or-later
"""Share the Blender profiles of tests/blender."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "blender"))
