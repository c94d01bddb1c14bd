# SPDX-License-Identifier: GPL-3.0-or-later
"""Imported by every Python that starts with this folder on its path: our use of deprecated names ends the process.

This is for processes without a pytest of their own. Warnings as exceptions would not do: while a property is set,
Blender forgets the exception. It charges the module that reads or sets a property of its data; importers and libraries
of others may use what they like.
"""

import os
import sys
import warnings

OURS = r"(.*\.)?(addon|spectral_conformal|spectral_unwrap|tests|tools|__main__)(\.|$)"
REMOVED = (DeprecationWarning, PendingDeprecationWarning)
_show = warnings.showwarning


def end(message, category, filename, line_number, file=None, line=None):
    _show(message, category, filename, line_number, file, line)
    if issubclass(category, REMOVED):
        sys.stderr.flush()
        os._exit(1)


warnings.showwarning = end
for removed in REMOVED:
    warnings.filterwarnings("always", category=removed, module=OURS)
