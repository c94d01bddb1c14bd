# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths from the command line."""

from __future__ import annotations

import os
from pathlib import Path

from tools.steps import StepError


def existing_file(path: Path) -> Path:
    """Return the absolute path of a readable file, with `~` expanded; raise StepError if there is none."""
    found = _expanded(path)
    if found.is_dir():
        raise StepError(f"{path}: this is a folder; give a file.")
    if not found.exists():
        raise StepError(f"{path}: no such file.")
    if not found.is_file():
        raise StepError(f"{path}: not a regular file.")
    if not os.access(found, os.R_OK):
        raise StepError(f"{path}: this file cannot be read; check its permissions.")
    return found.resolve()


def existing_folder(path: Path) -> Path:
    """Return the absolute path of a readable folder, with `~` expanded; raise StepError if there is none."""
    found = _expanded(path)
    if not found.exists():
        raise StepError(f"{path}: no such folder.")
    if not found.is_dir():
        raise StepError(f"{path}: not a folder.")
    if not os.access(found, os.R_OK | os.X_OK):
        raise StepError(f"{path}: this folder cannot be read; check its permissions.")
    return found.resolve()


def _expanded(path: Path) -> Path:
    try:
        return path.expanduser()
    except RuntimeError as error:
        raise StepError(f"{path}: there is no home folder of this name.") from error
