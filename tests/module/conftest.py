"""Shared paths: the tests' own helper modules, and the meshes beside the project where they exist."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
