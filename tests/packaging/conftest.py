# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths of the set-up's code and of the list of Blenders."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "blender")]
