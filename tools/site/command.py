# SPDX-License-Identifier: GPL-3.0-or-later
"""Build the site of the documents with MkDocs; what leads nowhere is an error."""

from __future__ import annotations

import os
from pathlib import Path

from tools import steps
from tools.environment import PYTHON
from tools.steps import BUILD, ROOT

SITE = BUILD / "site"


def run() -> int:
    """Write README.md, docs/ and the reference of the module to build/site/."""
    build(SITE)
    print(f"- open {(SITE / 'index.html').relative_to(ROOT)}")
    return 0


def build(folder: Path) -> None:
    """Write the site to a folder, anew; raise StepError where a link leads nowhere or a name is not found."""
    command = [PYTHON, "-m", "mkdocs", "build", "--strict", "--clean"]
    paths = ["--config-file", ROOT / "mkdocs.yml", "--site-dir", folder]
    # Ruff is asked for by its name.
    search = f"{PYTHON.parent}:{os.environ['PATH']}"
    # What MkDocs' future holds is no part of the log.
    steps.run("building the site", [*command, *paths], log="docs", environ={"PATH": search, "NO_MKDOCS_2_WARNING": "1"})
