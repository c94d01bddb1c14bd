# SPDX-License-Identifier: GPL-3.0-or-later
"""Make `spectral_unwrap.core` importable without Blender: the package of the add-on without its __init__.py."""

import sys
import types
from pathlib import Path

package = types.ModuleType("spectral_unwrap")
package.__path__ = [str(Path(__file__).resolve().parents[2] / "addon")]
sys.modules["spectral_unwrap"] = package
